// The typed reader: what it makes of good scenes, and its error for each kind of bad input.
#include "unit/scene/scene_setup.hpp"

namespace mappm::test {
namespace {

TEST(SceneReader, FillsDefaults) {
  const Scene scene = read(plain_fluid);
  EXPECT_EQ(scene.file, "scene.toml");
  EXPECT_EQ(scene.dimension, 2);
  EXPECT_EQ(scene.units, Units::dimensionless);
  EXPECT_EQ(scene.fluid.cutoff, 3.0 * 0.0625);
  EXPECT_EQ(scene.fluid.method, Method::transport);
  EXPECT_TRUE(scene.fluid.transport);
  EXPECT_EQ(scene.fluid.no_slip, NoSlip::extrapolated);
  EXPECT_EQ(scene.fluid.kernel, KernelKind::wendland_c2);
  EXPECT_EQ(scene.fluid.shift_rate, 0.3);
  EXPECT_FALSE(scene.fluid.shift_shear) << "it follows the viscosity";
  EXPECT_EQ(scene.fluid.largest_no_slip, 4.0);
  EXPECT_EQ(scene.fluid.precision, Precision::full);
  EXPECT_EQ(scene.run.step_factor, 1.0);
  EXPECT_EQ(scene.output.sample, 100u);
}

TEST(SceneReader, ClassicMethodTurnsItsTermsOffAndSingleTermsCanBeChosen) {
  const Scene classic = read(plain_fluid, {"fluid.method=classic"});
  EXPECT_FALSE(classic.fluid.transport);
  EXPECT_EQ(classic.fluid.no_slip, NoSlip::plain);
  EXPECT_EQ(classic.fluid.largest_no_slip, 1.0);
  const Scene mixed = read(plain_fluid, {"fluid.method=classic", "fluid.no_slip=extrapolated", "fluid.kernel=lucy"});
  EXPECT_FALSE(mixed.fluid.transport);
  EXPECT_EQ(mixed.fluid.no_slip, NoSlip::extrapolated);
  EXPECT_EQ(mixed.fluid.kernel, KernelKind::lucy);
}

TEST(SceneReader, DefaultsInSpaceAreOthersThanInThePlane) {
  const Overrides in_space{"box.size=[1.0, 1.0, 1.0]"};
  EXPECT_EQ(read(plain_fluid, in_space).fluid.largest_no_slip, 8.0);
  const std::string by_rule =
      std::string(plain_fluid).replace(plain_fluid.find("sound_speed = 1.0"), 17, "reference_velocity = 0.1");
  EXPECT_EQ(read(by_rule).fluid.sound_speed.factor, 10.0);
  EXPECT_EQ(read(by_rule, in_space).fluid.sound_speed.factor, 15.0);
  EXPECT_EQ(read(by_rule, {"fluid.sound_speed_factor=12"}).fluid.sound_speed.factor, 12.0);
}

TEST(SceneReader, ReadsTheShiftAndTheBoundOfTheNoSlipFactor) {
  const FluidScene fluid =
      read(plain_fluid, {"fluid.shift_rate=0.25", "fluid.shift_shear=30", "fluid.largest_no_slip=1"}).fluid;
  EXPECT_EQ(fluid.shift_rate, 0.25);
  EXPECT_EQ(fluid.shift_shear, 30.0);
  EXPECT_EQ(fluid.largest_no_slip, 1.0);
}

TEST(SceneReader, ReadsThePrecision) {
  EXPECT_EQ(read(plain_fluid, {"fluid.precision=double"}).fluid.precision, Precision::full);
  EXPECT_EQ(read(plain_fluid, {"fluid.precision=single"}).fluid.precision, Precision::single);
}

TEST(SceneReader, ReadsSiUnitsIntoBaseUnits) {
  const std::string text = R"(
name = "air"
units = "SI"
[box]
size = ["885 um", "14.08 mm"]
[fluid]
density = "1.18 kg/m3"
viscosity = 1.89e-5
spacing = "1.4 um"
rcut = "5 um"
sound_speed = "293 m/s"
[[body]]
shape = "disc"
radius = "22.5 um"
density = "133.905 kg/m3"
array = { count = [2, 4] }
first_velocity = ["1 cm/s", 0.0]
[contact]
model = "linear"
stiffness = "2 N/m"
[force]
fluid = [0.0, "8.5e6 m/s2"]
[run]
step = "2 ns"
duration = "1 us"
)";
  const Scene scene = read(text);
  EXPECT_EQ(scene.units, Units::si);
  EXPECT_EQ(scene.box, (Triple{885e-6, 14.08e-3, 0.0}));
  EXPECT_EQ(scene.fluid.cutoff, 5e-6);
  EXPECT_EQ(scene.bodies[0].positions.size(), 8u);
  EXPECT_EQ(scene.bodies[0].positions[3], (Triple{0.5 * (885e-6 / 2) + 885e-6 / 2, 0.5 * 3.52e-3 + 3.52e-3, 0.0}));
  EXPECT_EQ(scene.bodies[0].velocities[0], (Triple{0.01, 0.0, 0.0}));
  EXPECT_EQ(scene.bodies[0].velocities[1], Triple{});
  EXPECT_EQ(scene.force.fluid[1], 8.5e6);
  EXPECT_EQ(scene.run.step, 2e-9);
}

TEST(SceneReader, ReadsBodiesOfEveryShape) {
  const std::string text = plain_fluid + R"(
[[body]]
shape = "composite"
balls = [{ centre = [-0.1, 0.0], radius = 0.1 }, { centre = [0.1, 0.0], radius = 0.05, contact_radius = 0.06 }]
density = 2.0
positions = [[0.3, 0.3], [0.7, 0.7]]
rotates = false
[[body]]
shape = "wall"
axis = "x"
position = 0.95
thickness = 0.2
motion = "moving"
velocity = [0.0, 0.1]
)";
  const Scene scene = read(text);
  ASSERT_EQ(scene.bodies.size(), 2u);
  EXPECT_EQ(scene.bodies[0].balls.size(), 2u);
  EXPECT_EQ(scene.bodies[0].balls[0].contact_radius, 0.1);
  EXPECT_EQ(scene.bodies[0].balls[1].contact_radius, 0.06);
  EXPECT_FALSE(scene.bodies[0].rotates);
  EXPECT_EQ(scene.bodies[1].shape, BodyScene::Shape::wall);
  EXPECT_EQ(scene.bodies[1].axis, 0);
  EXPECT_EQ(scene.bodies[1].motion, Motion::moving);
  EXPECT_EQ(scene.bodies[1].velocities[0][1], 0.1);
}

struct BadInput {
  const char* name;
  Overrides overrides;
  std::vector<std::string> parts;  // of the message: key, value, fix
};

class BadScene : public testing::TestWithParam<BadInput> {};

TEST_P(BadScene, IsOneClearError) {
  const BadInput& bad = GetParam();
  expect_input_error([&] { read(one_disc, bad.overrides); }, bad.parts);
}

const BadInput bad_inputs[] = {
    {"unknown_key", {"fluid.densty=3"}, {"scene.toml", "fluid.densty = 3", "did you mean \"density\""}},
    {"unknown_table", {"outputs.sample=3"}, {"outputs", "did you mean \"output\""}},
    {"unlike_any_key", {"box.quux=1"}, {"box.quux = 1", "known here: size"}},
    {"wrong_type_number", {"fluid.spacing=true"}, {"fluid.spacing = true", "write a number"}},
    {"wrong_type_text", {"fluid.spacing=small"}, {"fluid.spacing = 'small'", "write a number"}},
    {"hexadecimal_count", {"run.steps=0x10"}, {"run.steps = 0x10", "is not decimal"}},
    {"octal_count", {"run.steps=0o10"}, {"run.steps", "is not decimal"}},
    {"count_with_leading_zero", {"run.steps=010"}, {"run.steps", "'010'", "whole number"}},
    {"count_beyond_64_bits", {"run.steps=99999999999999999999"}, {"run.steps", "at most 9007199254740992"}},
    {"more_steps_than_are_counted", {"run.relax=9007199254740993"}, {"run.relax", "at most 9007199254740992"}},
    {"hexadecimal_number", {"fluid.viscosity=0x2"}, {"fluid.viscosity", "is not decimal"}},
    {"empty_number", {"run.steps="}, {"run.steps", "whole number"}},
    {"wrong_type_count", {"run.steps=1e3"}, {"run.steps = 1000.0", "whole number"}},
    {"wrong_type_flag", {"body.0.rotates=1"}, {"body.0.rotates = 1", "true or false"}},
    {"wrong_type_word", {"name=3"}, {"name = 3", "text in quotes"}},
    {"wrong_type_table", {"fluid=3"}, {"fluid = 3", "[fluid]"}},
    {"wrong_type_body", {"body=3"}, {"body = 3", "[[body]]"}},
    {"unit_in_dimensionless", {"fluid.spacing=\"1 um\""}, {"fluid.spacing", "1 um", "units = \"SI\""}},
    {"wrong_unit", {"units=SI", "fluid.viscosity=\"1 kg\""}, {"fluid.viscosity", "\"kg\" is not a unit", "Pa s"}},
    {"unknown_units", {"units=cgs"}, {"units = 'cgs'", "\"SI\", \"dimensionless\""}},
    {"zero_spacing", {"fluid.spacing=0"}, {"fluid.spacing = 0", "must be positive"}},
    {"negative_radius", {"body.0.radius=-0.5"}, {"body.0.radius = -0.5", "must be positive"}},
    {"negative_viscosity", {"fluid.viscosity=-1"}, {"fluid.viscosity = -1", "must not be negative"}},
    {"negative_count", {"run.relax=-1"}, {"run.relax = -1", "must not be negative"}},
    {"zero_box", {"box.size=[1, 0]"}, {"box.size", "must be positive"}},
    {"not_a_number", {"fluid.density=nan"}, {"fluid.density = nan", "not finite"}},
    {"infinite_force", {"force.fluid=[inf, 0]"}, {"force.fluid", "not finite"}},
    {"beyond_the_range", {"fluid.density=1e31"}, {"fluid.density = 1e+31", "between 1e-30 and 1e+30"}},
    {"too_near_zero", {"fluid.viscosity=1e-31"}, {"fluid.viscosity = 1e-31", "other units"}},
    {"array_count_beyond_integers",
     {"body.0={shape=\"disc\", radius=0.5, density=1.0, array={count=[1e25, 1]}}"},
     {"body.0.array.count", "more than 10000000 solids"}},
    {"one_side", {"box.size=[1]"}, {"box.size", "two or three sides"}},
    {"wrong_dimension", {"body.0.velocity=[1, 2, 3]"}, {"body.0.velocity", "a list of 2 numbers"}},
    {"sphere_in_the_plane", {"body.0.shape=sphere"}, {"body.0.shape = 'sphere'", "write \"disc\""}},
    {"unknown_shape", {"body.0.shape=cube"}, {"body.0.shape = 'cube'", "\"composite\""}},
    {"outside_the_box", {"body.0.position=[1, 5]"}, {"body.0.position", "5 lies outside the box [0, 4)"}},
    {"placed_twice", {"body.0.array={count=[1,1]}"}, {"body.0.position", "keep one of"}},
    {"array_count", {"body.0.array={count=[0,1]}", "body.0.position=[1,1]"}, {"body.0", "keep one of"}},
    {"fixed_with_velocity", {"body.0.motion=fixed"}, {"body.0.velocity", "motion = \"moving\""}},
    {"turning_but_held", {"body.0.rotates=false"}, {"body.0.angular_velocity = 3.0", "rotates = true"}},
    {"two_steps", {"run.step_factor=1", "run.step=0.1", "run.relax=1", "run.steps=0"}, {"run.steps = 0", "at least 1"}},
    {"no_contact_constant", {"contact.model=linear"}, {"contact.stiffness", "missing"}},
    {"key_of_another_model",
     {"contact.model=linear", "contact.stiffness=1", "contact.young=1"},
     {"contact.young = 1", "unknown key"}},
    {"restitution",
     {"contact.model=linear", "contact.stiffness=1", "contact.restitution=1.5"},
     {"contact.restitution = 1.5", "(0, 1]"}},
    {"force_word", {"force.solid=balanced"}, {"force.solid = 'balanced'", "write \"balance\""}},
    {"wave_axis",
     {"fluid.wave={amplitude=1, direction=\"z\", gradient=\"y\"}"},
     {"fluid.wave.direction", "no such axis"}},
    {"sample", {"output.sample=0"}, {"output.sample = 0", "at least 1"}},
    {"shift_without_transport", {"fluid.transport=false", "fluid.shift_rate=1"}, {"fluid.shift_rate", "remove it"}},
    {"shear_without_transport", {"fluid.method=classic", "fluid.shift_shear=1"}, {"fluid.shift_shear", "remove it"}},
    {"zero_shift", {"fluid.shift_rate=0"}, {"fluid.shift_rate = 0", "must be positive"}},
    {"shift_of_old", {"fluid.shift_pressure=1"}, {"fluid.shift_pressure = 1", "unknown key"}},
    {"bound_below_a_plain_wall", {"fluid.largest_no_slip=0.5"}, {"fluid.largest_no_slip = 0.5", "at least 1"}},
    {"bound_of_a_plain_wall",
     {"fluid.no_slip=plain", "fluid.largest_no_slip=4"},
     {"fluid.largest_no_slip", "remove it"}},
    {"unknown_precision", {"fluid.precision=half"}, {"fluid.precision = 'half'", "\"single\""}},
    {"precision_without_fluid",
     {"fluid={particles=false, density=1, spacing=0.0625, sound_speed=1, precision=\"single\"}"},
     {"fluid.precision = 'single'", "unknown key"}},
};

INSTANTIATE_TEST_SUITE_P(SceneReader, BadScene, testing::ValuesIn(bad_inputs),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

/// The text with the line that starts with `start` taken out or replaced.
std::string with_line(std::string text, const std::string& start, const std::string& line) {
  const std::size_t at = text.find("\n" + start);
  EXPECT_NE(at, std::string::npos) << start;
  const std::size_t end = text.find('\n', at + 1);
  return text.replace(at, end - at, line.empty() ? "" : "\n" + line);
}

TEST(SceneReader, TwoDeclarationsOfOneSceneHaveOneIdentity) {
  const std::string identity = read(one_disc).identity;
  EXPECT_NE(identity.find("fluid.density = 3\n"), std::string::npos) << identity;
  EXPECT_NE(identity.find("body.0.velocity = [0.3, -0.4]\n"), std::string::npos) << identity;
  for (const Overrides& same : std::vector<Overrides>{{"fluid.density=3"},
                                                      {"fluid.spacing=1.25e-1"},
                                                      {"fluid.kernel=wendland-c2"},
                                                      {"fluid.shift_rate=0.3", "run.relax=0"},
                                                      {"body.0.motion=free", "body.0.rotates=true"},
                                                      {"force.solid=[0, 0]"},
                                                      {"run.steps=20"},
                                                      {"run.duration=0.5"},
                                                      {"output.sample=7", "output.solids=true"}})
    EXPECT_EQ(read(one_disc, same).identity, identity) << same[0];
  for (const Overrides& other : std::vector<Overrides>{{"fluid.density=3.0000000000000004"},
                                                       {"fluid.kernel=lucy"},
                                                       {"body.0.position=[1.0, 1.5]"},
                                                       {"run.relax=1"},
                                                       {"run.step=0.001"},
                                                       {"units=SI"}})
    EXPECT_NE(read(one_disc, other).identity, identity) << other[0];
  const std::string si = read(one_disc, {"units=SI"}).identity;
  EXPECT_EQ(read(one_disc, {"units=SI", "fluid.viscosity=\"600 mPa s\""}).identity, si);
}

TEST(SceneReader, NamesMissingKeysAndExplainsMisspeltOnes) {
  expect_input_error([] { read(with_line(one_disc, "viscosity", "")); }, {"scene.toml:6", "fluid.viscosity: missing"});
  expect_input_error([] { read(with_line(one_disc, "viscosity", "viscosty = 0.6")); },
                     {"scene.toml:8", "fluid.viscosty = 0.6", "did you mean \"viscosity\""});
  expect_input_error([] { read(with_line(one_disc, "sound_speed", "")); }, {"fluid.sound_speed", "reference_velocity"});
  expect_input_error([] { read(with_line(one_disc, "position", "")); }, {"body.0.position", "give one of"});
  expect_input_error([] { read("name = \"a\"\nunits = \"SI\"\n"); }, {"scene.toml", "box: missing"});
}

TEST(SceneReader, NamesAlternativesGivenTogether) {
  expect_input_error([] { read(with_line(one_disc, "steps", "steps = 10\nduration = 1.0")); },
                     {"scene.toml:", "run.duration = 1.0", "keep one"});
  expect_input_error([] { read(with_line(one_disc, "steps", "steps = 10\nstep = 1.0\nstep_factor = 1.0")); },
                     {"run.step_factor = 1.0", "keep one"});
  expect_input_error([] { read(with_line(one_disc, "sound_speed", "sound_speed = 1.0\nsound_speed_factor = 9.0")); },
                     {"fluid.sound_speed_factor = 9.0", "keep one"});
}

TEST(SceneReader, NamesTheLineOfASyntaxError) {
  expect_input_error([] { read("name = \"a\"\nunits = \n"); }, {"scene.toml:2", "TOML"});
}

TEST(SceneReader, RefusesUnreadablePaths) {
  expect_input_error([] { read_scene("/no/such/scene.toml", {}); }, {"/no/such/scene.toml", "cannot be read"});
  expect_input_error([] { read_scene("/", {}); }, {"cannot be read"});
}

TEST(SceneReader, AWallMovesAlongItselfAndIsNeverFree) {
  const std::string wall = plain_fluid + "[[body]]\nshape = \"wall\"\naxis = \"y\"\nposition = 0.5\nthickness = 0.25\n";
  EXPECT_EQ(read(wall).bodies[0].motion, Motion::fixed);
  expect_input_error([&] { read(wall, {"body.0.motion=free"}); }, {"body.0.motion", "cannot be free"});
  expect_input_error(
      [&] {
        read(wall, {"body.0.motion=moving", "body.0.velocity=[0.0, 1.0]"});
      },
      {"body.0.velocity", "along itself"});
  expect_input_error([&] { read(wall, {"body.0.thickness=1.0"}); }, {"body.0.thickness = 1.0", "thinner"});
  expect_input_error([&] { read(wall, {"body.0.position=1.0"}); }, {"body.0.position = 1.0", "outside the box"});
}

}  // namespace
}  // namespace mappm::test
