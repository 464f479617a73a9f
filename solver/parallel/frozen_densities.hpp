// What FPs of different solids give each other's densities: an FP also counts the matter of other solids within rcut.
#pragma once

#include <cstdint>
#include <vector>

#include "base/lanes.hpp"
#include "particles/cell_levels.hpp"
#include "particles/frozen.hpp"

namespace mappm {

/// The solids in a step, and their FPs.
template <int D>
struct PlacedSolids {
  std::vector<SolidInStep<D>> bodies;
  std::vector<FrozenInStep<D>> frozen;  // those of a body side by side, in the order of the bodies
  std::vector<std::size_t> first;       // FP of each body, and the end of the last

  void clear() {
    bodies.clear();
    frozen.clear();
    first.assign(1, 0);
  }
};

template <int D>
class FrozenDensities {
 public:
  explicit FrozenDensities(const Model<D>& model) : model_(model) {}

  /// Adds to the densities in `sums`, one an FP. `levels` holds the bodies by their centres in rcut.
  void add(const PlacedSolids<D>& solids, const CellLevels<D>& levels, std::vector<NeighbourSums<D>>& sums);

 private:
  /// FPs side by side.
  struct Block {
    double x[D][lane_count], v[D][lane_count];
    IntLanes density;
  };
  void choose(const PlacedSolids<D>& solids, std::size_t body, const SolidInStep<D>& other,
              std::vector<std::size_t>& chosen) const;
  void fill_blocks(const std::vector<FrozenInStep<D>>& frozen);
  template <class Kernel>
  void add_pairs(const std::vector<FrozenInStep<D>>& frozen, std::vector<NeighbourSums<D>>& sums);

  const Model<D>& model_;
  std::vector<std::size_t> ones_, others_;  // FPs of two bodies that are near the other body
  std::vector<Block> blocks_;               // of the others
};

}  // namespace mappm
