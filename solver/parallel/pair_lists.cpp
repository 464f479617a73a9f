#include "parallel/pair_lists.hpp"

#include <algorithm>
#include <cmath>

#ifdef MAPPM_FLOATING_SUMS
#include "parallel/floating_lanes.hpp"
#endif

namespace mappm {

template <int D, class Numbers>
void PairLists<D, Numbers>::make(Blocks& blocks, const FluidParticles<D>& fluid, const CellGrid<D>& grid,
                                 const Region<D>& region, double reach, std::span<const std::uint32_t> foreign,
                                 bool apart) {
  half_rows_ = row_offsets(grid, true);
  searches_.resize(bands_.threads());
  for (Search& search : searches_) search.measured = 0;
  foreign_.assign(blocks.size(), 0);
  for (const std::uint32_t i : foreign) foreign_[blocks.slot(i) / lanes] = 1;
  find_boxes(blocks, fluid);
  const Marks marks = this->marks(blocks, fluid, region);
  kept_.resize(parts * bands_.count(grid));
  bands_.for_each(grid, [&](int first, int last, std::size_t thread, std::size_t band) {
    KeptLists<D, Numbers>* const kept = &kept_[parts * band];
    for (const Part part : {inner, rest}) kept[part].clear();
    for_each_row(grid, first, last, [&](const Vec<D, int>& row) {
      for_each_block_list(
          blocks, fluid, grid, row, reach, searches_[thread],
          [&](std::uint32_t slot, std::span<const std::uint32_t> near) {
            const auto is_foreign = [&](std::uint32_t other) { return foreign_[other] != 0; };
            const bool alone = apart && foreign_[slot / lanes] == 0 && std::ranges::none_of(near, is_foreign);
            const bool all = marks.inside[slot] != 0;
            const auto is_wide = [&](std::uint32_t other) { return marks.wide[other] != 0; };
            kept[alone ? inner : rest].add(
                slot, near, [&](std::uint32_t other) { return all || marks.reaches_inside[other] != 0; }, is_wide,
                [&](std::uint32_t other) { return lanes_near(blocks, fluid, slot, other); });
          });
    });
    for (const Part part : {inner, rest}) blocks.count_contributions(kept[part].blocks());
  });
}

template <int D, class Numbers>
template <class Work>
void PairLists<D, Numbers>::for_each_row(const CellGrid<D>& grid, int first_plane, int last_plane, Work&& work) const {
  Vec<D, int> row;
  if constexpr (D == 2) {
    for (row[1] = first_plane; row[1] < last_plane; ++row[1]) work(row);
  } else {
    // In blocks, of which the planes with partners fit a core's own cache.
    constexpr int block = 4;
    for (int first = 0; first < grid.count(1); first += block)
      for (row[2] = first_plane; row[2] < last_plane; ++row[2])
        for (row[1] = first; row[1] < std::min(first + block, grid.count(1)); ++row[1]) work(row);
  }
}

/// The least box around the PPs of each block, rcut.
template <int D, class Numbers>
void PairLists<D, Numbers>::find_boxes(const Blocks& blocks, const FluidParticles<D>& fluid) {
  for (int axis = 0; axis < D; ++axis) {
    Column<double>&low = box_low_[axis], &high = box_high_[axis];
    low.resize(blocks.size());
    high.resize(blocks.size());
    for (std::uint32_t block = 0; block < blocks.size(); ++block) {
      const auto first = fluid.x(axis).begin() + blocks.held(block).first;
      const auto [least, most] = std::minmax_element(first, first + blocks.held(block).count);
      low[block] = *least * model_.pair.length[axis];
      high[block] = *most * model_.pair.length[axis];
    }
  }
}

template <int D, class Numbers>
auto PairLists<D, Numbers>::marks(const Blocks& blocks, const FluidParticles<D>& fluid, const Region<D>& region) const
    -> Marks {
  Marks marks{slots_in(blocks, fluid, region), std::vector<std::uint8_t>(blocks.size()), wide_blocks(blocks, fluid)};
  for (std::size_t block = 0; block < blocks.size(); ++block)
    marks.reaches_inside[block] = std::ranges::max(std::span(marks.inside).subspan(block * lanes, lanes));
  return marks;
}

/// Whether each slot holds a PP in `region`.
template <int D, class Numbers>
std::vector<std::uint8_t> PairLists<D, Numbers>::slots_in(const Blocks& blocks, const FluidParticles<D>& fluid,
                                                          const Region<D>& region) const {
  std::vector<std::uint8_t> inside(blocks.size() * lanes, 0);
  for (std::uint32_t block = 0; block < blocks.size(); ++block)
    for (std::uint32_t lane = 0; lane < blocks.held(block).count; ++lane)
      inside[block * lanes + lane] = region.contains(fluid.position(blocks.held(block).first + lane)) ? 1 : 0;
  return inside;
}

/// Whether each block is so wide, or has lanes of a gap, that its lanes must be named; empty where none need be.
template <int D, class Numbers>
std::vector<std::uint8_t> PairLists<D, Numbers>::wide_blocks(const Blocks& blocks,
                                                             const FluidParticles<D>& fluid) const {
  if (Numbers::largest_extent == std::numeric_limits<double>::infinity()) return {};
  std::vector<std::uint8_t> wide(blocks.size(), 0);
  for (std::uint32_t block = 0; block < blocks.size(); ++block) {
    const auto& held = blocks.held(block);
    if (held.count < lanes) wide[block] = 1;
    for (int axis = 0; axis < D; ++axis) {
      const auto first = fluid.x(axis).begin() + held.first;
      const auto [least, most] = std::minmax_element(first, first + held.count);
      if ((*most - *least) * model_.pair.length[axis] > Numbers::largest_extent) wide[block] = 1;
    }
  }
  return wide;
}

/// The lanes of a block that are PPs near the one at a slot, and do not only seem so: one a bit.
template <int D, class Numbers>
std::uint16_t PairLists<D, Numbers>::lanes_near(const Blocks& blocks, const FluidParticles<D>& fluid,
                                                std::uint32_t slot, std::uint32_t block) const {
  const Vec<D, double> x = fluid.position(blocks.held(slot / lanes).first + slot % lanes);
  const auto& held = blocks.held(block);
  unsigned near = 0;
  for (std::uint32_t lane = 0; lane < held.count; ++lane) {
    const Vec<D, double> d = separation(model_.pair, fluid.position(held.first + lane) - x);
    bool apart = true;
    for (int axis = 0; axis < D; ++axis) apart = apart && std::fabs(d[axis]) <= Numbers::largest_extent;
    near |= apart ? 1u << lane : 0u;
  }
  return static_cast<std::uint16_t>(near);
}

/// The blocks behind this one in the ranges that were found, into `search.candidates`; their number.
template <int D, class Numbers>
std::uint32_t PairLists<D, Numbers>::gather_candidates(const CellGrid<D>& grid, std::uint32_t block,
                                                       Search& search) const {
  Candidates<D>& candidates = search.candidates;
  std::uint32_t count = 0, next = block + 1;  // a block on the border of two rows is found in both
  for (std::size_t n = 0; n < search.near.count(); ++n) {
    const auto range = search.near.range(grid, n);
    const std::uint32_t from = std::max(next, range.first / lanes), to = (range.end + lanes - 1) / lanes;
    if (range.end <= range.first || to <= from) continue;
    candidates.make_room(count + to - from);
    for (std::uint32_t other = from; other < to; ++other, ++count) {
      candidates.block[count] = other;
      for (int axis = 0; axis < D; ++axis) {
        candidates.low[axis][count] = box_low_[axis][other];
        candidates.high[axis][count] = box_high_[axis][other];
      }
    }
    next = to;
  }
  candidates.end(count);
  return count;
}

/// Calls work(slot, blocks) for the PPs of this row: the blocks of later slots whose boxes come within the reach
/// (rcut), in rising order.
template <int D, class Numbers>
template <class Work>
void PairLists<D, Numbers>::for_each_block_list(const Blocks& blocks, const FluidParticles<D>& fluid,
                                                const CellGrid<D>& grid, const Vec<D, int>& row, double reach,
                                                Search& search, Work&& work) {
  const std::size_t cells = grid.row(row);
  const std::uint32_t gap = blocks.gap(row[D - 1]);
  const std::uint32_t begin = grid.start(cells) + gap;
  const std::uint32_t end = grid.start(cells + static_cast<std::size_t>(grid.count(0))) + gap;
  if (begin == end) return;
  search.near.fit(grid, blocks, half_rows_, row);
  const double square_of_reach = reach * reach * (1.0 + 1e-6);  // rounding hides no pair
  for (std::uint32_t block = begin / lanes; block * lanes < end; ++block) {
    const std::uint32_t first = std::max(begin, block * lanes), last = std::min(end, (block + 1) * lanes);
    Region<D> box;
    for (int axis = 0; axis < D; ++axis) {
      const auto x = fluid.x(axis).begin();
      const auto [low, high] = std::minmax_element(x + (first - gap), x + (last - gap));
      box.low[axis] = *low;
      box.high[axis] = *high;
    }
    search.near.find(grid, box);
    const std::uint32_t count = gather_candidates(grid, block, search);
    const Candidates<D>& candidates = search.candidates;
    search.measured += std::uint64_t{count} * (last - first);
    if (search.found.size() < count + 1 + lane_count) search.found.resize(count + 1 + lane_count);
    for (std::uint32_t slot = first; slot < last; ++slot) {
      Vec<D, Lanes> x;
      for (int axis = 0; axis < D; ++axis) x[axis] = fluid.x(axis)[slot - gap] * model_.pair.length[axis];
      std::uint32_t* const found = search.found.data();
      std::uint32_t near = 0;
      if (slot % lanes + 1 < blocks.held(block).count) found[near++] = block;
      for (std::uint32_t n = 0; n < count; n += lane_count) {
        Lanes square = 0.0;
        for (int axis = 0; axis < D; ++axis) {
          const Lanes low = load_lanes(&candidates.low[axis][n]), high = load_lanes(&candidates.high[axis][n]);
          const Lanes beside = larger(larger(low - x[axis], x[axis] - high), Lanes(0.0));
          square += beside * beside;
        }
        near += store_chosen(square < square_of_reach, &candidates.block[n], found + near);
      }
      work(slot, std::span<const std::uint32_t>(found, near));
    }
  }
}

template class PairLists<2, DoubleLanes<2>>;
template class PairLists<3, DoubleLanes<3>>;
template class PairLists<2, SingleLanes<2>>;
template class PairLists<3, SingleLanes<3>>;
#ifdef MAPPM_FLOATING_SUMS
template class PairLists<2, FloatingLanes<2>>;
template class PairLists<3, FloatingLanes<3>>;
#endif

}  // namespace mappm
