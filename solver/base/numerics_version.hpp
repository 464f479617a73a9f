// Which results the solver gives.
#pragma once

#include <cstdint>

namespace mappm {

/// Rises whenever the same scene gives other digests than before. A test keeps some digests, and says so.
///   1: density summed in the pass of the forces, and carried to the next step
///   2: density summed at the positions of the step, before the forces
inline constexpr std::uint64_t numerics_version = 2;

}  // namespace mappm
