// The PPs as the pair pass sees them: blocks of lanes with all that a pair reads and writes, side by side in memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/column.hpp"
#include "particles/cell_grid.hpp"
#include "particles/model.hpp"
#include "physics/pair_numbers.hpp"

namespace mappm {

template <int D, class Numbers>
struct alignas(sizeof(typename Numbers::RealLanes)) PairBlock {
  typename Numbers::Place x[D][lane_count];
  typename Numbers::Real v[D][lane_count];
  typename Numbers::Real v2[lane_count], pv2[lane_count];
  typename Numbers::Sum impulse[D][lane_count], shift[D][lane_count], density[lane_count];
};

/// The one particle of a loop over blocks: a PP or an FP.
template <int D, class Numbers>
struct PairCentre {
  Vec<D, typename Numbers::Place> x;
  Vec<D, typename Numbers::Real> v;
  VolumeTerms<typename Numbers::Real> volume;
};

/// All PPs in the order of a grid. Each plane of cells begins a block, so no two planes share one: a place is the index
/// of a PP in that order and the gaps before it. In later steps the PPs may have left their cells.
template <int D, class Numbers>
class PairBlocks {
 public:
  using Block = PairBlock<D, Numbers>;
  using Sums = PairResult<D, typename Numbers::Sum>;

  /// Sums are set to zero. `fluid` is in the order of `grid`. With `chosen` only those blocks for which chosen(block).
  void fill(const Model<D>& model, const Numbers& numbers, FluidParticles<D>& fluid, const CellGrid<D>& grid) {
    fill(model, numbers, fluid, grid, [](std::uint32_t) { return true; });
  }
  template <class Chosen>
  void fill(const Model<D>& model, const Numbers& numbers, FluidParticles<D>& fluid, const CellGrid<D>& grid,
            Chosen&& chosen) {
    for (auto& values : fluid.field) {
      // Whole lanes are read behind the last particle. They are no partners, but 0 times NaN would not be 0.
      const std::size_t count = values.size();
      reserve_tightly(values, count + lane_count);
      values.resize(count + lane_count, 1.0);
      values.resize(count);
    }
    const int planes = grid.count(D - 1);
    gaps_.resize(static_cast<std::size_t>(planes));
    starts_.resize(static_cast<std::size_t>(planes));
    std::uint32_t place = 0;
    for (int plane = 0; plane < planes; ++plane) {
      const std::uint32_t first = grid.plane_start(plane), end = grid.plane_start(plane + 1);
      starts_[static_cast<std::size_t>(plane)] = first;
      gaps_[static_cast<std::size_t>(plane)] = place - first;
      place += (end - first + lane_count - 1) / lane_count * lane_count;
    }
    reserve_tightly(blocks_, place / lane_count);
    blocks_.resize(place / lane_count);
    for (int plane = 0; plane < planes; ++plane) {
      const std::uint32_t end = grid.plane_start(plane + 1);
      for (std::uint32_t i = grid.plane_start(plane); i < end; i += lane_count) {
        const std::uint32_t n = (i + gap(plane)) / lane_count;
        if (!chosen(n)) continue;
        Block& block = blocks_[n];
        fill_block(model, numbers, fluid, i, block);
        // Lanes of a gap are nobody's partners: they lie far from the plane.
        for (std::uint32_t lane = end - i; lane < lane_count; ++lane)
          block.x[D - 1][lane] = Numbers::far_from(block.x[D - 1][0]);
      }
    }
  }

  /// PPs of the block that begins at `place`, or the one at `place`, after a motion. Their sums are set to zero.
  MAPPM_INLINE void refill(const Model<D>& model, const Numbers& numbers, std::uint32_t place, const Vec<D, Lanes>& x,
                           const Vec<D, Lanes>& v, const Lanes& density) {
    Block& block = blocks_[place / lane_count];
    lay(model, numbers, x, v, density, block);
    clear(block);
  }
  MAPPM_INLINE void refill(const Model<D>& model, const Numbers& numbers, std::uint32_t place, const Vec<D, double>& x,
                           const Vec<D, double>& v, double density) {
    using Real = typename Numbers::Real;
    Block& block = blocks_[place / lane_count];
    const std::uint32_t lane = place % lane_count;
    const auto volume = volume_terms(density, model.rest_density, 1.0, model.background);
    for (int axis = 0; axis < D; ++axis) {
      block.x[axis][lane] = numbers.place(axis, x[axis]);
      block.v[axis][lane] = static_cast<Real>(v[axis]);
      block.impulse[axis][lane] = block.shift[axis][lane] = 0;
    }
    block.v2[lane] = static_cast<Real>(volume.v2);
    block.pv2[lane] = static_cast<Real>(volume.pv2);
    block.density[lane] = 0;
  }

  Block* data() { return blocks_.data(); }
  std::size_t place_count() const { return blocks_.size() * lane_count; }
  /// The block of a place alone, with sums of zero.
  PairBlocks one(std::uint32_t place) const {
    PairBlocks result;
    result.blocks_.push_back(blocks_[place / lane_count]);
    clear(result.blocks_.front());
    return result;
  }
  /// Place of a PP of a plane less its index.
  std::uint32_t gap(int plane) const { return gaps_[static_cast<std::size_t>(plane)]; }
  std::uint32_t place(std::uint32_t index) const {
    const auto plane = std::upper_bound(starts_.begin(), starts_.end(), index) - starts_.begin() - 1;
    return index + gap(static_cast<int>(plane));
  }

  MAPPM_INLINE PairCentre<D, Numbers> centre(std::uint32_t place) const {
    const Block& block = blocks_[place / lane_count];
    const std::uint32_t lane = place % lane_count;
    PairCentre<D, Numbers> centre;
    for (int axis = 0; axis < D; ++axis) {
      centre.x[axis] = block.x[axis][lane];
      centre.v[axis] = block.v[axis][lane];
    }
    centre.volume = {block.v2[lane], block.pv2[lane]};
    return centre;
  }
  MAPPM_INLINE void add(std::uint32_t place, const Sums& sums) {
    Block& block = blocks_[place / lane_count];
    const std::uint32_t lane = place % lane_count;
    for (int axis = 0; axis < D; ++axis) {
      block.impulse[axis][lane] += sums.impulse[axis];
      block.shift[axis][lane] += sums.shift[axis];
    }
    block.density[lane] += sums.density;
  }
  Sums sums(std::uint32_t place) const {
    const Block& block = blocks_[place / lane_count];
    const std::uint32_t lane = place % lane_count;
    Sums sums;
    for (int axis = 0; axis < D; ++axis) {
      sums.impulse[axis] = block.impulse[axis][lane];
      sums.shift[axis] = block.shift[axis][lane];
    }
    sums.density = block.density[lane];
    return sums;
  }
  /// Of all PPs of the block that begins at `place`.
  MAPPM_INLINE auto sums_of_lanes(std::uint32_t place) const {
    const Block& block = blocks_[place / lane_count];
    PairResult<D, decltype(load_lanes(block.density))> sums;
    for (int axis = 0; axis < D; ++axis) {
      sums.impulse[axis] = load_lanes(block.impulse[axis]);
      sums.shift[axis] = load_lanes(block.shift[axis]);
    }
    sums.density = load_lanes(block.density);
    return sums;
  }

 private:
  static void fill_block(const Model<D>& model, const Numbers& numbers, const FluidParticles<D>& fluid, std::size_t i,
                         Block& block) {
    Vec<D, Lanes> x, v;
    for (int axis = 0; axis < D; ++axis) {
      x[axis] = load_lanes(&fluid.x(axis)[i]);
      v[axis] = load_lanes(&fluid.v(axis)[i]);
    }
    lay(model, numbers, x, v, load_lanes(&fluid.density()[i]), block);
    clear(block);
  }
  MAPPM_INLINE static void lay(const Model<D>& model, const Numbers& numbers, const Vec<D, Lanes>& x,
                               const Vec<D, Lanes>& v, const Lanes& density, Block& block) {
    using Real = typename Numbers::Real;
    for (int axis = 0; axis < D; ++axis) {
      store_lanes(numbers.place(axis, x[axis]), block.x[axis]);
      store_lanes(lanes_of<Real>(v[axis]), block.v[axis]);
    }
    const auto volume = volume_terms(density, model.rest_density, 1.0, model.background);
    store_lanes(lanes_of<Real>(volume.v2), block.v2);
    store_lanes(lanes_of<Real>(volume.pv2), block.pv2);
  }
  static void clear(Block& block) {
    using SumLanes = decltype(load_lanes(block.density));
    for (int axis = 0; axis < D; ++axis) {
      store_lanes(SumLanes(0), block.impulse[axis]);
      store_lanes(SumLanes(0), block.shift[axis]);
    }
    store_lanes(SumLanes(0), block.density);
  }

  std::vector<std::uint32_t> starts_, gaps_;  // of each plane: its first index; its places less its indices
  Column<Block> blocks_;
};

}  // namespace mappm
