// Densities at the present positions, summed for output: no part of the state, which they follow from.
#pragma once

#include <cstdint>
#include <vector>

#include "particles/state.hpp"

namespace mappm {

/// An FP where it is now.
template <int D>
struct FrozenPoint {
  std::uint64_t solid = 0;  // id
  std::uint32_t index = 0;  // in its shape
  Vec<D, double> x, v;      // position quanta, which may lie outside the box; c
  double density = 0.0;     // PPs per rcut^D
};

/// Of the PPs that a process owns, in their order, and of the FPs that lie in its region.
template <int D>
struct DensityField {
  std::vector<double> fluid;  // PPs per rcut^D
  std::vector<FrozenPoint<D>> frozen;
};

/// What a process owns, with its densities: what output is made of.
template <int D>
struct Sample {
  State<D>& state;
  DensityField<D> density;
};

}  // namespace mappm
