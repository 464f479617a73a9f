// Oracles: the pair law between all pairs, and the same pass over memory that holds nothing else.
#include "parallel/fluid_pass.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <string>

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
void list_or_sum(Pass& pass, FluidParticles<D>& fluid, const CellGrid<D>& grid, const Region<D>& region, Lists kind) {
  if (kind == Lists::once) return pass.sum_once(fluid, grid);
  pass.list(fluid, grid, region, reach, all_of(fluid), false);
  if (kind == Lists::kept) pass.sum(fluid, grid);
}

/// Tells the pass where those that are not foreign have moved to, in lanes where it takes them.
template <class Pass, int D>
void tell_of_motion(Pass& pass, const FluidParticles<D>& fluid, const std::vector<std::uint8_t>& foreign) {
  for (std::uint32_t i = 0; i < fluid.size();) {
    const std::uint32_t place = pass.place(i);
    const bool lanes = place % lane_count == 0 && i + lane_count <= fluid.size() &&
                       pass.place(i + lane_count - 1) == place + lane_count - 1;
    if (lanes && std::count(foreign.begin() + i, foreign.begin() + i + lane_count, 0) == lane_count) {
      Vec<D, Lanes> x, v;
      for (int axis = 0; axis < D; ++axis) {
        x[axis] = load_lanes(&fluid.x(axis)[i]);
        v[axis] = load_lanes(&fluid.v(axis)[i]);
      }
      pass.moved(place, x, v, load_lanes(&fluid.density()[i]));
      i += lane_count;
      continue;
    }
    if (foreign[i] == 0) {
      Vec<D, double> x = fluid.position(i), v;
      for (int axis = 0; axis < D; ++axis) v[axis] = fluid.v(axis)[i];
      pass.moved(place, x, v, fluid.density()[i]);
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

template <class Numbers>
std::vector<NeighbourSums<2>> sums_over(const Model<2>& model, FluidParticles<2> fluid, double behind, Lists kind) {
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
  std::vector<NeighbourSums<2>> result;
  list_or_sum(pass, fluid, grid, Region<2>::whole_box(), kind);
  for (std::uint32_t i = 0; i < fluid.size(); ++i) result.push_back(pass.sums(pass.place(i)));
  return result;
}

template <class Numbers>
void expect_blindness() {
  const testing::Built<2> built(swirl);
  const State<2> state = built.state();
  for (const Lists kind : {Lists::once, Lists::kept}) {
    const auto clean = sums_over<Numbers>(built.model, state.fluid, 0.0, kind);
    const auto dirty = sums_over<Numbers>(built.model, state.fluid, std::numeric_limits<double>::quiet_NaN(), kind);
    ASSERT_EQ(clean.size(), dirty.size());
    for (std::size_t i = 0; i < clean.size(); ++i) {
      EXPECT_EQ(clean[i].impulse, dirty[i].impulse) << "particle " << i;
      EXPECT_EQ(clean[i].shift, dirty[i].shift) << "particle " << i;
      EXPECT_EQ(clean[i].density, dirty[i].density) << "particle " << i;
    }
  }
}

TEST(FluidPass, does_not_see_what_lies_behind_the_last_particle) {
  expect_blindness<DoublePairs<2>>();
  expect_blindness<SinglePairs<2>>();
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
    fluid.density()[i] = model.rest_density * (0.9 + 0.2 * static_cast<double>(random() % 1000) / 1000.0);
  }
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

/// The pass over a region inside the box, around which the other particles stand for ghosts, against all pairs.
template <int D, class Numbers>
void expect_sums_of_all_pairs(const char* scene, std::size_t count, double along, double across, int threads,
                              Lists kind, std::size_t least_pairs = 10000) {
  SCOPED_TRACE(::testing::Message() << D << "D, cells " << along << " x " << across << ", threads " << threads
                                    << ", lists " << static_cast<int>(kind));
  const testing::Built<D> built(scene);
  const Model<D>& model = built.model;
  FluidParticles<D> fluid = heap(model, count);
  Region<D> region;
  Vec<D, double> cells;
  for (int axis = 0; axis < D; ++axis) {
    region.low[axis] = std::ceil((reach + 0.1) / model.pair.length[axis]);
    region.high[axis] = box_quanta - region.low[axis];
    cells[axis] = axis == 0 ? along : across;
  }
  CellGrid<D> grid;
  grid.fit(region, lengths_in_reach(model), cells);
  grid.sort(fluid);
  FluidPass<D, Numbers> pass(model, threads);
  const Numbers numbers(model.pair, model.rest_density);
  const Region<D> wide = widened(model, region, 0.5 * (reach - 1.0));
  if (kind == Lists::kept_in_parts) {
    std::vector<std::uint32_t> foreign;
    std::vector<std::uint8_t> is_foreign(fluid.size(), 0);
    for (std::uint32_t i = 0; i < fluid.size(); ++i)
      if (fluid.x(0)[i] > 0.7 * box_quanta) {
        foreign.push_back(i);
        is_foreign[i] = 1;
      }
    pass.list(fluid, grid, wide, reach, foreign, true);
    pass.sum(fluid, grid);
    stir(model, fluid);
    tell_of_motion(pass, fluid, is_foreign);
    pass.sum_inner(grid);
    pass.sum_rest(fluid, grid);
  } else {
    list_or_sum(pass, fluid, grid, wide, kind);
  }
  if (kind == Lists::kept_after_motion) {
    pass.sum(fluid, grid);
    stir(model, fluid);
    pass.sum(fluid, grid);
  }
  const auto point = [&](std::size_t i) {
    PairPoint<D> result;
    for (int axis = 0; axis < D; ++axis) {
      result.x[axis] = fluid.x(axis)[i];
      result.v[axis] = fluid.v(axis)[i];
    }
    result.volume = volume_terms(fluid.density()[i], model.rest_density, 1.0, model.background);
    return result;
  };
  std::size_t pairs = 0;
  for (std::uint32_t i = 0; i < fluid.size(); ++i) {
    if (!region.contains(point(i).x)) continue;
    NeighbourSums<D> sums{};
    for (std::size_t j = 0; j < fluid.size(); ++j) {
      if (j == i) continue;
      const auto pair = pair_of(numbers, point(i), point(j), [](double a, double b) { return a - b; });
      const auto r = separation(numbers.law(), pair.d);
      const auto given = numbers.sums(fluid_pair<WendlandC2, true>(numbers.law(), pair, r, cut_distance(dot(r, r)),
                                                                   static_cast<typename Numbers::Real>(1)));
      sums.impulse += given.impulse;
      sums.shift += given.shift;
      sums.density += given.density;
      if (dot(r, r) < 1) ++pairs;
    }
    const NeighbourSums<D> found = pass.sums(pass.place(i));
    ASSERT_EQ(found.impulse, sums.impulse) << "particle " << i;
    ASSERT_EQ(found.shift, sums.shift) << "particle " << i;
    ASSERT_EQ(found.density, sums.density) << "particle " << i;
  }
  EXPECT_GE(pairs, least_pairs);
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
  FluidPass<2, DoublePairs<2>> pass(built.model, 1);
  pass.list(fluid, grid, Region<2>::whole_box(), reach, foreign, true);
  ASSERT_EQ(pass.kept().size(), 2u);
  const auto first = static_cast<double>(pass.kept()[0].blocks().size()),
             second = static_cast<double>(pass.kept()[1].blocks().size());
  EXPECT_GT(first / (first + second), 0.8);
  EXPECT_LT(first / (first + second), 0.9);
}

TEST(FluidPass, sums_over_all_pairs) {
  const std::string deep = swirl_in("[4.0, 5.0, 6.0]");
  for (const Lists kind : all_kinds)
    for (const int threads : {1, 3})
      for (const double across : {1.0, 1.45, 2.3, 3.0})
        for (const double along : {1.0, 8.0}) {
          expect_sums_of_all_pairs<2, DoublePairs<2>>(swirl, 1500, along, across, threads, kind);
          expect_sums_of_all_pairs<3, DoublePairs<3>>(deep.c_str(), 1500, along, across, threads, kind);
          expect_sums_of_all_pairs<2, SinglePairs<2>>(swirl, 1000, along, across, threads, kind, 5000);
          expect_sums_of_all_pairs<3, SinglePairs<3>>(deep.c_str(), 1000, along, across, threads, kind, 5000);
        }
}

/// Few particles in a long box: a block of them is wider than the window in which places of single precision differ.
TEST(FluidPass, sums_over_all_pairs_where_blocks_are_wide) {
  const std::string wide = swirl_in("[40.0, 5.0]"), long_box = swirl_in("[40.0, 5.0, 5.0]");
  for (const Lists kind : all_kinds)
    for (const double along : {1.0, 8.0}) {
      expect_sums_of_all_pairs<2, DoublePairs<2>>(wide.c_str(), 200, along, 1, 1, kind, 100);
      expect_sums_of_all_pairs<2, SinglePairs<2>>(wide.c_str(), 200, along, 1, 1, kind, 100);
      // In space two rows share a block.
      for (std::size_t count = 20; count < 120; count += 2)
        expect_sums_of_all_pairs<3, SinglePairs<3>>(long_box.c_str(), count, along, 1, 1, kind, 0);
    }
}

}  // namespace
}  // namespace mappm
