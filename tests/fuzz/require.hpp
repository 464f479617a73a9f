// How a fuzz target reports a finding: it stops the program, and whoever runs it keeps the input.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace mappm {

inline void require(bool holds, const char* promise) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", promise);
  std::abort();
}

}  // namespace mappm
