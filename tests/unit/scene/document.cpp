// Overrides and the canonical text, seen through the reader.
#include "unit/scene/scene_setup.hpp"

namespace mappm::test {
namespace {

TEST(SceneDocument, OverridesReplaceAndAddValues) {
  const Scene scene = read(one_disc, {"fluid.spacing=0.25", "body.0.position=[0.5, 0.75]", "body.0.motion=moving",
                                      "output.sample=7", "box.size=[2, 3]", "name = two words"});
  EXPECT_EQ(scene.fluid.spacing, 0.25);
  EXPECT_EQ(scene.bodies[0].positions[0], (Triple{0.5, 0.75, 0.0}));
  EXPECT_EQ(scene.bodies[0].motion, Motion::moving);
  EXPECT_EQ(scene.output.sample, 7u);
  EXPECT_EQ(scene.box[1], 3.0);
  EXPECT_EQ(scene.fluid.cutoff, 0.5);
}

TEST(SceneDocument, OverridesReachEntriesOfLists) {
  const Scene scene = read(one_disc, {"box.size.1=3.5", "body.0.velocity.0=4.0"});
  EXPECT_EQ(scene.box[1], 3.5);
  EXPECT_EQ(scene.bodies[0].velocities[0], (Triple{4.0, -0.4, 0.0}));
}

TEST(SceneDocument, AnAlternativeReplacesTheOther) {
  const Scene scene =
      read(one_disc, {"run.duration=2.0", "fluid.sound_speed_factor=15", "fluid.reference_velocity=0.1"});
  EXPECT_EQ(scene.run.duration, 2.0);
  EXPECT_EQ(scene.run.steps, 0u);
  EXPECT_FALSE(scene.fluid.sound_speed.value.has_value());
  EXPECT_EQ(scene.fluid.sound_speed.factor, 15.0);
}

TEST(SceneDocument, TextThatTheLibraryTakesForImpossibleIsAnError) {
  expect_input_error([] { read("name = \"a\"\n\u03fb = 1\n"); }, {"scene.toml:2", "mend the line"});
  expect_input_error([] { read("name = \"a\"\n[ = 1\n"); }, {"scene.toml:2", "mend the line"});
}

TEST(SceneDocument, BadOverridesAreErrors) {
  expect_input_error([] { read(one_disc, {"fluid.spacing"}); }, {"--set: fluid.spacing", "write --set key.path=value"});
  expect_input_error([] { read(one_disc, {"=3"}); }, {"--set: =3", "write --set key.path=value"});
  expect_input_error([] { read(one_disc, {"body.1.radius=1"}); }, {"body.1.radius = 1", "no entry of a list of 1"});
  expect_input_error([] { read(one_disc, {"body.first.radius=1"}); }, {"\"first\"", "entries count from 0"});
  expect_input_error([] { read(one_disc, {"name.first=1"}); }, {"name.first = 1", "stands below a value"});
  expect_input_error([] { read(one_disc, {"fluid.spacng=0.1"}); }, {"fluid.spacng = 0.1", "did you mean \"spacing\""});
  expect_input_error([] { read(one_disc, {"fliud.spacing=0.1"}); }, {"scene.toml", "fliud", "did you mean \"fluid\""});
}

TEST(SceneDocument, TextIsTheSameForTheSameSceneAndHoldsTheOverrides) {
  const std::string reordered = R"(
units = "dimensionless"
name = "plain fluid"     # another order, comments, and what verification wants to know
[case]
purpose = "none"
[run]
steps = 10
[fluid]
sound_speed = 1.0
spacing = 0.0625
viscosity = 0.01
density = 1.0
[box]
size = [ 1.0, 1.0 ]
)";
  EXPECT_EQ(read(plain_fluid).text, read(reordered).text);
  EXPECT_NE(read(plain_fluid).text, read(plain_fluid, {"fluid.viscosity=0.02"}).text);
  EXPECT_EQ(read(read(one_disc).text).text, read(one_disc).text);
}

}  // namespace
}  // namespace mappm::test
