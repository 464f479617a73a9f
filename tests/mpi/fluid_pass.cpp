// Oracles: the pair law between all pairs, and the same pass over memory that holds nothing else.
#include "parallel/fluid_pass.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "parallel/residents.hpp"
#include "unit/serial/scenes.hpp"

namespace mappm {
namespace {

constexpr const char* swirl = R"(
name = "swirl"
units = "dimensionless"
[box]
size = [4.0, 5.0]
[fluid]
density = 12.25
viscosity = 1.0
spacing = 0.285714
rcut = 1.0
sound_speed = 1.0
wave = { amplitude = 0.05, direction = "x", gradient = "y", mode = 1 }
[run]
steps = 1
)";

/// The same in a box of these sides.
std::string swirl_in(const std::string& sides) {
  const std::string own = "[4.0, 5.0]";
  std::string text = swirl;
  return text.replace(text.find(own), own.size(), sides);
}

/// What may be done at a stage of the sums of a step, and that it uses the stage up.
template <class Sums>
concept CanSumInner = requires(Sums sums, const CellGrid<2>& grid) {
  static_cast<Sums>(sums).sum_inner(grid);
};
template <Stage stage>
using SumsAt = StepSums<2, DoubleLanes<2>, stage>;
static_assert(CanSumInner<SumsAt<Stage::known_densities>&&>);
static_assert(!CanSumInner<SumsAt<Stage::known_densities>&>, "it would be summed twice");
static_assert(!CanSumInner<SumsAt<Stage::densities>&&>, "densities are not known yet");
static_assert(!CanSumInner<SumsAt<Stage::forces>&&>, "forces are summed already");
static_assert(!std::is_copy_constructible_v<SumsAt<Stage::densities>>);

/// How a sum comes about: by lists of the step, by lists that are kept, by such after the PPs have moved, or then in
/// two parts, of which the first must not look at some PPs.
enum class Lists { once, kept, kept_after_motion, kept_in_parts };
constexpr Lists all_kinds[] = {Lists::once, Lists::kept, Lists::kept_after_motion, Lists::kept_in_parts};
constexpr double reach = 1.1;

template <int D>
std::vector<std::uint32_t> all_of(const FluidParticles<D>& fluid) {
  std::vector<std::uint32_t> all(fluid.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

template <class Pass, int D>
auto sum_densities(Pass& pass, FluidParticles<D>& fluid, const CellGrid<D>& grid) {
  return pass.sum_inner_densities(grid).sum_rest(fluid, grid);
}

/// The passes of a step over PPs that are all owned.
template <class Pass, int D>
auto sum(Pass& pass, FluidParticles<D>& fluid, const CellGrid<D>& grid, std::vector<double>& density) {
  density.resize(fluid.size());
  return sum_densities(pass, fluid, grid).close({}, density).sum_inner(grid).sum_rest(density, grid);
}

/// Tells the pass where those that are not foreign have moved to, in lanes where it takes them.
template <class Forces, int D>
void tell_of_motion(Forces&& forces, const FluidParticles<D>& fluid, const std::vector<std::uint8_t>& foreign) {
  for (std::uint32_t i = 0; i < fluid.size();) {
    const std::uint32_t slot = forces.pass().blocks().slot(i);
    const bool lanes = slot % lane_count == 0 && i + lane_count <= fluid.size() &&
                       forces.pass().blocks().slot(i + lane_count - 1) == slot + lane_count - 1;
    if (lanes && std::count(foreign.begin() + i, foreign.begin() + i + lane_count, 0) == lane_count) {
      Vec<D, Lanes> x, v;
      for (int axis = 0; axis < D; ++axis) {
        x[axis] = load_lanes(&fluid.x(axis)[i]);
        v[axis] = load_lanes(&fluid.v(axis)[i]);
      }
      forces.moved(slot, x, v);
      i += lane_count;
      continue;
    }
    if (foreign[i] == 0) {
      Vec<D, double> x = fluid.position(i), v;
      for (int axis = 0; axis < D; ++axis) v[axis] = fluid.v(axis)[i];
      forces.moved(slot, x, v);
    }
    ++i;
  }
}

template <int D>
Vec<D, double> lengths_in_reach(const Model<D>& model) {
  Vec<D, double> lengths;
  for (int axis = 0; axis < D; ++axis) lengths[axis] = model.pair.length[axis] / reach;
  return lengths;
}

struct AllSums {
  std::vector<double> density;
  std::vector<NeighbourSums<2>> forces;
};

template <class Numbers>
AllSums sums_over(const Model<2>& model, FluidParticles<2> fluid, double behind, Lists kind) {
  for (auto& values : fluid.field) {  // what lies in memory behind the last particle
    const std::size_t count = values.size();
    values.resize(count + 64, behind);
    values.resize(count);
  }
  CellGrid<2> grid;
  grid.fit(Region<2>::whole_box(), lengths_in_reach(model), {{8, 2}});
  grid.sort(fluid);
  for (auto& values : fluid.field) {  // sorting swapped the arrays
    const std::size_t count = values.size();
    values.resize(count + 64, behind);
    values.resize(count);
  }
  FluidPass<2, Numbers> pass(model, 1);
  pass.list(fluid, grid, Region<2>::whole_box(), kind == Lists::once ? 1.0 : reach, all_of(fluid), false);
  AllSums result;
  const auto forces = sum(pass, fluid, grid, result.density);
  for (std::uint32_t i = 0; i < fluid.size(); ++i) result.forces.push_back(forces.sums(pass.blocks().slot(i)));
  return result;
}

template <class Numbers>
void expect_blindness() {
  const testing::Built<2> built(swirl);
  const State<2> state = built.state();
  for (const Lists kind : {Lists::once, Lists::kept}) {
    const auto clean = sums_over<Numbers>(built.model, state.fluid, 0.0, kind);
    const auto dirty = sums_over<Numbers>(built.model, state.fluid, std::numeric_limits<double>::quiet_NaN(), kind);
    EXPECT_EQ(clean.density, dirty.density);
    ASSERT_EQ(clean.forces.size(), dirty.forces.size());
    for (std::size_t i = 0; i < clean.forces.size(); ++i) {
      EXPECT_EQ(clean.forces[i].impulse, dirty.forces[i].impulse) << "particle " << i;
      EXPECT_EQ(clean.forces[i].shift, dirty.forces[i].shift) << "particle " << i;
      EXPECT_EQ(clean.forces[i].shear, dirty.forces[i].shear) << "particle " << i;
      EXPECT_EQ(clean.forces[i].agitation, dirty.forces[i].agitation) << "particle " << i;
    }
  }
}

TEST(FluidPass, does_not_see_what_lies_behind_the_last_particle) {
  expect_blindness<DoubleLanes<2>>();
  expect_blindness<SingleLanes<2>>();
}

/// Particles at random all over the box, every fifth of them in a heap narrower than the cutoff: rows that hold many
/// blocks of lanes, and planes that hold few particles.
template <int D>
FluidParticles<D> heap(const Model<D>& model, std::size_t count) {
  std::mt19937_64 random(5);
  FluidParticles<D> fluid;
  fluid.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    fluid.id[i] = i;
    for (int axis = 0; axis < D; ++axis) {
      std::uniform_real_distribution<double> anywhere(0.0, box_quanta), in_heap(0.5, 0.5 + 0.3 / model.box[axis]);
      fluid.x(axis)[i] = std::floor(i % 5 == 0 ? box_quanta * in_heap(random) : anywhere(random));
      fluid.v(axis)[i] = static_cast<double>(random() % 1000) * velocity_quantum * 1e9;
    }
  }
  return fluid;
}

/// The lattice of the scene in disorder: PPs at least some tenths of a spacing apart.
template <int D>
FluidParticles<D> disordered(const testing::Built<D>& built) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> share(-0.2, 0.2);
  FluidParticles<D> fluid = built.state().fluid;
  for (int axis = 0; axis < D; ++axis)
    for (double& x : fluid.x(axis))
      x = std::clamp(x + std::trunc(share(random) * built.model.spacing / built.model.pair.length[axis]), 0.0,
                     box_quanta - 1.0);
  return fluid;
}

/// Moves every PP by half of what the reach leaves, most of that along one axis, so that many pairs come nearer by all.
template <int D>
void stir(const Model<D>& model, FluidParticles<D>& fluid) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    const int main_axis = static_cast<int>(random() % D);
    const double along = (random() % 2 == 0 ? 1.0 : -1.0) * 0.98, across = 0.1 * share(random);
    for (int axis = 0; axis < D; ++axis)
      fluid.x(axis)[i] +=
          std::trunc(0.5 * (reach - 1.0) * (axis == main_axis ? along : across) / model.pair.length[axis]);
  }
}

struct Case {
  std::string scene;
  std::size_t count;
  double along, across;  // cells to a reach
  int threads;
  Lists kind;
  std::size_t least_pairs = 10000;
  bool apart = false;  // none so near to another as in the heap
};

/// All pairs of a fluid, one by one. Sums are integers, so their order does not matter.
template <int D, class Numbers, class Kernel>
class AllPairs {
  using Real = typename Numbers::Real;

 public:
  AllPairs(const Model<D>& model, const FluidParticles<D>& fluid)
      : model_(model), fluid_(fluid), numbers_(model.pair, model.rest_density) {
    for (std::size_t i = 0; i < fluid.size(); ++i) {
      std::int64_t sum = 0;
      for (std::size_t j = 0; j < fluid.size(); ++j)
        if (j != i) sum += numbers_.density(pair_density<Kernel>(numbers_.law(), distance(point(i), point(j))));
      density_.push_back(static_cast<double>(sum) * density_quantum + model.self_density);
    }
  }
  const std::vector<double>& density() const { return density_; }

  /// What PP i receives, all having these densities.
  NeighbourSums<D> forces(std::size_t i, std::span<const double> density) const {
    NeighbourSums<D> sums{};
    for (std::size_t j = 0; j < fluid_.size(); ++j) {
      if (j == i) continue;
      const auto given = of_pair(point(i, density), point(j, density), Real(1));
      sums.impulse += given.impulse;
      sums.shift += given.shift;
      sums.shear += given.shear;
      sums.agitation += given.agitation;
    }
    return sums;
  }
  /// What one point gives another, from whose position to that of the first the vector of beta points.
  template <class Beta>
  NeighbourSums<D> of_pair(const PairPoint<D>& one, const PairPoint<D>& other, const Beta& beta) const {
    const auto pair = pair_of(numbers_, one, other, difference);
    const auto r = separation(numbers_.law(), pair.d);
    if constexpr (requires { beta(r); })
      return numbers_.sums(fluid_pair<Kernel, true>(numbers_.law(), pair, r, cut_distance(dot(r, r)), beta(r)));
    else
      return numbers_.sums(fluid_pair<Kernel, true>(numbers_.law(), pair, r, cut_distance(dot(r, r)), beta));
  }
  std::int64_t density_of_pair(const PairPoint<D>& one, const PairPoint<D>& other) const {
    return numbers_.density(pair_density<Kernel>(numbers_.law(), distance(one, other)));
  }
  PairPoint<D> point(std::size_t i) const {
    PairPoint<D> result;
    for (int axis = 0; axis < D; ++axis) {
      result.x[axis] = fluid_.x(axis)[i];
      result.v[axis] = fluid_.v(axis)[i];
    }
    return result;
  }
  PairPoint<D> point(std::size_t i, std::span<const double> density) const {
    PairPoint<D> result = point(i);
    result.volume = volume_terms(density[i], model_.rest_density, 1.0, model_.background);
    return result;
  }
  /// Partners within the cutoff.
  std::size_t partners(std::size_t i) const {
    std::size_t count = 0;
    for (std::size_t j = 0; j < fluid_.size(); ++j) count += j != i && distance(point(i), point(j)) < 1 ? 1u : 0u;
    return count;
  }

 private:
  static double difference(double a, double b) { return a - b; }
  Real distance(const PairPoint<D>& one, const PairPoint<D>& other) const {
    const auto r = separation(numbers_.law(), pair_of(numbers_, one, other, difference).d);
    return cut_distance(dot(r, r));
  }

  const Model<D>& model_;
  const FluidParticles<D>& fluid_;
  Numbers numbers_;
  std::vector<double> density_;
};

/// A region inside the box, around which the other particles stand for ghosts.
template <int D>
Region<D> inner_region(const Model<D>& model) {
  Region<D> region;
  for (int axis = 0; axis < D; ++axis) {
    region.low[axis] = std::ceil((reach + 0.1) / model.pair.length[axis]);
    region.high[axis] = box_quanta - region.low[axis];
  }
  return region;
}

/// The two passes against all pairs: densities of what is owned, then forces, for which others are given densities by
/// hand.
template <int D, class Numbers, class Kernel>
void expect_sums_of_all_pairs(const Case& test) {
  SCOPED_TRACE(::testing::Message() << D << "D, cells " << test.along << " x " << test.across << ", threads "
                                    << test.threads << ", lists " << static_cast<int>(test.kind));
  const testing::Built<D> built(test.scene);
  const Model<D>& model = built.model;
  FluidParticles<D> fluid = test.apart ? disordered(built) : heap(model, test.count);
  const Region<D> region = inner_region(model);
  Vec<D, double> cells;
  for (int axis = 0; axis < D; ++axis) cells[axis] = axis == 0 ? test.along : test.across;
  CellGrid<D> grid;
  grid.fit(region, lengths_in_reach(model), cells);
  grid.sort(fluid);
  FluidPass<D, Numbers> pass(model, test.threads);
  const bool in_parts = test.kind == Lists::kept_in_parts;
  std::vector<std::uint32_t> foreign;
  std::vector<std::uint8_t> is_foreign(fluid.size(), 0);
  for (std::uint32_t i = 0; i < fluid.size(); ++i)
    if (!in_parts || !region.contains(fluid.position(i)) || fluid.x(0)[i] > 0.7 * box_quanta) {
      foreign.push_back(i);
      is_foreign[i] = 1;
    }
  pass.list(fluid, grid, widened(model, region, 0.5 * (reach - 1.0)), test.kind == Lists::once ? 1.0 : reach, foreign,
            in_parts);
  if (test.kind == Lists::kept_after_motion || in_parts) {
    std::vector<double> density;
    auto forces = sum(pass, fluid, grid, density);
    stir(model, fluid);
    tell_of_motion(forces, fluid, is_foreign);
  }
  const AllPairs<D, Numbers, Kernel> all(model, fluid);
  std::vector<std::uint32_t> others;
  for (std::uint32_t i = 0; i < fluid.size(); ++i)
    if (!region.contains(fluid.position(i)) && is_foreign[i] != 0) others.push_back(i);
  std::vector<double> density(fluid.size(), -1.0);
  auto known = sum_densities(pass, fluid, grid).close(others, density);
  for (const std::uint32_t i : others) ASSERT_EQ(density[i], model.rest_density);
  for (std::uint32_t i = 0; i < fluid.size(); ++i)
    if (region.contains(fluid.position(i))) {
      ASSERT_EQ(density[i], all.density()[i]) << "particle " << i;
    }
  auto inner = std::move(known).sum_inner(grid);
  for (const std::uint32_t i : others) density[i] = model.rest_density * (0.9 + 0.001 * (i % 200));
  const auto forces = std::move(inner).sum_rest(density, grid);
  std::size_t pairs = 0;
  for (std::uint32_t i = 0; i < fluid.size(); ++i) {
    if (!region.contains(fluid.position(i))) continue;
    const NeighbourSums<D> sums = all.forces(i, density), found = forces.sums(pass.blocks().slot(i));
    ASSERT_EQ(found.impulse, sums.impulse) << "particle " << i;
    ASSERT_EQ(found.shift, sums.shift) << "particle " << i;
    ASSERT_EQ(found.shear, sums.shear) << "particle " << i;
    ASSERT_EQ(found.agitation, sums.agitation) << "particle " << i;
    pairs += all.partners(i);
  }
  EXPECT_GE(pairs, test.least_pairs);
}

/// What needs no message is most of the work in a region that is wide enough.
TEST(FluidPass, leaves_little_for_the_second_part) {
  const testing::Built<2> built(swirl_in("[40.0, 5.0]"));
  FluidParticles<2> fluid = built.state().fluid;
  CellGrid<2> grid;
  grid.fit(Region<2>::whole_box(), lengths_in_reach(built.model), {{8, 1}});
  grid.sort(fluid);
  std::vector<std::uint32_t> foreign;
  for (std::uint32_t i = 0; i < fluid.size(); ++i)
    if (fluid.x(0)[i] > 0.9 * box_quanta) foreign.push_back(i);
  FluidPass<2, DoubleLanes<2>> pass(built.model, 1);
  pass.list(fluid, grid, Region<2>::whole_box(), reach, foreign, true);
  const auto& lists = pass.lists().all();
  ASSERT_EQ(lists.size(), 2u);
  const auto first = static_cast<double>(lists[0].blocks().size()),
             second = static_cast<double>(lists[1].blocks().size());
  EXPECT_GT(first / (first + second), 0.8);
  EXPECT_LT(first / (first + second), 0.9);
}

std::string with_kernel(const std::string& scene, const std::string& kernel) {
  return testing::replaced(scene, "viscosity", "kernel = \"" + kernel + "\"\nviscosity");
}

TEST(FluidPass, sums_over_all_pairs) {
  const std::string deep = swirl_in("[4.0, 5.0, 6.0]");
  for (const Lists kind : all_kinds)
    for (const int threads : {1, 3})
      for (const double across : {1.0, 1.45, 3.0})
        for (const double along : {1.0, 8.0}) {
          expect_sums_of_all_pairs<2, DoubleLanes<2>, WendlandC2>({swirl, 1000, along, across, threads, kind, 5000});
          expect_sums_of_all_pairs<3, DoubleLanes<3>, WendlandC2>({deep, 1000, along, across, threads, kind, 5000});
          expect_sums_of_all_pairs<2, SingleLanes<2>, WendlandC2>({swirl, 1000, along, across, threads, kind, 5000});
          expect_sums_of_all_pairs<3, SingleLanes<3>, WendlandC2>({deep, 1000, along, across, threads, kind, 5000});
        }
}

TEST(FluidPass, sums_over_all_pairs_with_other_kernels) {
  const std::string deep = swirl_in("[4.0, 5.0, 6.0]");
  for (const Lists kind : all_kinds)
    for (const int threads : {1, 2}) {
      expect_sums_of_all_pairs<2, DoubleLanes<2>, Lucy>({with_kernel(swirl, "lucy"), 1000, 8, 1, threads, kind, 5000});
      expect_sums_of_all_pairs<3, SingleLanes<3>, Lucy>(
          {with_kernel(deep, "lucy"), 1000, 8, 1.45, threads, kind, 5000});
      // Its weight is singular, and an impulse must not leave its range.
      expect_sums_of_all_pairs<2, DoubleLanes<2>, MpsWeight>(
          {with_kernel(swirl, "mps"), 0, 8, 1, threads, kind, 1000, true});
      expect_sums_of_all_pairs<3, SingleLanes<3>, MpsWeight>(
          {with_kernel(swirl_in("[4.0, 4.0, 4.0]"), "mps"), 0, 8, 1.45, threads, kind, 5000, true});
    }
}

/// Few particles in a long box: a block of them is wider than the window in which coordinates of single precision
/// differ.
TEST(FluidPass, sums_over_all_pairs_where_blocks_are_wide) {
  const std::string wide = swirl_in("[40.0, 5.0]"), long_box = swirl_in("[40.0, 5.0, 5.0]");
  for (const Lists kind : all_kinds)
    for (const double along : {1.0, 8.0}) {
      expect_sums_of_all_pairs<2, DoubleLanes<2>, WendlandC2>({wide, 200, along, 1, 1, kind, 100});
      expect_sums_of_all_pairs<2, SingleLanes<2>, WendlandC2>({wide, 200, along, 1, 1, kind, 100});
      // In space two rows share a block.
      for (std::size_t count = 20; count < 120; count += 2)
        expect_sums_of_all_pairs<3, SingleLanes<3>, WendlandC2>({long_box, count, along, 1, 1, kind, 0});
    }
}

/// FPs anywhere, owned and not, by whatever solids.
template <int D>
std::vector<FrozenInStep<D>> some_frozen(const Model<D>& model, std::size_t count) {
  const FluidParticles<D> positions = heap(model, count);
  std::vector<FrozenInStep<D>> frozen(count);
  for (std::uint32_t k = 0; k < count; ++k) {
    FrozenInStep<D>& fp = frozen[k];
    for (int axis = 0; axis < D; ++axis) {
      fp.place.x[axis] = positions.x(axis)[k] + 3.0;
      fp.place.v[axis] = 0.01 * (k % 7);
    }
    fp.place.normal[static_cast<int>(k % D)] = 1.0;
    fp.depth = 0.1;
    fp.index = k;
    set_density(model, fp, model.rest_density * (1.0 + 0.001 * (k % 50)));
  }
  return frozen;
}

template <int D, class Numbers>
void expect_frozen_sums_of_all_pairs(const std::string& scene, int threads) {
  SCOPED_TRACE(::testing::Message() << D << "D, threads " << threads);
  testing::Built<D> built(scene);
  Model<D>& model = built.model;
  model.terms.extrapolated = true;
  FluidParticles<D> fluid = heap(model, 500);
  const Region<D> region = inner_region(model);
  CellGrid<D> grid;
  grid.fit(region, lengths_in_reach(model), cells_per_reach(model, reach));
  grid.sort(fluid);
  std::vector<FrozenInStep<D>> frozen = some_frozen(model, 300);
  FluidPass<D, Numbers> pass(model, threads);
  pass.list(fluid, grid, region, 1.0, all_of(fluid), false);
  const AllPairs<D, Numbers, WendlandC2> all(model, fluid);
  const auto point_of_frozen = [](const FrozenInStep<D>& fp) {
    return PairPoint<D>{fp.place.x, fp.place.v, fp.volume};
  };

  std::vector<std::int64_t> sums;
  std::vector<double> density(fluid.size());
  auto densities = sum_densities(pass, fluid, grid);
  densities.add_frozen(grid, frozen, sums);
  auto known = std::move(densities).close({}, density);
  ASSERT_EQ(sums.size(), frozen.size());
  std::vector<double> expected = all.density();
  for (std::size_t k = 0; k < frozen.size(); ++k) {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
      const std::int64_t given = all.density_of_pair(all.point(i), point_of_frozen(frozen[k]));
      sum += given;
      expected[i] += static_cast<double>(given) * density_quantum;
    }
    if (region.contains(frozen[k].place.x)) {
      ASSERT_EQ(sums[k], sum) << "FP " << k;
    }
  }
  for (std::size_t i = 0; i < fluid.size(); ++i)
    if (region.contains(fluid.position(i))) {
      ASSERT_EQ(density[i], expected[i]) << "particle " << i;
    }

  std::vector<NeighbourSums<D>> received;
  auto forces = std::move(known).sum_inner(grid).sum_rest(density, grid);
  forces.add_frozen(grid, frozen, received);
  ASSERT_EQ(received.size(), frozen.size());
  std::vector<NeighbourSums<D>> on_fluid(fluid.size(), NeighbourSums<D>{});
  for (std::size_t k = 0; k < frozen.size(); ++k) {
    const NoSlipFactor<D, typename Numbers::Real> beta(model, frozen[k]);
    NeighbourSums<D> opposite{};
    for (std::size_t i = 0; i < fluid.size(); ++i) {
      const NeighbourSums<D> given = all.of_pair(all.point(i, density), point_of_frozen(frozen[k]), beta);
      on_fluid[i].impulse += given.impulse;
      on_fluid[i].shift += given.shift;
      on_fluid[i].shear += given.shear;
      on_fluid[i].agitation += given.agitation;
      opposite.impulse -= given.impulse;
    }
    if (region.contains(frozen[k].place.x)) {
      ASSERT_EQ(received[k].impulse, opposite.impulse) << "FP " << k;
    }
  }
  for (std::uint32_t i = 0; i < fluid.size(); ++i) {
    if (!region.contains(fluid.position(i))) continue;
    const NeighbourSums<D> sums_of_fluid = all.forces(i, density), found = forces.sums(pass.blocks().slot(i));
    ASSERT_EQ(found.impulse, sums_of_fluid.impulse + on_fluid[i].impulse) << "particle " << i;
    ASSERT_EQ(found.shift, sums_of_fluid.shift + on_fluid[i].shift) << "particle " << i;
    ASSERT_EQ(found.shear, sums_of_fluid.shear + on_fluid[i].shear) << "particle " << i;
    ASSERT_EQ(found.agitation, sums_of_fluid.agitation + on_fluid[i].agitation) << "particle " << i;
  }
}

TEST(FluidPass, sums_over_all_pairs_with_frozen_particles) {
  const std::string deep = swirl_in("[4.0, 5.0, 6.0]");
  for (const int threads : {1, 3}) {
    expect_frozen_sums_of_all_pairs<2, DoubleLanes<2>>(swirl, threads);
    expect_frozen_sums_of_all_pairs<2, SingleLanes<2>>(swirl, threads);
    expect_frozen_sums_of_all_pairs<3, DoubleLanes<3>>(deep, threads);
    expect_frozen_sums_of_all_pairs<3, SingleLanes<3>>(deep, threads);
  }
}

TEST(FluidPass, names_an_owned_particle_whose_density_is_out_of_range) {
  const testing::Built<2> built(swirl);
  FluidParticles<2> fluid = built.state().fluid;
  CellGrid<2> grid;
  grid.fit(Region<2>::whole_box(), lengths_in_reach(built.model), {{8, 1}});
  const auto wrong = [&](const std::vector<std::uint32_t>& others) {
    grid.sort(fluid);
    FluidPass<2, DoubleLanes<2>> pass(built.model, 1);
    pass.list(fluid, grid, Region<2>::whole_box(), 1.0, all_of(fluid), false);
    std::vector<double> density(fluid.size());
    static_cast<void>(sum_densities(pass, fluid, grid).close(others, density));
    return find_out_of_range(density, built.model.rest_density);
  };
  EXPECT_FALSE(wrong({}).has_value());
  // Eighty-one at one position have 81 W(0), and W(0) is 7 / pi, of a rest density of 12.25.
  for (int n = 0; n < 80; ++n) {
    fluid.id.push_back(1000 + fluid.id.size());
    for (auto& values : fluid.field) values.push_back(values[100]);
  }
  const auto found = wrong({});
  ASSERT_TRUE(found.has_value());
  EXPECT_FALSE(wrong(all_of(fluid)).has_value()) << "others answer for theirs";
}

}  // namespace
}  // namespace mappm
