// Random packings and overlaps. Oracle: all pairs, with all periodic images.
#include "scene/packing.hpp"

#include <cmath>

#include "scene/obstacles.hpp"
#include "unit/scene/scene_setup.hpp"

namespace mappm::test {
namespace {

double nearest_distance(const Scene& scene, const Triple& a, const Triple& b) {
  double nearest = HUGE_VAL;
  const int depth = scene.dimension == 3 ? 1 : 0;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -depth; k <= depth; ++k)
        nearest = std::min(nearest, std::hypot(a[0] - b[0] + i * scene.box[0], a[1] - b[1] + j * scene.box[1],
                                               a[2] - b[2] + k * scene.box[2]));
  return nearest;
}

std::string with_random_discs(const std::string& random) {
  return plain_fluid + "[[body]]\nshape = \"disc\"\nradius = 0.05\ndensity = 2.0\nrandom = " + random + "\n";
}

TEST(ScenePacking, SolidsKeepTheirGapFromEachOtherAndFromWalls) {
  const std::string wall = "[[body]]\nshape = \"wall\"\naxis = \"y\"\nposition = 0.9\nthickness = 0.2\n";
  const Scene scene = read(with_random_discs("{ count = 20, seed = 7, gap = 0.02 }") + wall);
  const std::vector<Triple>& x = scene.bodies[0].positions;
  ASSERT_EQ(x.size(), 20u);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_GE(x[i][1], 0.1 + 0.05 + 0.02 - 1e-11);  // the wall fills 0.9 < y < 1.1
    EXPECT_LE(x[i][1], 0.9 - 0.05 - 0.02 + 1e-11);
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE(nearest_distance(scene, x[i], x[j]), 0.12 - 1e-11);
  }
}

TEST(ScenePacking, AvoidsBodiesDeclaredLater) {
  const Scene scene = read(with_random_discs("{ count = 10, seed = 1 }") +
                           "[[body]]\nshape = \"disc\"\nradius = 0.3\ndensity = 2.0\nposition = [0.0, 0.5]\n");
  for (const Triple& x : scene.bodies[0].positions)
    EXPECT_GE(nearest_distance(scene, x, {0.0, 0.5, 0.0}), 0.35 - 1e-11);
}

TEST(ScenePacking, DependsOnTheSeedAlone) {
  const auto positions = [](const std::string& random) { return read(with_random_discs(random)).bodies[0].positions; };
  EXPECT_EQ(positions("{ count = 9, seed = 3 }"), positions("{ count = 9, seed = 3 }"));
  EXPECT_NE(positions("{ count = 9, seed = 3 }"), positions("{ count = 9, seed = 4 }"));
  // The first draw of the 64-bit Mersenne twister of the default seed is fixed by the C++ standard library's
  // definition: 14514284786278117030, so that x = (draw / 2^11) / 2^53.
  EXPECT_EQ(positions("{ count = 1, seed = 5489 }")[0][0],
            static_cast<double>(14514284786278117030ull >> 11) * 0x1p-53);
}

TEST(ScenePacking, SaysWhenSolidsDoNotFit) {
  expect_input_error([] { read(with_random_discs("{ count = 200, seed = 1 }")); },
                     {"body.0.random", "of 200 solids fit", "fewer or smaller"});
  expect_input_error([] { read(with_random_discs("{ count = 0, seed = 1 }")); },
                     {"body.0.random.count = 0", "at least 1"});
}

Scene two_balls(double x, double second_radius) {
  Scene scene = read(plain_fluid);
  BodyScene body;
  body.key = "body.0";
  body.balls = {{{}, 0.1, 0.1}};
  body.positions = {{0.05, 0.5, 0.0}};
  scene.bodies = {body, body};
  scene.bodies[1].key = "body.1";
  scene.bodies[1].balls[0] = {{}, 0.1, second_radius};
  scene.bodies[1].positions = {{x, 0.5, 0.0}};
  return scene;
}

TEST(SceneObstacles, TouchingIsAllowedOverlapIsNot) {
  EXPECT_EQ(input_error([] { check_overlaps(two_balls(0.25, 0.1)); }), "");
  expect_input_error([] { check_overlaps(two_balls(0.249, 0.1)); }, {"body.1", "[0.249, 0.5]", "body.0", "move one"});
  expect_input_error([] { check_overlaps(two_balls(0.25, 0.11)); }, {"body.1", "overlaps"});  // by contact radius
}

TEST(SceneObstacles, PeriodicImagesCount) {
  EXPECT_EQ(input_error([] { check_overlaps(two_balls(0.85, 0.1)); }), "");
  expect_input_error([] { check_overlaps(two_balls(0.86, 0.1)); }, {"body.1", "overlaps"});
}

TEST(SceneObstacles, AgreesWithAllPairsOnManyBalls) {
  const Scene scene = read(with_random_discs("{ count = 30, seed = 11 }"));
  const std::vector<Triple>& x = scene.bodies[0].positions;
  for (const double gap : {0.0, 0.01, 0.03}) {
    Obstacles obstacles(scene, 0.05, 0.03);
    for (std::size_t i = 0; i < x.size(); ++i) obstacles.add(placed_ball(scene, 0, i, 0));
    for (std::size_t i = 0; i < x.size(); ++i) {
      bool near = false;
      for (std::size_t j = 0; j < x.size(); ++j)
        near = near || (i != j && nearest_distance(scene, x[i], x[j]) < 0.1 + gap);
      EXPECT_EQ(obstacles.ball_near(placed_ball(scene, 0, i, 0), gap) != nullptr, near) << i << " gap " << gap;
    }
  }
}

TEST(SceneObstacles, WallsMustBeApart) {
  const auto wall = [](const char* axis, double position) {
    return std::string("[[body]]\nshape = \"wall\"\nthickness = 0.2\naxis = \"") + axis +
           "\"\nposition = " + std::to_string(position) + "\n";
  };
  const auto check = [&](const std::string& walls) { return [=] { check_overlaps(read(plain_fluid + walls)); }; };
  EXPECT_EQ(input_error(check(wall("y", 0.1) + wall("y", 0.5))), "");
  expect_input_error(check(wall("y", 0.1) + wall("x", 0.5)), {"body.1.position", "overlaps the wall body.0", "extent"});
  expect_input_error(check(wall("y", 0.1) + wall("y", 0.2)), {"body.1.position", "overlaps the wall body.0"});
  expect_input_error(check(wall("y", 0.1) + wall("y", 0.95)), {"body.1.position", "overlaps"});  // across the border
  expect_input_error(check(wall("y", 0.1) + "[[body]]\nshape = \"disc\"\nradius = 0.2\ndensity = 1.0\n"
                                            "position = [0.5, 0.45]\n"),
                     {"body.1", "overlaps the wall body.0"});
}

}  // namespace
}  // namespace mappm::test
