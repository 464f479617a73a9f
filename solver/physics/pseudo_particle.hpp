// Motion of one pseudo-particle: the paper's Verlet scheme as kick and drift.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/fixed_point.hpp"
#include "base/lanes.hpp"
#include "base/vec.hpp"
#include "physics/range_fault.hpp"

namespace mappm {

/// Sums over the neighbours of one PP in one step, as integers: impulse (iota), shift (position quanta), density
/// (density quanta, the particle itself not included).
template <int D>
struct NeighbourSums {
  Vec<D, std::int64_t> impulse, shift;
  std::int64_t density;
};

/// Constants of a step, the same for every PP.
template <int D>
struct ParticleStep {
  Vec<D, double> drift;          // dt / length of a position quantum: velocity (c) to displacement (quanta)
  Vec<D, double> kick;           // impulse of the body force (c, PP mass 1)
  Vec<D, double> largest_drift;  // `largest_displacement`, in quanta
  double self_density;
  double lowest_density, highest_density;
};

/// v += impulse + kick, x += v dt + shift, density = sum: exact but for the rounding of v dt to a quantum. The position
/// is not wrapped. On a fault nothing is changed.
template <int D>
MAPPM_INLINE RangeFault advance(Vec<D, double>& x, Vec<D, double>& v, double& density, const NeighbourSums<D>& sums,
                                const ParticleStep<D>& step) {
  constexpr std::int64_t largest_impulse = std::int64_t{1} << 50;
  Vec<D, double> new_x, new_v;
  for (int axis = 0; axis < D; ++axis) {
    if (sums.impulse[axis] >= largest_impulse || sums.impulse[axis] <= -largest_impulse) return RangeFault::impulse;
    new_v[axis] = v[axis] + (static_cast<double>(sums.impulse[axis]) * velocity_quantum + step.kick[axis]);
    if (!(std::fabs(new_v[axis]) < exact_quanta * velocity_quantum)) return RangeFault::velocity;
    const double drift = new_v[axis] * step.drift[axis];
    const double moved = static_cast<double>(to_fixed(drift)) + static_cast<double>(sums.shift[axis]);
    if (!(std::fabs(moved) <= step.largest_drift[axis])) return RangeFault::displacement;
    new_x[axis] = x[axis] + moved;
  }
  const double new_density = static_cast<double>(sums.density) * density_quantum + step.self_density;
  if (!(new_density >= step.lowest_density && new_density <= step.highest_density)) return RangeFault::density;
  x = new_x;
  v = new_v;
  density = new_density;
  return RangeFault::none;
}

}  // namespace mappm
