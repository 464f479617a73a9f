// The pair passes of the fast engine, first of densities, then of forces: in each every pair of PPs once (half list),
// every PP-FP pair once, in rows of lanes.
//
// The calls of a step, of which `list` is left out while the PPs keep their order:
//   list                                       where the PPs have a new order
//   sum_inner_densities, sum_rest_densities, add_frozen_densities
//   close_densities                            the densities of owned PPs are known; those of others come by message
//   sum_inner, take_densities, sum_rest, add_frozen
//   moved                                      of each owned PP
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "parallel/kept_lists.hpp"
#include "parallel/lanes_loop.hpp"
#include "parallel/near_rows.hpp"
#include "particles/cell_grid.hpp"
#include "particles/frozen.hpp"
#include "particles/pair_trace.hpp"

namespace mappm {

/// Cells to a reach (rcut), by measurement (bench/fluid_pass.cpp): narrow along a row, where they only order its PPs.
/// Across, so wide that the PPs of a block fill a cube, for fewest others are in reach of a compact one; in the plane a
/// row as wide as the reach comes as near to a square, and has fewer rows beside it.
template <int D>
Vec<D, double> cells_per_reach(const Model<D>& model, double reach) {
  Vec<D, double> cells;
  cells[0] = 8.0;
  const int lanes = static_cast<int>(model.terms.single ? FloatLanes::size() : Lanes::size());
  const double edge = std::cbrt(lanes / model.rest_density);  // of the cube, rcut
  for (int axis = 1; axis < D; ++axis) cells[axis] = D == 3 ? std::max(1.0, reach / edge) : 1.0;
  return cells;
}

/// Blocks near one block, with their boxes (rcut), side by side.
template <int D>
struct Candidates {
  std::vector<std::uint32_t> block;
  std::array<Column<double>, D> low, high;

  void make_room(std::size_t count) {
    if (block.size() >= count + lane_count) [[likely]]
      return;
    block.resize(2 * count + lane_count);
    for (auto& values : low) values.resize(block.size());
    for (auto& values : high) values.resize(block.size());
  }
  /// What is read behind the last one lies far away.
  void end(std::size_t count) {
    make_room(count);
    for (std::size_t n = count; n < count + lane_count; ++n) low[0][n] = std::numeric_limits<double>::max();
  }
};

/// `Numbers`: DoubleLanes or SingleLanes, as the model has it.
template <int D, class Numbers>
class FluidPass {
 public:
  using Lists = PartnerLists<D, Numbers>;

  FluidPass(const Model<D>& model, int threads)
      : model_(model), numbers_(model.pair, model.rest_density), threads_(threads) {}

  /// Lists the pairs of which one PP lies in `region` and whose distance is at most `reach` (rcut, at least 1). The
  /// lists hold all pairs within rcut as long as no PP has moved by more than half of reach - 1, and none that was
  /// outside the region has come into what this process owns. `fluid` is in the order of `grid`, whose cells are fit to
  /// that reach or a longer one. `foreign`: indices of the PPs that change other than by `moved`. With `apart`, the
  /// inner sums are of pairs without a foreign PP or a neighbour in its block.
  void list(FluidParticles<D>& fluid, const CellGrid<D>& grid, const Region<D>& region, double reach,
            std::span<const std::uint32_t> foreign, bool apart);
  /// With the PPs in the order of `list`: densities over all PPs near each PP of the region; those of others are
  /// partial and meaningless. In two parts, of which only the second looks at foreign PPs.
  void sum_inner_densities(const CellGrid<D>& grid) { sum_densities_of(inner, grid); }
  void sum_rest_densities(FluidParticles<D>& fluid, const CellGrid<D>& grid);
  /// Adds those of PPs and FPs. `frozen` are all FPs in reach; sums[k] becomes the sum over PPs where FP k lies in the
  /// region, density quanta.
  void add_frozen_densities(const CellGrid<D>& grid, const std::vector<FrozenInStep<D>>& frozen,
                            std::vector<std::int64_t>& sums);
  /// Ends the sums of densities: density[i] of every PP, PPs per rcut^D. Those that are not owned get the rest density.
  /// Returns an owned PP whose density is out of range, if there is one.
  std::optional<std::uint32_t> close_densities(std::span<const std::uint32_t> others, std::span<double> density);
  /// Densities of foreign PPs from others.
  void take_densities(std::span<const double> density);
  /// The same for the forces.
  void sum_inner(const CellGrid<D>& grid) { sum_forces_of(inner, grid); }
  void sum_rest(const CellGrid<D>& grid) { sum_forces_of(rest, grid); }
  void add_frozen(const CellGrid<D>& grid, const std::vector<FrozenInStep<D>>& frozen,
                  std::vector<NeighbourSums<D>>& frozen_sums);
  /// After all sums: the new state of the PP at this slot, or of those that lie side by side from there on, as many as
  /// there are lanes of the state. Each PP that is not foreign must be given before the next sum.
  template <class Real>
  MAPPM_INLINE void moved(std::uint32_t slot, const Vec<D, Real>& x, const Vec<D, Real>& v) {
    if (serves_on_) blocks_.set_motion(numbers_, slot, x, v);
  }

  /// The slot of PP i; what slots are more than indices in a plane of cells.
  std::uint32_t slot(std::uint32_t i) const { return blocks_.slot(i); }
  std::uint32_t gap(int plane) const { return blocks_.gap(plane); }
  /// Sums of the PP at this slot.
  NeighbourSums<D> sums(std::uint32_t slot) const { return numbers_.sums(blocks_.sums(slot)); }
  /// Sums of as many PPs from this slot on as there are lanes of the state, of whose number it must be a multiple.
  MAPPM_INLINE NeighbourSums<D, IntLanes> sums_of_lanes(std::uint32_t slot) const {
    return numbers_.sums(blocks_.sums_of_lanes(slot));
  }

  /// After `add_frozen` in the step in which `fluid` was ordered: what each partner
  /// gave to the PP with this id that lies in the region of the grid, every pair of the pass taken alone; none where
  /// there is no such PP. For an FP `id` is the index of its solid in the step.
  std::optional<std::vector<PartnerTrace<D>>> trace(const FluidParticles<D>& fluid, const CellGrid<D>& grid,
                                                    const std::vector<FrozenInStep<D>>& frozen, std::uint64_t particle);

  /// Distances from boxes that `list` worked out.
  std::uint64_t measured() const {
    std::uint64_t sum = 0;
    for (const Search& search : searches_) sum += search.measured;
    return sum;
  }
  /// What it found.
  const std::vector<KeptLists<D, Numbers>>& kept() const { return kept_; }

 private:
  enum Part : std::size_t { inner, rest, parts };
  using Centre = PairCentre<D, Numbers>;
  /// What a thread searches with.
  struct Search {
    NearRows<D> near;
    Lists lists;
    Candidates<D> candidates;
    std::vector<std::uint32_t> found;  // near one PP
    std::uint64_t measured = 0;
    Column<typename Numbers::Real> squares;
  };
  template <class Work>
  void for_each_row(const CellGrid<D>& grid, int first_plane, int last_plane, Work&& work) const;
  template <class Work>
  void for_each_block_list(const FluidParticles<D>& fluid, const CellGrid<D>& grid, const Vec<D, int>& row,
                           double reach, Search& search, Work&& work);
  void find_boxes(const FluidParticles<D>& fluid);
  std::uint16_t lanes_near(const FluidParticles<D>& fluid, std::uint32_t slot, std::uint32_t block) const;
  template <class Work>
  void for_each_frozen_list(const CellGrid<D>& grid, const std::vector<FrozenInStep<D>>& frozen,
                            std::span<const std::uint32_t> chosen, Search& search, Work&& work) const;
  Centre centre(const FrozenInStep<D>& fp) const;
  template <class Work>
  void for_each_frozen_list(const CellGrid<D>& grid, const std::vector<FrozenInStep<D>>& frozen, Work&& work);
  static constexpr std::uint32_t lanes = block_lanes<Numbers>;
  struct PairSums {
    NeighbourSums<D> centre, other;
    std::int64_t density;
  };
  template <class Kernel, bool transport, bool lanes_first, class Beta>
  PairSums sums_of_pair(const Centre& centre, std::uint32_t slot, const Beta& beta) const;
  void sum_densities_of(Part part, const CellGrid<D>& grid);
  void sum_forces_of(Part part, const CellGrid<D>& grid);
  template <bool foreign_alone>
  void set_densities(std::span<const double> density);
  std::vector<std::uint8_t> wide_blocks(const FluidParticles<D>& fluid) const;
  std::vector<std::uint8_t> slots_in(const FluidParticles<D>& fluid, const Region<D>& region) const;
  int band_height(const CellGrid<D>& grid) const;
  template <class Work>
  void for_each_band(const CellGrid<D>& grid, Work&& work);

  const Model<D>& model_;
  Numbers numbers_;
  int threads_;
  std::vector<Vec<D, int>> half_rows_, all_rows_;
  std::vector<Search> searches_;  // of the threads
  PairBlocks<D, Numbers> blocks_;
  std::array<Column<double>, D> box_low_, box_high_;  // of the blocks, rcut
  std::vector<KeptLists<D, Numbers>> kept_;           // of each band one for each part
  std::vector<std::uint8_t> foreign_;                 // of each block: whether it holds a foreign PP
  bool serves_on_ = false;                            // the lists, beyond this step
};

/// The pass in the precision of the model.
template <int D>
using ModelPass = std::variant<FluidPass<D, DoubleLanes<D>>, FluidPass<D, SingleLanes<D>>>;

template <int D>
ModelPass<D> make_pass(const Model<D>& model, int threads) {
  if (model.terms.single) return FluidPass<D, SingleLanes<D>>(model, threads);
  return FluidPass<D, DoubleLanes<D>>(model, threads);
}

}  // namespace mappm
