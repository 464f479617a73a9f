// Oracles: a plain double loop over all particles and their periodic images; a cell repeated.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "serial/engine.hpp"
#include "unit/serial/scenes.hpp"

namespace mappm {
namespace {

using testing::Built;
using testing::head;

/// Calls visit(shift) for the shifts of all periodic images that can be near.
template <int D, class Visit>
void for_each_image(Visit&& visit) {
  for (int n = 0; n < (D == 2 ? 9 : 27); ++n) {
    Vec<D, double> shift;
    for (int axis = 0, rest = n; axis < D; ++axis, rest /= 3) shift[axis] = (rest % 3 - 1) * box_quanta;
    visit(shift);
  }
}

template <int D>
std::vector<FrozenInStep<D>> all_frozen(const Model<D>& model, const State<D>& state) {
  Region<D> everywhere;
  for (int axis = 0; axis < D; ++axis) {
    everywhere.low[axis] = -box_quanta;
    everywhere.high[axis] = 2.0 * box_quanta;
  }
  std::vector<FrozenInStep<D>> frozen;
  for (std::uint32_t k = 0; k < state.solids.size(); ++k)
    place_frozen(model, solid_in_step(model, state.solids[k]), k, everywhere, frozen);
  return frozen;
}

/// What particles at two places give each other, in all images; without the one in which both are the same particle.
template <int D, class Kernel, class Numbers>
std::int64_t given(const Numbers& numbers, const Vec<D, double>& x, const Vec<D, double>& y, bool images_alone) {
  std::int64_t sum = 0;
  for_each_image<D>([&](const Vec<D, double>& shift) {
    if (images_alone && shift == Vec<D, double>{}) return;
    const PairPoint<D> one{x, {}, {}}, other{y + shift, {}, {}};
    const auto r = separation(numbers.law(), pair_of(numbers, one, other, [](double a, double b) { return a - b; }).d);
    sum += numbers.density(pair_density<Kernel>(numbers.law(), cut_distance(dot(r, r))));
  });
  return sum;
}

/// In single precision places are seen in a window that repeats, so images are not told apart: the box must be wider.
template <int D, class Kernel, class Numbers>
void expect_densities_of_a_double_loop(const Built<D>& built, const Sample<D>& sample) {
  const Model<D>& model = built.model;
  const State<D>& state = sample.state;
  const Numbers numbers(model.pair, model.rest_density);
  const DoublePairs<D> doubles(model.pair, model.rest_density);
  const std::vector<FrozenInStep<D>> frozen = all_frozen(model, state);
  std::vector<std::int64_t> of_frozen(frozen.size(), 0);
  ASSERT_EQ(sample.density.fluid.size(), state.fluid.size());
  const auto nearest = [](const Vec<D, double>& x, const Vec<D, double>& y) {
    Vec<D, double> d;
    for (int axis = 0; axis < D; ++axis) d[axis] = x[axis] - nearest_difference(x[axis], wrap_position(y[axis]));
    return d;
  };
  const auto of_pair = [&](const Vec<D, double>& x, const Vec<D, double>& y) {
    const PairPoint<D> one{x, {}, {}}, other{nearest(x, y), {}, {}};
    const auto r = separation(numbers.law(), pair_of(numbers, one, other, nearest_difference).d);
    return numbers.density(pair_density<Kernel>(numbers.law(), cut_distance(dot(r, r))));
  };
  for (std::size_t i = 0; i < state.fluid.size(); ++i) {
    std::int64_t sum = 0;
    for (std::size_t j = 0; j < state.fluid.size(); ++j)
      if (j != i) sum += of_pair(state.fluid.position(i), state.fluid.position(j));
    for (std::size_t k = 0; k < frozen.size(); ++k) {
      const std::int64_t shared = of_pair(state.fluid.position(i), frozen[k].place.x);
      sum += shared;
      of_frozen[k] += shared;
    }
    ASSERT_EQ(sample.density.fluid[i], static_cast<double>(sum) * density_quantum + model.self_density) << i;
  }
  ASSERT_EQ(sample.density.frozen.size(), frozen.size());
  for (std::size_t k = 0; k < frozen.size(); ++k) {
    const Solid<D>& solid = state.solids[frozen[k].solid];
    for (std::size_t n = 0; n < frozen.size(); ++n) {
      const Solid<D>& other = state.solids[frozen[n].solid];
      const bool same = solid.id == other.id;
      if (solid.group == other.group && (!same || is_wall_piece(model.shapes[solid.shape]))) continue;
      of_frozen[k] += given<D, Kernel>(doubles, frozen[k].place.x, frozen[n].place.x, same);
    }
    const FrozenPoint<D>& found = sample.density.frozen[k];
    ASSERT_EQ(found.solid, solid.id);
    ASSERT_EQ(found.index, frozen[k].index);
    ASSERT_EQ(found.x, frozen[k].place.x);
    ASSERT_EQ(found.v, frozen[k].place.v);
    ASSERT_EQ(found.density, static_cast<double>(of_frozen[k]) * density_quantum + frozen[k].own_density)
        << "solid " << solid.id << ", FP " << found.index;
  }
}

template <int D, class Kernel>
void expect_densities_in_both_precisions(const std::string& scene) {
  for (const bool single : {false, true}) {
    SCOPED_TRACE(::testing::Message() << D << "D, " << Kernel::name << (single ? ", single" : ", double"));
    const Built<D> built(testing::replaced(
        scene, "viscosity = 0.5",
        std::string("viscosity = 0.5\nkernel = \"") + Kernel::name + (single ? "\"\nprecision = \"single\"" : "\"")));
    for (const Neighbours neighbours : {Neighbours::cells, Neighbours::all_pairs}) {
      SerialEngine<D> engine(built.model, built.state(), neighbours);
      for (int step = 0; step < 3; ++step) engine.step();
      if (single)
        expect_densities_of_a_double_loop<D, Kernel, SinglePairs<D>>(built, engine.sample());
      else
        expect_densities_of_a_double_loop<D, Kernel, DoublePairs<D>>(built, engine.sample());
      EXPECT_EQ(engine.first_fault().text(), "");
    }
  }
}

std::string two_discs() {
  return head("[5.1, 4.8]", "0.3", "11.1111111111",
              "wave = { amplitude = 0.02, direction = \"x\", gradient = \"y\" }") +
         "[[body]]\nshape = \"disc\"\nradius = 0.8\ndensity = 20.0\npositions = [[1.5, 1.5], [3.2, 1.7], [0.2, 3.5]]\n"
         "angular_velocity = 0.05\n";
}
std::string two_spheres() {
  return head("[4.5, 4.5, 4.5]", "0.5", "8.0") +
         "[[body]]\nshape = \"sphere\"\nradius = 0.8\ndensity = 30.0\npositions = [[1.5, 1.5, 1.5], [3.2, 1.55, 1.6]]\n"
         "velocity = [0.05, 0.02, -0.01]\n";
}

TEST(Densities, are_those_of_a_double_loop_with_every_kernel) {
  expect_densities_in_both_precisions<2, WendlandC2>(two_discs());
  expect_densities_in_both_precisions<2, Lucy>(two_discs());
  expect_densities_in_both_precisions<2, MpsWeight>(two_discs());
  expect_densities_in_both_precisions<3, WendlandC2>(two_spheres());
  expect_densities_in_both_precisions<3, Lucy>(two_spheres());
}

TEST(Densities, are_those_of_a_double_loop_with_walls_and_with_own_images) {
  const Built<2> walls(testing::channel());
  SerialEngine<2> channel(walls.model, walls.state(), Neighbours::cells);
  expect_densities_of_a_double_loop<2, Lucy, DoublePairs<2>>(walls, channel.sample());
  expect_densities_in_both_precisions<2, WendlandC2>(testing::disc_in_each_cell(1, 1));
  expect_densities_in_both_precisions<3, WendlandC2>(testing::sphere_in_each_cell(1));
}

TEST(Densities, a_sample_changes_nothing) {
  const Built<2> built(two_discs());
  SerialEngine<2> looked_at(built.model, built.state(), Neighbours::cells),
      alone(built.model, built.state(), Neighbours::cells);
  for (int step = 0; step < 20; ++step) {
    looked_at.sample();
    looked_at.step();
    alone.step();
  }
  EXPECT_EQ(digest_share(looked_at.state()), digest_share(alone.state()));
}

TEST(Densities, at_rest_are_those_of_the_state_equation) {
  const Built<2> built(head("[3.9, 4.5]", "0.3", "11.1111111111"));
  SerialEngine<2> engine(built.model, built.state(), Neighbours::cells);
  for (const double density : engine.sample().density.fluid)
    EXPECT_NEAR(density / built.model.rest_density, 1.0, 1e-12);
}

/// FPs of a solid by their index.
template <int D>
std::map<std::uint32_t, double> frozen_densities(const Sample<D>& sample, std::uint64_t solid) {
  std::map<std::uint32_t, double> densities;
  for (const FrozenPoint<D>& fp : sample.density.frozen)
    if (fp.solid == solid) densities[fp.index] = fp.density;
  return densities;
}

/// One cell, and the same repeated along each axis. Places are rounded to quanta of another size.
template <int D>
void expect_a_repeated_cell_to_be_the_same(const std::string& one, const std::string& repeated, int steps) {
  const Built<D> cell(one), many(repeated);
  State<D> start = many.state();
  testing::repeat_fluid(cell, many, Region<D>::whole_box(), start);
  SerialEngine<D> a(cell.model, cell.state(), Neighbours::cells), b(many.model, std::move(start), Neighbours::cells);
  for (int step = 0; step <= steps; ++step) {
    const auto expected = frozen_densities(a.sample(), 0);
    const Sample<D> found = b.sample();
    const std::size_t solids = found.state.solids.size();
    EXPECT_EQ(solids, D == 2 ? 4u : 8u);
    double largest = 0.0, raised = 0.0;
    for (std::uint64_t solid = 0; solid < solids; ++solid) {
      const auto densities = frozen_densities(found, solid);
      ASSERT_EQ(densities.size(), expected.size());
      for (const auto& [index, density] : expected)
        largest = std::max(largest, std::fabs(densities.at(index) - density) / cell.model.rest_density);
    }
    for (const auto& [index, density] : expected) raised = std::max(raised, density / cell.model.rest_density);
    // Roundings of 1e-15 of a length, which grow with the steps; an image that is not seen lacks some tenths.
    EXPECT_LT(largest, 1e-12 * std::pow(4.0, step)) << "step " << step;
    EXPECT_GT(raised, 0.9);
    a.step();
    b.step();
  }
}

TEST(Densities, of_a_body_beside_its_own_image_are_those_beside_another) {
  expect_a_repeated_cell_to_be_the_same<2>(testing::disc_in_each_cell(1, 1), testing::disc_in_each_cell(2, 2), 5);
  expect_a_repeated_cell_to_be_the_same<3>(testing::sphere_in_each_cell(1), testing::sphere_in_each_cell(2), 2);
}

}  // namespace
}  // namespace mappm
