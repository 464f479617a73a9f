// The PPs as the pair pass sees them: blocks of lanes with all that a pair reads and writes, side by side in memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "base/column.hpp"
#include "parallel/lane_numbers.hpp"
#include "particles/cell_grid.hpp"
#include "particles/model.hpp"

namespace mappm {

template <int D, class Numbers>
struct alignas(sizeof(typename Numbers::RealLanes)) PairBlock {
  static constexpr int lanes = block_lanes<Numbers>;
  typename Numbers::Coordinate x[D][lanes];
  typename Numbers::Sum density[lanes];
  typename Numbers::Real v[D][lanes];
  typename Numbers::Real v2[lanes], pv2[lanes];
  typename Numbers::Sum impulse[D][lanes], shift[D][lanes], shear[lanes], agitation[lanes];
};

/// The one particle of a loop over blocks: a PP or an FP.
template <int D, class Numbers>
struct PairCentre {
  Vec<D, typename Numbers::Coordinate> x;
  Vec<D, typename Numbers::Real> v;
  VolumeTerms<typename Numbers::Real> volume;
};

/// All PPs in the order of a grid. Each plane of cells begins a block, so no two planes share one: a slot is the index
/// of a PP in that order and the gaps before it. In later steps the PPs may have left their cells.
template <int D, class Numbers>
class PairBlocks {
 public:
  using Block = PairBlock<D, Numbers>;
  using Sum = typename Numbers::Sum;

  /// Sums are set to zero. `fluid` is in the order of `grid`.
  /// Volumes are those at rest.
  void fill(const Model<D>& model, const Numbers& numbers, FluidParticles<D>& fluid, const CellGrid<D>& grid) {
    shifts_ = model.terms.transport;
    const int planes = grid.count(D - 1);
    gaps_.resize(static_cast<std::size_t>(planes));
    starts_.resize(static_cast<std::size_t>(planes));
    held_.clear();
    for (int plane = 0; plane < planes; ++plane) {
      const std::uint32_t first = grid.plane_start(plane), end = grid.plane_start(plane + 1);
      starts_[static_cast<std::size_t>(plane)] = first;
      gaps_[static_cast<std::size_t>(plane)] = static_cast<std::uint32_t>(held_.size()) * lanes - first;
      for (std::uint32_t i = first; i < end; i += lanes) held_.push_back({i, std::min(lanes, end - i)});
    }
    reserve_tightly(blocks_, held_.size());
    blocks_.resize(held_.size());
    refill(numbers, fluid, [](std::uint32_t) { return true; });
    using Real = typename Numbers::Real;
    const auto rest = volume_terms(model.rest_density, model.rest_density, 1.0, model.background);
    for (Block& block : blocks_) {
      std::ranges::fill(block.v2, static_cast<Real>(rest.v2));
      std::ranges::fill(block.pv2, static_cast<Real>(rest.pv2));
    }
    contributions_.assign(size(), 0);
  }
  /// The same for those blocks alone for which chosen(block), with the PPs in the same order.
  template <class Chosen>
  void refill(const Numbers& numbers, FluidParticles<D>& fluid, Chosen&& chosen) {
    for (auto& values : fluid.field) {
      // Whole blocks are read behind the last particle. They are no partners, but 0 times NaN would not be 0.
      const std::size_t count = values.size();
      reserve_tightly(values, count + lanes);
      values.resize(count + lanes, 1.0);
      values.resize(count);
    }
    for (std::uint32_t block = 0; block < size(); ++block) {
      if (!chosen(block)) continue;
      const std::uint32_t i = held_[block].first;
      for (std::uint32_t lane = 0; lane < lanes; lane += lane_count) {
        Vec<D, Lanes> x, v;
        for (int axis = 0; axis < D; ++axis) {
          x[axis] = load_lanes(fluid.x(axis).data() + i + lane);
          v[axis] = load_lanes(fluid.v(axis).data() + i + lane);
        }
        set_motion(numbers, block * lanes + lane, x, v);
      }
      // Lanes of a gap are nobody's partners: they lie far from the plane.
      auto& slow = blocks_[block].x[D - 1];
      for (std::uint32_t lane = held_[block].count; lane < lanes; ++lane) slow[lane] = Numbers::far_from(slow[0]);
    }
  }
  /// The PPs of a block, which lie side by side.
  struct Held {
    std::uint32_t first, count;  // the index of the first; how many there are, the other lanes being of a gap
  };
  const Held& held(std::uint32_t block) const { return held_[block]; }

  /// Position (quanta) and velocity of the PP at `slot`, or of as many from there on as there are lanes of the state.
  /// Their sums become zero.
  template <class Wide>
  MAPPM_INLINE void set_motion(const Numbers& numbers, std::uint32_t slot, const Vec<D, Wide>& x,
                               const Vec<D, Wide>& v) {
    using Real = typename Numbers::Real;
    const auto zero = converted<Sum>(Wide(0.0));
    Block& block = blocks_[slot / lanes];
    const std::uint32_t lane = slot % lanes;
    for (int axis = 0; axis < D; ++axis) {
      store_lanes(numbers.coordinate(axis, x[axis]), &block.x[axis][lane]);
      store_lanes(converted<Real>(v[axis]), &block.v[axis][lane]);
      store_lanes(zero, &block.impulse[axis][lane]);
      store_lanes(zero, &block.shift[axis][lane]);
    }
    store_lanes(zero, &block.shear[lane]);
    store_lanes(zero, &block.agitation[lane]);
    store_lanes(zero, &block.density[lane]);
  }
  /// Their volumes and pressures, by their densities (PPs per rcut^D).
  template <class Wide>
  MAPPM_INLINE void set_density(const Model<D>& model, std::uint32_t slot, const Wide& density) {
    using Real = typename Numbers::Real;
    Block& block = blocks_[slot / lanes];
    const std::uint32_t lane = slot % lanes;
    const auto volume = volume_terms(density, model.rest_density, 1.0, model.background);
    store_lanes(converted<Real>(volume.v2), &block.v2[lane]);
    store_lanes(converted<Real>(volume.pv2), &block.pv2[lane]);
  }

  const Block& operator[](std::uint32_t block) const { return blocks_[block]; }
  Block* data() { return blocks_.data(); }
  std::size_t size() const { return blocks_.size(); }
  /// The block of a slot alone, with sums of zero.
  PairBlocks one(std::uint32_t slot) const {
    PairBlocks result;
    Block& block = result.blocks_.emplace_back(blocks_[slot / lanes]);
    for (int axis = 0; axis < D; ++axis) {
      std::ranges::fill(block.impulse[axis], 0);
      std::ranges::fill(block.shift[axis], 0);
    }
    std::ranges::fill(block.shear, 0);
    std::ranges::fill(block.agitation, 0);
    std::ranges::fill(block.density, 0);
    result.contributions_.assign(1, 0);
    return result;
  }
  /// Place of a PP of a plane less its index.
  std::uint32_t gap(int plane) const { return gaps_[static_cast<std::size_t>(plane)]; }
  std::uint32_t slot(std::uint32_t index) const {
    const auto plane = std::upper_bound(starts_.begin(), starts_.end(), index) - starts_.begin() - 1;
    return index + gap(static_cast<int>(plane));
  }

  MAPPM_INLINE PairCentre<D, Numbers> centre(std::uint32_t slot) const {
    const Block& block = blocks_[slot / lanes];
    const std::uint32_t lane = slot % lanes;
    PairCentre<D, Numbers> centre;
    for (int axis = 0; axis < D; ++axis) {
      centre.x[axis] = block.x[axis][lane];
      centre.v[axis] = block.v[axis][lane];
    }
    centre.volume = {block.v2[lane], block.pv2[lane]};
    return centre;
  }
  MAPPM_INLINE void add(std::uint32_t slot, const PairResult<D, Sum>& given) {
    Block& block = blocks_[slot / lanes];
    const std::uint32_t lane = slot % lanes;
    for (int axis = 0; axis < D; ++axis) {
      add_to(block.impulse[axis][lane], given.impulse[axis]);
      add_to(block.shift[axis][lane], given.shift[axis]);
    }
    add_to(block.shear[lane], given.shear);
    add_to(block.agitation[lane], given.agitation);
  }
  MAPPM_INLINE void add_density(std::uint32_t slot, Sum given) {
    add_to(blocks_[slot / lanes].density[slot % lanes], given);
  }
  /// Counts what lists that are kept add to the sums of these blocks in each of the two passes, once an entry, so that
  /// the excess of the rounding can be taken off. Valid until all blocks are filled.
  void count_contributions(std::span<const std::uint32_t> blocks) {
    if constexpr (Numbers::ListRounding::excess != 0)
      for (const std::uint32_t block : blocks) ++contributions_[block];
  }
  PairResult<D, Sum> sums(std::uint32_t slot) const {
    return sums_of(slot, [](const Sum* sum) { return static_cast<Wrapping<Sum>>(*sum); });
  }
  /// Sum of densities of the PP at a slot, or of as many from there on as there are lanes of the state.
  Sum density(std::uint32_t slot) const {
    return density_of(slot, [](const Sum* sum) { return static_cast<Wrapping<Sum>>(*sum); });
  }
  MAPPM_INLINE auto density_of_lanes(std::uint32_t slot) const {
    return density_of(slot, [](const Sum* sums) { return converted<Wrapping<Sum>>(load_as_many(sums)); });
  }
  /// Of as many PPs from `slot` on as there are lanes of the state.
  MAPPM_INLINE auto sums_of_lanes(std::uint32_t slot) const {
    return sums_of(slot, [](const Sum* sums) { return converted<Wrapping<Sum>>(load_as_many(sums)); });
  }

 private:
  static constexpr std::uint32_t lanes = block_lanes<Numbers>;

  MAPPM_INLINE static void add_to(Sum& sum, Sum more) {
    sum = static_cast<Sum>(static_cast<Wrapping<Sum>>(sum) + static_cast<Wrapping<Sum>>(more));
  }
  template <class Load>
  MAPPM_INLINE auto density_of(std::uint32_t slot, Load&& load) const {
    const auto sum = load(&blocks_[slot / lanes].density[slot % lanes]);
    return converted<Sum>(sum - std::decay_t<decltype(sum)>(excess_of(slot / lanes)));
  }
  /// load(from): sums from there on, as numbers that wrap.
  template <class Load>
  MAPPM_INLINE auto sums_of(std::uint32_t slot, Load&& load) const {
    const Block& block = blocks_[slot / lanes];
    const std::uint32_t lane = slot % lanes;
    using Wide = decltype(load(block.density));
    const auto excess = Wide(excess_of(slot / lanes)), of_shift = shifts_ ? excess : Wide(0);
    PairResult<D, decltype(converted<Sum>(excess))> sums;
    for (int axis = 0; axis < D; ++axis) {  // partners received them with the other sign
      sums.impulse[axis] = converted<Sum>(load(&block.impulse[axis][lane]) + excess);
      sums.shift[axis] = converted<Sum>(load(&block.shift[axis][lane]) + of_shift);
    }
    sums.shear = converted<Sum>(load(&block.shear[lane]) - of_shift);
    sums.agitation = converted<Sum>(load(&block.agitation[lane]) - of_shift);
    return sums;
  }
  Wrapping<Sum> excess_of(std::uint32_t block) const {
    if constexpr (Numbers::ListRounding::excess == 0)
      return 0;
    else
      return Numbers::ListRounding::excess * contributions_[block];
  }

  bool shifts_ = false;                       // whether there are any
  std::vector<std::uint32_t> contributions_;  // that lists make to each block in one sum
  std::vector<std::uint32_t> starts_, gaps_;  // of each plane: its first index; its slots less its indices
  std::vector<Held> held_;                    // of each block
  Column<Block> blocks_;
};

}  // namespace mappm
