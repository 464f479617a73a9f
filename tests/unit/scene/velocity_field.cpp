// Fields of velocity and of force in a scene, and the disorder of the start.
#include "scene/velocity_field.hpp"

#include <cmath>
#include <set>

#include "unit/scene/scene_setup.hpp"

namespace mappm::test {
namespace {

constexpr double pi = 3.14159265358979323846;

const std::string cube = R"(
name = "cube"
units = "dimensionless"
[box]
size = [1.0, 1.0, 1.0]
[fluid]
density = 1.0
viscosity = 0.01
spacing = 0.0625
sound_speed = 2.0
[run]
steps = 10
)";

template <int D>
State<D> start_of(const std::string& text, const Overrides& overrides) {
  const Scene scene = read(text, overrides);
  return build_state(scene, make_model<D>(scene).model, Region<D>::whole_box());
}

TEST(SceneFields, VorticesAddToTheUniformVelocity) {
  const State<2> state =
      start_of<2>(plain_fluid, {"fluid.velocity=[0.25, 0.0]", "fluid.vortices={amplitude=0.125, mode=2}"});
  for (std::size_t i = 0; i < state.fluid.size(); ++i) {
    const double x = 4 * pi * state.fluid.x(0)[i] / box_quanta, y = 4 * pi * state.fluid.x(1)[i] / box_quanta;
    EXPECT_NEAR(state.fluid.v(0)[i], 0.25 + 0.125 * std::sin(x) * std::cos(y), 1e-14);
    EXPECT_NEAR(state.fluid.v(1)[i], -0.125 * std::cos(x) * std::sin(y), 1e-14);
    EXPECT_EQ(state.fluid.v(0)[i] / velocity_quantum, std::nearbyint(state.fluid.v(0)[i] / velocity_quantum));
  }
}

TEST(SceneFields, AbcInSpace) {
  const State<3> state = start_of<3>(cube, {"fluid.abc={amplitude=0.5}"});
  for (std::size_t i = 0; i < state.fluid.size(); ++i)
    EXPECT_NEAR(state.fluid.v(2)[i],
                0.25 * (std::sin(2 * pi * state.fluid.x(1)[i] / box_quanta) +
                        std::cos(2 * pi * state.fluid.x(0)[i] / box_quanta)),
                1e-14);  // c = 2
}

TEST(SceneFields, WhatCannotBeIsRefused) {
  const auto refuses = [](const std::string& text, const Overrides& overrides, const std::vector<std::string>& parts) {
    expect_input_error([&] { read(text, overrides); }, parts);
  };
  const std::string wave = "wave={amplitude=0.1, direction=\"x\", gradient=\"y\"}";
  for (const std::string table : {"fluid.", "force."}) {
    refuses(plain_fluid, {table + wave, table + "vortices={amplitude=0.1}"}, {table + "vortices", "wave is given too"});
    refuses(plain_fluid, {table + "abc={amplitude=0.1}"}, {table + "abc", "two sides"});
    refuses(plain_fluid, {"box.size=[1.0, 2.0]", table + "vortices={amplitude=0.1}"}, {table + "vortices", "1 and 2"});
    refuses(cube, {"box.size=[1.0, 1.0, 2.0]", table + "abc={amplitude=0.1}"}, {table + "abc", "equal sides"});
    refuses(plain_fluid, {table + "vortices={amplitude=0.1, mode=0}"}, {table + "vortices.mode", "1 to"});
    refuses(plain_fluid, {table + "vortices={amplitude=0.1, gradient=\"x\"}"},
            {table + "vortices.gradient", "unknown"});
    refuses(plain_fluid, {table + "vortices={mode=1}"}, {table + "vortices.amplitude", "missing"});
  }
  refuses(one_disc, {"force.solid=balance", "force." + wave}, {"force.solid", "uniform force only"});
  refuses(plain_fluid, {"fluid.disorder={amplitude=0.26, seed=1}"}, {"fluid.disorder.amplitude", "[0, 0.25]"});
  refuses(plain_fluid, {"fluid.disorder={amplitude=0.1}"}, {"fluid.disorder.seed", "missing"});
}

TEST(SceneFields, AForceFieldIsATermAndLimitsTheStep) {
  const auto built = [](const Overrides& overrides) { return make_model<2>(read(plain_fluid, overrides)).model; };
  EXPECT_FALSE(built({}).terms.force_field);
  EXPECT_FALSE(built({"force.vortices={amplitude=0.0}"}).terms.force_field);
  const Model<2> model = built({"force.vortices={amplitude=-30.0, mode=3}", "force.fluid=[0.0, 10.0]"});
  EXPECT_TRUE(model.terms.force_field);
  // h = 0.09375, g at most 40: 0.25 sqrt(h / g), against 0.25 h / c = 0.0234; in rcut / c, with c = 1
  const double dt = 0.25 * std::sqrt(0.09375 / 40.0);
  EXPECT_NEAR(model.dt * 0.1875, dt, 1e-15);
  EXPECT_NEAR(model.fluid_field.amplitude, -30.0 * dt, 1e-14);  // gained in a step, c
  EXPECT_EQ(model.fluid_field.mode, 3);
  expect_input_error([&] { built({"force.vortices={amplitude=1000.0}"}); }, {"force", "times the sound speed"});
}

TEST(SceneFields, AForceFieldEntersTheRuleOfTheSoundSpeed) {
  const Scene scene = read(
      plain_fluid, {"fluid.sound_speed_factor=10", "fluid.reference_velocity=0.0", "force.vortices={amplitude=4.0}"});
  EXPECT_DOUBLE_EQ(make_model<2>(scene).model.units.velocity, 20.0);  // 10 sqrt(g L), L = 1
}

TEST(SceneFields, ADeclaredFieldCountsAsSpeed) {
  expect_input_error([] { make_model<3>(read(cube, {"fluid.abc={amplitude=0.9}"})); },
                     {"fluid.sound_speed = 2", "2.20454"});  // sqrt(6) 0.9
}

TEST(SceneDisorder, DisplacesEachAxisEvenlyWithinItsBounds) {
  const State<3> ordered = start_of<3>(cube, {}), moved = start_of<3>(cube, {"fluid.disorder={amplitude=0.2, seed=3}"});
  ASSERT_EQ(moved.fluid.id, ordered.fluid.id);
  const double bound = std::floor(0.2 * box_quanta / 16);
  const auto count = static_cast<double>(moved.fluid.size());
  for (int axis = 0; axis < 3; ++axis) {
    double sum = 0.0, squares = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < moved.fluid.size(); ++i) {
      const double d = moved.fluid.x(axis)[i] - ordered.fluid.x(axis)[i];
      EXPECT_EQ(moved.fluid.x(axis)[i], std::floor(moved.fluid.x(axis)[i]));
      sum += d / bound;
      squares += d * d / (bound * bound);
      largest = std::max(largest, std::fabs(d));
    }
    // Uniform in [-1, 1]: mean 0 +- sqrt(1/3 / 4096), mean square 1/3 +- sqrt(4/45 / 4096); five deviations.
    EXPECT_NEAR(sum / count, 0.0, 5.0 * std::sqrt(1.0 / 3.0 / count));
    EXPECT_NEAR(squares / count, 1.0 / 3.0, 5.0 * std::sqrt(4.0 / 45.0 / count));
    EXPECT_LE(largest, bound);
    EXPECT_GT(largest, 0.99 * bound);
  }
}

TEST(SceneDisorder, FollowsFromTheSeed) {
  std::set<std::uint64_t> digests{digest_share(start_of<2>(plain_fluid, {}))};
  for (const char* seed : {"0", "1", "2"})
    digests.insert(
        digest_share(start_of<2>(plain_fluid, {std::string("fluid.disorder={amplitude=0.1, seed=") + seed + "}"})));
  EXPECT_EQ(digests.size(), 4u);
  EXPECT_EQ(digest_share(start_of<2>(plain_fluid, {"fluid.disorder={amplitude=0.0, seed=1}"})),
            digest_share(start_of<2>(plain_fluid, {})));
}

TEST(SceneDisorder, LeavesThoseNearASolidWhereTheyAre) {
  const Overrides disorder{"fluid.disorder={amplitude=0.25, seed=5}"};
  const State<2> ordered = start_of<2>(one_disc, {}), moved = start_of<2>(one_disc, disorder);
  ASSERT_EQ(moved.fluid.id, ordered.fluid.id);
  std::size_t held = 0, free = 0;
  for (std::size_t i = 0; i < moved.fluid.size(); ++i) {
    const double x = ordered.fluid.x(0)[i] / box_quanta * 2.0 - 1.0, y = ordered.fluid.x(1)[i] / box_quanta * 4.0 - 1.0;
    const bool near = std::sqrt(x * x + y * y) < 0.5 + 0.125;
    (near ? held : free) += 1;
    EXPECT_EQ(moved.fluid.x(0)[i] == ordered.fluid.x(0)[i], near) << x << ", " << y;
  }
  EXPECT_GT(held, 20u);
  EXPECT_GT(free, 300u);
}

}  // namespace
}  // namespace mappm::test
