// The pair passes of the fast engine, first of densities, then of forces: in each every pair of PPs once (half list),
// every PP-FP pair once, in rows of lanes. The passes of a step go from stage to stage (`StepSums`).
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "parallel/bands.hpp"
#include "parallel/frozen_lists.hpp"
#include "parallel/pair_lists.hpp"
#include "particles/cell_grid.hpp"
#include "particles/frozen.hpp"

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

/// Where the sums of a step stand:
///   inner_densities   summed: densities over pairs that have nothing to do with foreign PPs
///   densities         summed: those over all pairs of PPs
///   known_densities   those of owned PPs are known; those of others come by message
///   inner_forces      summed: forces of pairs that have nothing to do with foreign PPs
///   forces            summed: those of all pairs of PPs
enum class Stage { inner_densities, densities, known_densities, inner_forces, forces };

template <int D, class Numbers, Stage stage>
class StepSums;

/// `Numbers`: DoubleLanes or SingleLanes, as the model has it.
template <int D, class Numbers>
class FluidPass {
 public:
  template <Stage stage>
  using Sums = StepSums<D, Numbers, stage>;

  FluidPass(const Model<D>& model, int threads)
      : model_(model),
        numbers_(model.pair, model.rest_density),
        bands_(threads),
        lists_(model, bands_),
        scratch_(bands_.threads()) {}

  /// Lists the pairs of which one PP lies in `region` and whose distance is at most `reach` (rcut, at least 1). The
  /// lists hold all pairs within rcut as long as no PP has moved by more than half of reach - 1, and none that was
  /// outside the region has come into what this process owns. `fluid` is in the order of `grid`, whose cells are fit to
  /// that reach or a longer one. `foreign`: indices of the PPs that change other than by `moved`. With `apart`, the
  /// inner sums are those of PPs that have no foreign one in their block or a block nearby; without it they are empty.
  void list(FluidParticles<D>& fluid, const CellGrid<D>& grid, const Region<D>& region, double reach,
            std::span<const std::uint32_t> foreign, bool apart);
  /// Begins the sums of a step over the lists: densities over all PPs near each PP of the region, with the PPs in the
  /// order of `list`; those of others are partial and meaningless. Looks at no foreign PP.
  [[nodiscard]] Sums<Stage::inner_densities> sum_inner_densities(const CellGrid<D>& grid);

  const Model<D>& model() const { return model_; }
  const Numbers& numbers() const { return numbers_; }
  const PairBlocks<D, Numbers>& blocks() const { return blocks_; }
  const PairLists<D, Numbers>& lists() const { return lists_; }

 private:
  template <int, class, Stage>
  friend class StepSums;
  using Lists = PartnerLists<D, Numbers>;
  using Part = typename PairLists<D, Numbers>::Part;
  static constexpr std::uint32_t lanes = block_lanes<Numbers>;
  /// Of a thread.
  struct Scratch {
    FrozenSearch<D, Numbers> frozen;
    Column<typename Numbers::Real> squares;
  };

  void sum_densities(Part part, const CellGrid<D>& grid);
  void sum_forces(Part part, const CellGrid<D>& grid);
  void refill_foreign(FluidParticles<D>& fluid);
  void close_densities(std::span<const std::uint32_t> others, std::span<double> density);
  void take_densities(std::span<const double> density);
  template <bool foreign_alone>
  void set_densities(std::span<const double> density);
  template <class Work>
  void for_each_frozen_list(const CellGrid<D>& grid, const std::vector<FrozenInStep<D>>& frozen, Work&& work);
  void add_frozen_densities(const CellGrid<D>& grid, const std::vector<FrozenInStep<D>>& frozen,
                            std::vector<std::int64_t>& sums);
  void add_frozen_forces(const CellGrid<D>& grid, const std::vector<FrozenInStep<D>>& frozen,
                         std::vector<NeighbourSums<D>>& frozen_sums);

  const Model<D>& model_;
  Numbers numbers_;
  Bands<D> bands_;
  PairBlocks<D, Numbers> blocks_;
  PairLists<D, Numbers> lists_;
  std::vector<Scratch> scratch_;
  bool serves_on_ = false;  // the lists, beyond this step
};

/// The sums of one step at a stage. Each stage offers what may be done at it, and what leads to the next; then it is
/// used up. What a step has begun may be dropped, for lists to be made anew.
template <int D, class Numbers, Stage stage>
class StepSums {
 public:
  StepSums(StepSums&&) = default;
  StepSums& operator=(StepSums&&) = default;

  /// Once foreign PPs are up to date: densities over the pairs that have to do with them.
  StepSums<D, Numbers, Stage::densities> sum_rest(FluidParticles<D>& fluid, const CellGrid<D>& grid) &&
      requires(stage == Stage::inner_densities) {
    pass_->refill_foreign(fluid);
    pass_->sum_densities(PairLists<D, Numbers>::rest, grid);
    return StepSums<D, Numbers, Stage::densities>(*pass_);
  }

  /// Adds those of PPs and FPs. `frozen` are all FPs in reach; sums[k] becomes the sum over PPs where FP k lies in the
  /// region, density quanta.
  void add_frozen(const CellGrid<D>& grid, const std::vector<FrozenInStep<D>>& frozen,
                  std::vector<std::int64_t>& sums) requires(stage == Stage::densities) {
    pass_->add_frozen_densities(grid, frozen, sums);
  }
  /// Ends the sums of densities: density[i] of every PP, PPs per rcut^D. Those that are not owned get the rest density.
  StepSums<D, Numbers, Stage::known_densities> close(std::span<const std::uint32_t> others,
                                                     std::span<double> density) &&
      requires(stage == Stage::densities) {
    pass_->close_densities(others, density);
    return StepSums<D, Numbers, Stage::known_densities>(*pass_);
  }

  /// Looks at no foreign PP.
  StepSums<D, Numbers, Stage::inner_forces> sum_inner(const CellGrid<D>& grid) &&
      requires(stage == Stage::known_densities) {
    pass_->sum_forces(PairLists<D, Numbers>::inner, grid);
    return StepSums<D, Numbers, Stage::inner_forces>(*pass_);
  }

  /// Once the densities of foreign PPs have come from others.
  StepSums<D, Numbers, Stage::forces> sum_rest(std::span<const double> density, const CellGrid<D>& grid) &&
      requires(stage == Stage::inner_forces) {
    pass_->take_densities(density);
    pass_->sum_forces(PairLists<D, Numbers>::rest, grid);
    return StepSums<D, Numbers, Stage::forces>(*pass_);
  }

  /// Adds those of PPs and FPs.
  void add_frozen(const CellGrid<D>& grid, const std::vector<FrozenInStep<D>>& frozen,
                  std::vector<NeighbourSums<D>>& frozen_sums) requires(stage == Stage::forces) {
    pass_->add_frozen_forces(grid, frozen, frozen_sums);
  }
  /// Sums of the PP at this slot.
  NeighbourSums<D> sums(std::uint32_t slot) const requires(stage == Stage::forces) {
    return pass_->numbers_.sums(pass_->blocks_.sums(slot));
  }
  /// Sums of as many PPs from this slot on as there are lanes of the state, of whose number it must be a multiple.
  MAPPM_INLINE NeighbourSums<D, IntLanes> sums_of_lanes(std::uint32_t slot) const requires(stage == Stage::forces) {
    return pass_->numbers_.sums(pass_->blocks_.sums_of_lanes(slot));
  }
  /// The new state of the PP at this slot, or of those that lie side by side from there on, as many as there are lanes
  /// of the state. Each PP that is not foreign must be given before the next step.
  template <class Real>
  MAPPM_INLINE void moved(std::uint32_t slot, const Vec<D, Real>& x,
                          const Vec<D, Real>& v) requires(stage == Stage::forces) {
    if (pass_->serves_on_) pass_->blocks_.set_motion(pass_->numbers_, slot, x, v);
  }
  const FluidPass<D, Numbers>& pass() const requires(stage == Stage::forces) { return *pass_; }

 private:
  friend class FluidPass<D, Numbers>;
  template <int, class, Stage>
  friend class StepSums;
  explicit StepSums(FluidPass<D, Numbers>& pass) : pass_(&pass) {}

  FluidPass<D, Numbers>* pass_;
};

/// A density beyond the range, PPs per rcut^D: its index, if there is one.
std::optional<std::uint32_t> find_out_of_range(std::span<const double> density, double rest_density);

/// The pass in the precision of the model.
template <int D>
using ModelPass = std::variant<FluidPass<D, DoubleLanes<D>>, FluidPass<D, SingleLanes<D>>>;

template <int D>
ModelPass<D> make_pass(const Model<D>& model, int threads) {
  if (model.terms.single) return FluidPass<D, SingleLanes<D>>(model, threads);
  return FluidPass<D, DoubleLanes<D>>(model, threads);
}

}  // namespace mappm
