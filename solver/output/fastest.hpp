// The fastest PP: whether the flow has become too fast for its sound speed.
#pragma once

#include "base/group.hpp"
#include "base/vec.hpp"
#include "particles/model.hpp"
#include "particles/state.hpp"

namespace mappm {

/// Beyond this local Mach number densities are off by a tenth, and a run may tear.
inline constexpr double largest_local_mach = 0.3;

template <int D>
struct Fastest {
  double mach = 0.0;        // speed relative to the mean of the fluid, c
  Vec<D, double> position;  // position quanta; of two as fast as each other one coordinate may be of either
};

/// Collective. mean: velocity of the fluid, c.
template <int D>
Fastest<D> find_fastest(const FluidParticles<D>& fluid, const Vec<D, double>& mean, const Group& group);

}  // namespace mappm
