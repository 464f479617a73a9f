// Limited walls: which sets of walls can be, what they take of the lattice, and their FPs.
#include "scene/walls.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "particles/frozen.hpp"
#include "physics/stability.hpp"
#include "scene/lattice.hpp"
#include "unit/scene/scene_setup.hpp"

namespace mappm::test {
namespace {

/// Lid and bottom along x, and a side between them; spacing 1/24, numbers rounded as a user would.
const std::string cavity = R"(
name = "cavity"
units = "dimensionless"
[box]
size = [1.1666666667, 1.3333333333]
[fluid]
density = 1.0
viscosity = 0.02
spacing = 0.0416666667
rcut = 0.125
sound_speed = 1.0
[[body]]
shape = "wall"
axis = "y"
position = 1.0
thickness = 0.1666666667
motion = "moving"
velocity = [0.1, 0.0]
[[body]]
shape = "wall"
axis = "y"
position = 1.1666666667
thickness = 0.1666666667
[[body]]
shape = "wall"
axis = "x"
position = 1.0
thickness = 0.1666666667
extent = { axis = "y", from = 0.0, to = 1.0 }
[run]
steps = 10
)";

/// A closed room: bottom and lid over all, two sides between them, two between all four; spacing 1/12, 12 x 12 x 14
/// nodes of fluid.
const std::string room = R"(
name = "room"
units = "dimensionless"
[box]
size = [1.3333333333, 1.3333333333, 1.5]
[fluid]
density = 1.0
viscosity = 0.02
spacing = 0.0833333333
rcut = 0.25
sound_speed = 1.0
[[body]]
shape = "wall"
axis = "z"
position = 1.1666666667
thickness = 0.3333333333
[[body]]
shape = "wall"
axis = "x"
position = 1.0
thickness = 0.3333333333
extent = { axis = "z", from = 0.0, to = 1.1666666667 }
[[body]]
shape = "wall"
axis = "y"
position = 1.0
thickness = 0.3333333333
extent = [{ axis = "z", from = 0.0, to = 1.1666666667 }, { axis = "x", from = 0.0, to = 1.0 }]
[run]
steps = 10
)";

Model<2> model_of(const Overrides& overrides = {}) { return make_model<2>(read(cavity, overrides)).model; }

TEST(SceneWalls, ACavityKeepsItsOwnNodes) {
  const Scene scene = read(cavity);
  const State<2> state = build_state(scene, make_model<2>(scene).model, Region<2>::whole_box());
  ASSERT_EQ(state.fluid.size(), 576u);  // 24 x 24 of 28 x 32
  for (std::size_t i = 0; i < 576; ++i) {
    EXPECT_LT(state.fluid.x(0)[i], 24.0 / 28.0 * box_quanta);
    EXPECT_LT(state.fluid.x(1)[i], 24.0 / 32.0 * box_quanta);
  }
}

template <int D>
std::vector<FrozenInStep<D>> frozen_of(const Model<D>& model, const State<D>& state) {
  std::vector<FrozenInStep<D>> frozen;
  Region<D> everywhere = Region<D>::whole_box();
  for (int axis = 0; axis < D; ++axis) {
    everywhere.low[axis] = -box_quanta;
    everywhere.high[axis] = 2.0 * box_quanta;
  }
  for (std::uint32_t k = 0; k < state.solids.size(); ++k)
    place_frozen(model, solid_in_step(model, state.solids[k]), k, everywhere, frozen);
  return frozen;
}

TEST(SceneWalls, ACornerShortensTheStep) {
  // nu / (c h) = 0.02 / 0.0625 = 0.32, rcut 3 dx. Without the side no PP feels two walls.
  const KernelKind kernel = KernelKind::wendland_c2;
  const double reach = 0.125 / 0.0416666667;
  const auto step = [&](int walls) {
    return 0.8 * 0.0625 * first_instability<2>(kernel, reach, wall_friction<2>(kernel, reach, 4.0, walls) * 0.32, 0.3);
  };
  const std::string flat = cavity.substr(0, cavity.rfind("[[body]]")) + "[run]\nsteps = 10\n";
  EXPECT_NEAR(make_model<2>(read(cavity)).limits.waves.usual, step(2), 1e-12);
  EXPECT_NEAR(make_model<2>(read(flat)).limits.waves.usual, step(1), 1e-12);
  EXPECT_LT(step(2), 0.8 * step(1));
}

/// The lowest and the highest density of all FPs, of that of the fluid at rest; no two FPs are at one place.
template <int D>
std::pair<double, double> densities_of_frozen(const Model<D>& model, const State<D>& state,
                                              const std::vector<FrozenInStep<D>>& frozen) {
  double lowest = HUGE_VAL, highest = 0.0;
  for (const FrozenInStep<D>& fp : frozen) {
    double density = fp.own_density;
    const auto add = [&](const Vec<D, double>& x) {
      Vec<D, double> d;
      for (int axis = 0; axis < D; ++axis) {
        const double difference = std::fmod(fp.place.x[axis] - x[axis], box_quanta);
        d[axis] = nearest_difference(wrap_position(difference), 0.0);
      }
      const Vec<D, double> r = separation(model.pair, d);
      density += static_cast<double>(pair_density<WendlandC2>(model.pair, cut_distance(dot(r, r)))) * density_quantum;
      return std::sqrt(dot(r, r));
    };
    for (const FrozenInStep<D>& other : frozen) {
      if (state.solids[other.solid].group == state.solids[fp.solid].group) continue;
      EXPECT_GT(add(other.place.x), 0.999 * model.spacing);
    }
    for (std::size_t i = 0; i < state.fluid.size(); ++i) {
      Vec<D, double> x;
      for (int axis = 0; axis < D; ++axis) x[axis] = state.fluid.x(axis)[i];
      add(x);
    }
    lowest = std::min(lowest, density / model.rest_density);
    highest = std::max(highest, density / model.rest_density);
  }
  return {lowest, highest};
}

TEST(SceneWalls, TheFrozenParticlesFillTheWallsOnceAndHaveTheDensityOfTheFluid) {
  const Scene scene = read(cavity);
  const Model<2> model = make_model<2>(scene).model;
  const State<2> state = build_state(scene, model, Region<2>::whole_box());
  const std::vector<FrozenInStep<2>> frozen = frozen_of(model, state);
  ASSERT_EQ(frozen.size(), 28u * 32u - 576u);
  const auto [lowest, highest] = densities_of_frozen(model, state, frozen);
  std::printf("[ MEASURED ] density of the FPs of a cavity: %.4f to %.4f of rest\n", lowest, highest);
  // Sums over a lattice stand for integrals over the halves that the FP's own wall does not fill: 1 % a surface, and
  // two surfaces meet in a corner. An end counted twice, or not at all, would show with a quarter or more.
  EXPECT_GT(lowest, 0.97);
  EXPECT_LT(highest, 1.03);
}

TEST(SceneWalls, WallsLimitedAlongTwoAxesCloseARoom) {
  const Scene scene = read(room);
  const Model<3> model = make_model<3>(scene).model;
  const State<3> state = build_state(scene, model, Region<3>::whole_box());
  ASSERT_EQ(state.fluid.size(), 12u * 12u * 14u);
  const std::vector<FrozenInStep<3>> frozen = frozen_of(model, state);
  ASSERT_EQ(frozen.size(), 16u * 16u * 18u - 12u * 12u * 14u);
  const auto [lowest, highest] = densities_of_frozen(model, state, frozen);
  std::printf("[ MEASURED ] density of the FPs of a room: %.4f to %.4f of rest\n", lowest, highest);
  // As in the plane, and three surfaces meet in a corner.
  EXPECT_GT(lowest, 0.955);
  EXPECT_LT(highest, 1.045);
}

TEST(SceneWalls, ARoomWithAHoleIsRefused) {
  EXPECT_EQ(input_error([] { make_model<3>(read(room)); }), "");
  const auto model_of_room = [](const Overrides& overrides) { make_model<3>(read(room, overrides)); };
  expect_input_error([&] { model_of_room({"body.2.extent.1.to=0.9166666667"}); },
                     {"body.2.extent.1.to", "open to the fluid"});
  expect_input_error([&] { model_of_room({"body.2.extent.0.from=0.0833333333"}); },
                     {"body.2.extent.0.from", "open to the fluid"});
  expect_input_error([&] { model_of_room({"body.1.extent.to=1.0833333333"}); },
                     {"body.1.extent.to", "open to the fluid"});
  expect_input_error([&] { model_of_room({"body.2.extent.1.axis=z"}); }, {"body.2.extent.1.axis", "twice"});
  expect_input_error([&] { model_of_room({"body.2.extent=3"}); }, {"body.2.extent", "table"});
  expect_input_error(
      [&] {
        model_of_room({"body.2.motion=moving", "body.2.velocity=[0.1, 0.0, 0.0]"});
      },
      {"body.2.velocity", "along its extent"});
}

TEST(SceneWalls, TouchingWithinRoundingIsNoOverlap) {
  EXPECT_EQ(input_error([] { model_of(); }), "");
  EXPECT_EQ(input_error([] { model_of({"body.2.extent.to=1.00000003"}); }), "");
  expect_input_error([] { model_of({"body.2.extent.to=1.0416666667"}); },
                     {"body.2.position", "overlaps the wall body.0"});
}

TEST(SceneWalls, AnOpenEndIsRefused) {
  expect_input_error([] { model_of({"body.2.extent.to=0.9166666667"}); },
                     {"body.2.extent.to = 0.91666", "open to the"});
  expect_input_error([] { model_of({"body.2.extent.from=0.0833333333"}); },
                     {"body.2.extent.from", "open to the fluid"});
  // A lid that covers half of the side's end.
  expect_input_error(
      [] {
        model_of({"body.0.velocity=[0.0, 0.0]", "body.0.extent={axis=\"x\", from=0.0, to=1.0833333333}"});
      },
      {"body.0.extent", "open to the fluid"});
}

TEST(SceneWalls, WhatCannotBeIsRefused) {
  expect_input_error([] { model_of({"body.2.extent={axis=\"x\", from=0.0, to=1.0}"}); },
                     {"body.2.extent.axis", "the wall's normal"});
  expect_input_error([] { model_of({"body.2.extent.from=1.0"}); }, {"body.2.extent.from", "less than to = 1"});
  expect_input_error([] { model_of({"body.2.extent.to=1.5"}); }, {"body.2.extent.to", "outside the box"});
  expect_input_error(
      [] {
        model_of({"body.2.motion=moving", "body.2.velocity=[0.0, 0.1]"});
      },
      {"body.2.velocity", "along its extent"});
  expect_input_error([] { model_of({"body.1.thickness=0.15"}); }, {"body.1", "whole multiples", "body.2.extent"});
  const std::string disc = "[[body]]\nshape = \"disc\"\nradius = 0.2\ndensity = 2.0\nposition = [0.5, 0.5]\n";
  expect_input_error(
      [&] {
        make_model<2>(read(cavity + disc, {"contact.model=linear", "contact.stiffness=1.0"}));
      },
      {"body.2.extent", "remove extent or [contact]"});
  EXPECT_EQ(input_error([&] { make_model<2>(read(cavity + disc)); }), "");
}

TEST(SceneWalls, AnExtentOverTheWholeBoxIsNone) {
  EXPECT_TRUE(read(cavity, {"body.2.extent.to=1.3333333333"}).bodies[2].extents.empty());
}

TEST(SceneWalls, DistanceToALimitedWall) {
  const Scene scene = read(cavity);
  const BodyScene& side = scene.bodies[2];
  EXPECT_NEAR(distance_to_wall(scene, side, {0.9, 0.5, 0.0}), 0.1, 1e-12);
  EXPECT_NEAR(distance_to_wall(scene, side, {0.1, 0.5, 0.0}), 0.1, 1e-9);  // the other face, across the border
  EXPECT_NEAR(distance_to_wall(scene, side, {1.08, 1.1, 0.0}), 0.1, 1e-12);
  EXPECT_NEAR(distance_to_wall(scene, side, {0.97, 1.04, 0.0}), 0.05, 1e-12);
  EXPECT_NEAR(distance_to_wall(scene, side, {1.05, 0.98, 0.0}), -0.02, 1e-12);
  EXPECT_NEAR(distance_to_wall(scene, scene.bodies[0], {0.3, 0.9, 0.0}), 0.1, 1e-12);
}

TEST(SceneWalls, DistanceToAWallLimitedAlongTwoAxes) {
  const Scene scene = read(room);
  const BodyScene& side = scene.bodies[2];  // 0 < x < 1, 0 < z < 7/6, from y = 1 on
  EXPECT_NEAR(distance_to_wall(scene, side, {0.5, 0.9, 0.5}), 0.1, 1e-9);
  EXPECT_NEAR(distance_to_wall(scene, side, {1.03, 0.96, 0.5}), 0.05, 1e-9);
  EXPECT_NEAR(distance_to_wall(scene, side, {1.02, 0.97, 1.1666666667 + 0.06}), 0.07, 1e-9);
  EXPECT_NEAR(distance_to_wall(scene, side, {0.5, 1.02, 0.5}), -0.02, 1e-9);
  EXPECT_NEAR(distance_to_wall(scene, side, {0.99, 1.1, 0.5}), -0.01, 1e-9);
}

}  // namespace
}  // namespace mappm::test
