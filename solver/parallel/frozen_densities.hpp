// What FPs of different solids, or of images of one, give each other's densities: an FP also counts the matter of other
// solids within rcut.
#pragma once

#include <cstdint>
#include <vector>

#include "base/lanes.hpp"
#include "parallel/placed_solids.hpp"
#include "particles/cell_levels.hpp"

namespace mappm {

template <int D>
class FrozenDensities {
 public:
  explicit FrozenDensities(const Model<D>& model) : model_(model) {}

  /// Adds to the densities in `sums`, one an FP (density quanta). `levels` holds the bodies by their centres in rcut.
  void add(const PlacedSolids<D>& solids, const CellLevels<D>& levels, std::vector<std::int64_t>& sums);

 private:
  /// FPs side by side.
  struct Block {
    double x[D][lane_count];
    IntLanes density;
  };
  void choose(const PlacedSolids<D>& solids, std::size_t body, const SolidInStep<D>& other,
              std::vector<std::size_t>& chosen) const;
  void fill_blocks(const std::vector<FrozenInStep<D>>& frozen);
  template <class Kernel>
  void add_pairs(const std::vector<FrozenInStep<D>>& frozen, std::vector<std::int64_t>& sums);

  const Model<D>& model_;
  std::vector<std::size_t> ones_, others_;  // FPs of two bodies that are near the other body
  std::vector<Block> blocks_;               // of the others
};

}  // namespace mappm
