// What can leave the range that the numbers of the state hold.
#pragma once

namespace mappm {

enum class RangeFault { none, impulse, velocity, displacement };

/// A particle, or any point of a solid, may move at most this far in one step, rcut: halos rely on it.
inline constexpr double largest_displacement = 0.25;

/// Densities outside these multiples of the rest density end a run.
inline constexpr double lowest_density_ratio = 0.1;
inline constexpr double highest_density_ratio = 10.0;

}  // namespace mappm
