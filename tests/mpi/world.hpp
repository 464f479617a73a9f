// The one communicator of the test program, and sums over its processes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "parallel/communicator.hpp"

namespace mappm::testing {

/// All processes of the test run. Every test is collective: it uses EXPECT, never ASSERT, around communication.
const Communicator& world();

/// Sum over the processes, modulo 2^64.
inline std::uint64_t total(std::uint64_t value) {
  world().sum(std::span(&value, 1));
  return value;
}

}  // namespace mappm::testing
