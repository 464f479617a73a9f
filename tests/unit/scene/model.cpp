// The built model. Numbers of `one_disc` are worked by hand: rcut 0.5 = 4 spacings, c = 10, a lattice of 16 x 32 nodes,
// so a PP has mass 3 / 64, time is counted in rcut / c = 0.05, rho0 = 16 PPs per rcut^2.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "particles/solid_step.hpp"
#include "physics/stability.hpp"
#include "unit/scene/scene_setup.hpp"

namespace mappm::test {
namespace {

constexpr double pi = 3.14159265358979323846;

Model<2> one_disc_model(const Overrides& overrides = {}) { return make_model<2>(read(one_disc, overrides)).model; }

TEST(SceneModel, UnitsAndBox) {
  const Model<2> model = one_disc_model();
  EXPECT_EQ(model.units.length, 0.5);
  EXPECT_EQ(model.units.velocity, 10.0);
  EXPECT_EQ(model.units.mass, 3.0 / 64.0);
  EXPECT_EQ(model.box, (Vec<2, double>{{4.0, 8.0}}));
  EXPECT_EQ(model.pair.length, (Vec<2, double>{{0x1p-50, 0x1p-49}}));
  EXPECT_EQ(model.rest_density, 16.0);
  EXPECT_EQ(model.spacing, 0.25);
  EXPECT_EQ(model.no_slip_nearest, 0.0625);
}

/// c dt / h, by default h / c or 0.8 of the first instability, with the friction that a wall adds.
double wave_step(double viscosity, double largest_no_slip, double shift_rate, int walls = 1) {
  const double at_walls = wall_friction<2>(KernelKind::wendland_c2, 4.0, largest_no_slip, walls);
  return std::min(1.0, 0.8 * first_instability<2>(KernelKind::wendland_c2, 4.0, at_walls * viscosity, shift_rate));
}

TEST(SceneModel, StepIsTheSmallestLimit) {
  // nu / (c h) = 0.2 / (10 * 0.25) = 0.08; force 0.25 sqrt(h/g) = 0.088 with h = 0.25; time in units of 0.05
  const double step = one_disc_model().dt;
  EXPECT_DOUBLE_EQ(step, 0.5 * wave_step(0.08, 4.0, 0.3));
  EXPECT_DOUBLE_EQ(one_disc_model({"run.step_factor=0.5"}).dt, 0.5 * step);
  EXPECT_DOUBLE_EQ(one_disc_model({"fluid.viscosity=60.0"}).dt, 0.5 * wave_step(8.0, 4.0, 0.3));
  EXPECT_DOUBLE_EQ(one_disc_model({"fluid.viscosity=0.0"}).dt, 0.5);         // h / c
  EXPECT_DOUBLE_EQ(one_disc_model({"force.fluid=[0.0, 2500.0]"}).dt, 0.05);  // 0.25 sqrt(1e-4)
}

TEST(SceneModel, StepFollowsTheShiftAndTheWalls) {
  const Overrides viscous{"fluid.viscosity=1.5"};  // nu / (c h) = 0.2
  const auto with = [&](const std::string& more) { return one_disc_model({"fluid.viscosity=1.5", more}).dt; };
  EXPECT_DOUBLE_EQ(with("fluid.shift_rate=1.0"), 0.5 * wave_step(0.2, 4.0, 1.0));
  EXPECT_DOUBLE_EQ(with("fluid.largest_no_slip=8.0"), 0.5 * wave_step(0.2, 8.0, 0.3));
  EXPECT_DOUBLE_EQ(with("fluid.transport=false"), 0.5 * wave_step(0.2, 4.0, 0.0));
  EXPECT_DOUBLE_EQ(with("fluid.method=classic"), 0.5 * wave_step(0.2, 1.0, 0.0));
  EXPECT_LT(with("fluid.largest_no_slip=8.0"), one_disc_model(viscous).dt);
}

TEST(SceneModel, ALightSolidLimitsTheStep) {
  // As heavy as 1/200 of the fluid: M = 0.005 * 16 pi, A = 2 pi; Gamma / A = 3.1 * 0.64 / 0.5 + 0.083 * 16. It turns,
  // with I = M / 2, sooner than it is thrown: 2 I / (A 3.968).
  const BuiltModel<2> light = make_model<2>(read(one_disc, {"body.0.density=0.015"}));
  const double last = 0.04 / 3.968, unturned = 2.0 * 0.04 / (3.968 + 1.328);
  EXPECT_EQ(light.limits.ruling().of, "added mass");
  EXPECT_NEAR(light.model.dt, 0.7 * last, 1e-14);
  EXPECT_NEAR(light.limits.light_solids.last, 0.05 * last, 1e-14) << "in units of the scene";
  EXPECT_LT(last, unturned);
  const BuiltModel<2> held =
      make_model<2>(read(one_disc, {"body.0.density=0.015", "body.0.motion=moving", "body.0.angular_velocity=0.0"}));
  EXPECT_EQ(held.limits.light_solids.last, HUGE_VAL) << "what is held cannot be thrown";
}

/// sum G q^4 r^2 over sum G r^2, on a square lattice of 4 spacings to the cutoff.
double outer_moment() {
  double outer = 0.0, all = 0.0;
  for (int j = -4; j <= 4; ++j)
    for (int i = -4; i <= 4; ++i) {
      const double square = 0.0625 * (i * i + j * j);
      if (square >= 1.0 || square == 0.0) continue;
      all += square * WendlandC2::gradient(std::sqrt(square));
      outer += square * square * square * WendlandC2::gradient(std::sqrt(square));
    }
  return outer / all;
}

TEST(SceneModel, PairLawConstants) {
  const Model<2> model = one_disc_model();
  // mu = nu rho0 with nu = 0.2 / (0.5 * 10)
  EXPECT_DOUBLE_EQ(model.pair.viscosity, 0.04 * 16.0);
  // kappa h / (2 V_0) iota / length = 0.3 * 0.5 * 8 * 2^-48 * 2^50
  EXPECT_DOUBLE_EQ(model.pair.shift[0], 4.8);
  EXPECT_DOUBLE_EQ(model.pair.shift[1], 2.4);
  EXPECT_DOUBLE_EQ(one_disc_model({"fluid.shift_rate=0.25"}).pair.shift[0], 4.0);
  // (a h)^2 iota / (2 V_0 dt D m) = 80^2 * 8 * 2^-48 / (2 m dt): nu / (c h) is 0.08
  EXPECT_DOUBLE_EQ(model.shift_shear * model.dt, 6400.0 * 8.0 * 0x1p-48 / (2.0 * outer_moment()));
  EXPECT_DOUBLE_EQ(one_disc_model({"fluid.shift_shear=80"}).shift_shear, 0.25 * model.shift_shear);
  EXPECT_DOUBLE_EQ(model.shift_outer, 1.0 / outer_moment());
  EXPECT_EQ(model.no_slip_largest, 4.0);
  EXPECT_EQ(one_disc_model({"fluid.largest_no_slip=2.5"}).no_slip_largest, 2.5);
  EXPECT_EQ(model.background, 0.0);
  EXPECT_DOUBLE_EQ(one_disc_model({"fluid.background_pressure=0.25"}).background, 4.0);
}

/// Sums over the lattice with the folded constants: sum W = rho0, (1/D) sum V r^2 G = 1.
TEST(SceneModel, KernelSumsAreExactOnTheLattice) {
  const Model<2> model = one_disc_model();
  double weight = model.self_density;
  double moment = 0.0;
  for (int j = -4; j <= 4; ++j)
    for (int i = -4; i <= 4; ++i) {
      const double q = std::sqrt(0.0625 * (i * i + j * j));
      if (q >= 1.0 || (i == 0 && j == 0)) continue;
      weight += WendlandC2::weight(q) * model.pair.weight * density_quantum;
      moment += q * q * WendlandC2::gradient(q) * model.pair.force * velocity_quantum / model.dt;
    }
  EXPECT_NEAR(weight, 16.0, 1e-12);  // rounding of 49 terms
  EXPECT_NEAR(0.5 * moment / 16.0, 1.0, 1e-13);
  EXPECT_EQ(model.self_density, std::nearbyint(model.self_density / density_quantum) * density_quantum);
}

/// S^2 of one PP of a lattice that moves with v(r), from the constants of the model, (c / rcut)^2, with a = 45. S_0^2
/// is the same: velocities differ in proportion to the distance.
template <int D, class Velocity>
double shear_on_lattice(const Model<D>& model, Velocity&& velocity) {
  double sum = 0.0, of_all = 0.0;
  const double v0 = 1.0 / model.rest_density;
  const int most = static_cast<int>(1.0 / model.spacing) + 1, layers = D == 3 ? most : 0;
  for (int k = -layers; k <= layers; ++k)
    for (int j = -most; j <= most; ++j)
      for (int i = -most; i <= most; ++i) {
        if (i == 0 && j == 0 && k == 0) continue;
        const int node[3] = {i, j, k};
        FluidPair<D, double> pair;
        for (int axis = 0; axis < D; ++axis)
          pair.d[axis] = std::nearbyint(node[axis] * model.spacing / model.pair.length[axis]);
        const Vec<D, double> r = separation(model.pair, pair.d);
        pair.v = velocity(r);
        pair.v2 = 2.0 * v0 * v0;
        pair.pv2 = 0.0;
        const auto given = fluid_pair<WendlandC2, true>(model.pair, pair, r, cut_distance(dot(r, r)), 1.0);
        sum += static_cast<double>(given.shear);
        of_all += static_cast<double>(given.agitation);
      }
  EXPECT_NEAR(sum * particle_step(model, 0).outer / of_all, 1.0, 1e-7);
  constexpr double a = 45.0, h = 0.5;
  return particle_step(model, 0).shear / (a * h * a * h) * sum;
}

// D S^2 is the sum of the squares of the gradients, whether the fluid turns, is sheared or strained. Roundings: some
// fifty of a quantum of iota / (2 V_0 D m dt) < 1e-12 each way, and of the terms.
TEST(SceneModel, ShearIsThatOfTurningAndStrain) {
  const Model<2> plane = make_model<2>(read(plain_fluid, {"fluid.shift_shear=45"})).model;
  using Plane = Vec<2, double>;
  EXPECT_NEAR(shear_on_lattice<2>(plane,
                                  [](const Plane& r) {
                                    return Plane{{-0.03 * r[1], 0.03 * r[0]}};
                                  }),
              9e-4, 1e-11);
  EXPECT_NEAR(shear_on_lattice<2>(plane,
                                  [](const Plane& r) {
                                    return Plane{{0.03 * r[0], -0.03 * r[1]}};
                                  }),
              9e-4, 1e-11);
  EXPECT_NEAR(shear_on_lattice<2>(plane, [](const Plane& r) { return Plane{{0.03 * r[1], 0.0}}; }), 4.5e-4, 1e-11);
  const Model<3> space = make_model<3>(read(plain_fluid, {"box.size=[1.0, 1.0, 1.0]", "fluid.shift_shear=45"})).model;
  using Space = Vec<3, double>;
  EXPECT_NEAR(shear_on_lattice<3>(space, [](const Space& r) { return Space{{0.0, 0.0, 0.03 * r[1]}}; }), 3e-4, 1e-11);
}

TEST(SceneModel, ForcesAreQuantised) {
  const Model<2> model = one_disc_model();
  // g L / c^2 = 0.01; times dt, to the nearest 2^-48
  EXPECT_EQ(model.fluid_kick[0], 0.0);
  EXPECT_NEAR(model.fluid_kick[1], 0.01 * model.dt, 0x1p-49);
  EXPECT_EQ(model.fluid_kick[1] / velocity_quantum, std::nearbyint(model.fluid_kick[1] / velocity_quantum));
  EXPECT_EQ(model.solid_acceleration, (Vec<2, double>{}));
  EXPECT_DOUBLE_EQ(one_disc_model({"force.solid=[4.0, 0.0]"}).solid_acceleration[0], 0.02);
}

TEST(SceneModel, BalanceOpposesTheForceOnTheFluid) {
  const BuiltModel<2> built = make_model<2>(read(one_disc, {"force.solid=balance"}));
  const Model<2>& model = built.model;
  const double on_fluid = static_cast<double>(built.fluid_particles) * model.fluid_kick[1];
  EXPECT_NEAR(model.solid_acceleration[1] * model.shapes[0].mass * model.dt, -on_fluid, 1e-15 * on_fluid);
  expect_input_error(
      [] {
        make_model<2>(read(plain_fluid, {"force.fluid=[1.0, 0.0]", "force.solid=balance"}));
      },
      {"force.solid = \"balance\"", "free solid"});
}

TEST(SceneModel, ShapesInInternalUnits) {
  const Model<2> model = one_disc_model();
  ASSERT_EQ(model.shapes.size(), 1u);
  EXPECT_DOUBLE_EQ(model.shapes[0].volume, pi);       // R = rcut
  EXPECT_DOUBLE_EQ(model.shapes[0].mass, 32.0 * pi);  // twice the fluid's density
  EXPECT_EQ(model.largest_reach, 1.0);
  EXPECT_EQ(model.largest_contact_reach, 0.0);  // no contact declared
}

TEST(SceneModel, CountsThePseudoParticles) {
  // 512 nodes, less pi 0.25 / (1/64) = 50.27
  EXPECT_EQ(make_model<2>(read(one_disc)).fluid_particles, 462u);
  EXPECT_EQ(make_model<2>(read(plain_fluid)).fluid_particles, 256u);
}

TEST(SceneModel, SoundSpeedRule) {
  const auto speed = [](const Overrides& more) {
    Overrides overrides{"fluid.sound_speed_factor=10"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return make_model<2>(read(one_disc, overrides)).model.units.velocity;
  };
  // nu = 0.2, R = 0.5, L = 2R = 1, g = 2
  EXPECT_DOUBLE_EQ(speed({"fluid.reference_velocity=3.0"}), 30.0);                   // U
  EXPECT_DOUBLE_EQ(speed({"fluid.reference_velocity=0.1"}), 10.0 * std::sqrt(2.0));  // g L
  EXPECT_DOUBLE_EQ(speed({"fluid.reference_velocity=6.0", "fluid.viscosity=60.0"}),
                   10.0 * std::sqrt(960.0));  // 4 nu U / R
  expect_input_error(
      [] {
        make_model<2>(read(plain_fluid, {"fluid.sound_speed_factor=10", "fluid.reference_velocity=0"}));
      },
      {"fluid.reference_velocity = 0", "largest speed expected"});
}

TEST(SceneModel, TermsFollowFromTheScene) {
  const Terms plain = make_model<2>(read(plain_fluid)).model.terms;
  EXPECT_TRUE(plain.fluid && plain.transport);
  EXPECT_FALSE(plain.extrapolated || plain.body_force || plain.solids || plain.motion || plain.rotation ||
               plain.contact);
  const Terms disc = one_disc_model().terms;
  EXPECT_TRUE(disc.extrapolated && disc.body_force && disc.solids && disc.motion && disc.rotation);
  EXPECT_FALSE(disc.contact);
  const Overrides linear{"contact.model=linear", "contact.stiffness=1e6"};
  EXPECT_FALSE(one_disc_model(linear).terms.contact) << "one disc has nothing to touch";
  Overrides two = linear;
  two.push_back("body.0.position=[1.0, 1.0]");
  const std::string second = "[[body]]\nshape = \"disc\"\nradius = 0.4\ndensity = 6.0\nposition = [1.0, 3.0]\n";
  const Model<2> model = make_model<2>(read(one_disc + second, two)).model;
  EXPECT_TRUE(model.terms.contact);
  EXPECT_EQ(model.largest_contact_reach, 1.0);
  // k / (m c^2 / rcut^2) = 1e6 / (3/64 * 400)
  EXPECT_DOUBLE_EQ(model.contact.stiffness, 1e6 / 18.75);
}

TEST(SceneModel, ContactLimitsTheStep) {
  const std::string second = "[[body]]\nshape = \"disc\"\nradius = 0.5\ndensity = 6.0\nposition = [1.0, 3.0]\n";
  const Model<2> model =
      make_model<2>(read(one_disc + second, {"contact.model=linear", "contact.stiffness=1e6"})).model;
  // 0.05 pi sqrt(m / 2 / k), m = 6 pi / 4, in units of 0.05
  EXPECT_NEAR(model.dt, pi * std::sqrt(0.75 * pi / 1e6), 1e-12);
}

TEST(SceneModel, StepBeyondItsLimitWarnsAndThenFails) {
  const StepLimits limits = make_model<2>(read(one_disc)).limits;
  const StepLimit waves = limits.waves;
  EXPECT_NEAR(waves.doubtful / waves.last, 0.8, 1e-12);
  const auto step = [](double seconds) { return fmt::format("run.step={:.6g}", seconds); };
  EXPECT_TRUE(make_model<2>(read(one_disc, {step(0.99 * waves.doubtful)})).warnings.empty());
  const double near = 0.5 * (waves.doubtful + waves.last);
  const std::vector<std::string> warnings = make_model<2>(read(one_disc, {step(near)})).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  const std::string expected = fmt::format(
      "run.step = {0:.6g}: the step {0:.6g} is near {1:.6g}, the last that {2} allows: results may be wrong without "
      "any "
      "sign; lower it to {3:.6g} or less",
      near, waves.last, waves.of, waves.doubtful);
  EXPECT_EQ(warnings[0], expected);
  expect_input_error(
      [&] { make_model<2>(read(one_disc, {step(1.01 * waves.last)})); },
      {"scene.toml", "run.step = ", fmt::format("longer than {:.6g}, the last that {} allows", waves.last, waves.of),
       fmt::format("lower it to {:.6g} or less", waves.doubtful)});
  expect_input_error([] { make_model<2>(read(one_disc, {"run.step_factor=2.5"})); },
                     {"run.step_factor = 2.5", "lower it to 1"});
}

TEST(SceneModel, RefusesWhatCannotRun) {
  const auto built = [](const Overrides& overrides) { return [=] { make_model<2>(read(one_disc, overrides)); }; };
  expect_input_error(built({"fluid.rcut=1.0"}), {"box.size = 2", "longer than 2 rcut = 2"});
  expect_input_error(built({"fluid.rcut=0.1"}), {"fluid.rcut = 0.1", "exceed fluid.spacing = 0.125"});
  expect_input_error(built({"fluid.spacing=0.01"}), {"fluid.rcut = 0.5", "more than 256"});
  expect_input_error(built({"body.0.radius=1.1"}), {"body.0", "2.2 wide", "box side 2"});
  expect_input_error(built({"body.0.radius=1e20"}), {"body.0", "2e+20 wide", "box side 2"});
  expect_input_error(built({"body.0.density=1e20"}), {"body.0.density = 1e+20", "PPs", "lower it"});
  expect_input_error(built({"fluid.spacing=1e-20", "fluid.rcut=3e-20"}), {"fluid.spacing = 1e-20", "can be numbered"});
  expect_input_error(built({"fluid.sound_speed=0.4"}),
                     {"fluid.sound_speed = 0.4", "speed 2"});  // with the rim: 0.5 + 3 x 0.5
  expect_input_error(
      [] {
        make_model<2>(read(one_disc + "[[body]]\nshape = \"disc\"\nradius = 0.5\ndensity = 6.0\n"
                                      "position = [1.5, 1.0]\n"));
      },
      {"body.1", "overlaps", "body.0"});
  const std::string wall =
      plain_fluid + "[[body]]\nshape = \"wall\"\naxis = \"y\"\nposition = 0.5\nthickness = 0.125\n";
  expect_input_error([&] { make_model<2>(read(wall)); }, {"body.0.thickness = 0.125", "thicker"});
}

TEST(SceneModel, RefusesABackgroundPressureWhoseImpulsesLeaveTheRange) {
  // One pair gets 2 p_b V^2 G r dt: proportional to p_b and to the step. On the lattice 4 spacings to rcut, G is
  // normalised by (1/D) sum V r^2 G = 1, and the step is that of the scene.
  const Model<2> model = one_disc_model({"fluid.background_pressure=1.0"});
  double gradient = 0.0, sum = 0.0;
  for (double q = 0.0; q < 1.0; q += 1e-4) gradient = std::max(gradient, q * WendlandC2::gradient(q));
  for (int j = -4; j <= 4; ++j)
    for (int i = -4; i <= 4; ++i)
      if (const double square = (i * i + j * j) / 16.0; square > 0.0 && square < 1.0)
        sum += square * WendlandC2::gradient(std::sqrt(square)) / 16.0;
  const double of_one = 2.0 / 16.0 * gradient * (2.0 / sum) * model.dt;  // p_b V^2 = c^2 rho_0 / rho_0^2 for p_b = 1
  const auto with = [](double pressure) {
    return one_disc_model({"fluid.background_pressure=" + std::to_string(pressure)});
  };
  EXPECT_NO_THROW(with(0.99 / of_one));
  EXPECT_THROW(with(1.01 / of_one), InputError);
}

TEST(SceneModel, WarnsOutsideTheMappedRegion) {
  const auto warning = [](const Overrides& overrides) {
    std::string all;
    for (const std::string& line : make_model<2>(read(one_disc, overrides)).warnings) all += line + "\n";
    return all;
  };
  EXPECT_EQ(warning({}), "");
  EXPECT_NE(warning({"fluid.sound_speed=20.0", "fluid.reference_velocity=3"}).find("fluid.sound_speed"),
            std::string::npos);
  EXPECT_NE(warning({"fluid.rcut=0.25"}).find("fluid.rcut: 2 spacings"), std::string::npos);
  EXPECT_NE(warning({"body.0.radius=0.4"}).find("body.0.radius: 3.2 spacings"), std::string::npos);
  EXPECT_NE(warning({"fluid.background_pressure=1.0"}).find("fluid.background_pressure = 1"), std::string::npos);
}

/// A composite above a wall, solids alone.
const std::string dry_composite = R"(
name = "dry"
units = "dimensionless"
[box]
size = [4.0, 4.0, 4.0]
[fluid]
particles = false
density = 1.0
spacing = 0.5
rcut = 1.5
sound_speed = 100.0
[[body]]
shape = "wall"
position = 0.0
thickness = 0.5
[[body]]
shape = "composite"
balls = [{centre = [0.0, 0.0, 0.0], radius = 0.5}, {centre = [0.5, 0.0, 0.0], radius = 0.5}]
density = 2.0
position = [2.0, 2.0, 2.0]
velocity = [1.0, 0.0, 0.0]
[contact]
model = "linear"
stiffness = 1000.0
[run]
step = 0.001
steps = 10
)";

TEST(SceneModel, WithoutFluidSpacingAndSoundSpeedOnlySetUnits) {
  const double volume = 0.883572933822129;  // of two balls of radius and distance 1/2: 9 pi / 32
  for (const Overrides& overrides : std::vector<Overrides>{{},
                                                           {"fluid.spacing=0.001", "fluid.rcut=0.003"},
                                                           {"fluid.spacing=1e-5"},  // 0.4 million nodes a side
                                                           {"fluid.spacing=0.0851", "fluid.rcut=0.2553"},  // 47 nodes
                                                           {"fluid.spacing=0.02", "fluid.rcut=1.5"},
                                                           {"fluid.spacing=0.5", "fluid.rcut=0.3"},
                                                           {"fluid.sound_speed=0.5"}}) {
    const Scene scene = read(dry_composite, overrides);
    const Model<3> model = make_model<3>(scene).model;
    const std::string& what = overrides.empty() ? "as it is" : overrides[0];
    EXPECT_NEAR(model.shapes[1].mass * model.units.mass, 2.0 * volume, 1e-8) << what;
    EXPECT_NEAR(model.dt * model.units.time(), 0.001, 1e-15) << what;
    EXPECT_EQ(build_state(scene, model, Region<3>::whole_box()).solids.size(), 1u) << what;
    EXPECT_EQ(model.faces.size(), 2u) << what;
  }
}

TEST(SceneModel, ASceneWithoutParticlesHasNoFrozenOnesEither) {
  const std::string text = R"(
name = "two spheres"
units = "dimensionless"
[box]
size = [10.0, 10.0, 10.0]
[fluid]
particles = false
density = 1.0
spacing = 0.3333333333333333
sound_speed = 100.0
[[body]]
shape = "sphere"
radius = 1.0
density = 1.0
positions = [[3.0, 5.0, 5.0], [6.0, 5.0, 5.0]]
[contact]
model = "hertz"
young = 1e6
poisson = 0.25
[run]
steps = 10
)";
  const Scene scene = read(text);
  const BuiltModel<3> built = make_model<3>(scene);
  EXPECT_FALSE(built.model.terms.fluid || built.model.terms.transport || built.model.terms.extrapolated);
  EXPECT_TRUE(built.model.terms.contact);
  EXPECT_TRUE(built.model.shapes[0].frozen.empty());
  EXPECT_EQ(built.fluid_particles, 0u);
  EXPECT_TRUE(built.warnings.empty());
  const State<3> state = build_state(scene, built.model, Region<3>::whole_box());
  EXPECT_EQ(state.fluid.size(), 0u);
  EXPECT_EQ(state.solids.size(), 2u);
  // E / (m c^2 / rcut^3) with m / rcut^3 = density / 27 for rcut = 3 spacings
  EXPECT_NEAR(built.model.contact.young, 1e6 * 27.0 / 1e4, 1e-8);
  expect_input_error(
      [&] {
        make_model<3>(read(text, {"contact.model=none", "contact={model=\"none\"}"}));
      },
      {"run.step", "nothing in this scene limits the step"});
}

}  // namespace
}  // namespace mappm::test
