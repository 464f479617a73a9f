// The particles at step 0: lattice, holes for the solids, and independence from the partition of the box.
#include <cmath>
#include <map>
#include <set>

#include "unit/scene/scene_setup.hpp"

namespace mappm::test {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Discs of two kinds, one across the border, a composite and a moving wall.
const std::string crowded = R"(
name = "crowded"
units = "dimensionless"
[box]
size = [2.0, 3.0]
[fluid]
density = 1.0
viscosity = 0.1
spacing = 0.0333333
sound_speed = 10.0
velocity = [0.25, 0.0]
wave = { amplitude = 0.5, direction = "x", gradient = "y", mode = 2 }
[[body]]
shape = "disc"
radius = 0.2
density = 2.0
positions = [[0.05, 0.4], [1.2, 0.6]]
first_velocity = [0.3, 0.4]
[[body]]
shape = "composite"
balls = [{ centre = [0.0, 0.0], radius = 0.15 }, { centre = [0.2, 0.0], radius = 0.1 }]
density = 3.0
position = [1.85, 1.9]
[[body]]
shape = "wall"
axis = "y"
position = 2.45
thickness = 0.1875
motion = "moving"
velocity = [0.5, 0.0]
[run]
steps = 10
)";

const std::string crowded_3d = R"(
name = "crowded"
units = "dimensionless"
[box]
size = [1.0, 1.2, 0.8]
[fluid]
density = 1.0
viscosity = 0.1
spacing = 0.05
sound_speed = 10.0
[[body]]
shape = "sphere"
radius = 0.2
density = 2.0
random = { count = 3, seed = 5, gap = 0.01 }
angular_velocity = [1.0, 2.0, 3.0]
[[body]]
shape = "wall"
axis = "z"
position = 0.7
thickness = 0.2
[run]
steps = 10
)";

template <int D>
struct Whole {
  explicit Whole(const std::string& text, const Overrides& overrides = {})
      : scene(read(text, overrides)), model(make_model<D>(scene).model) {}
  State<D> build(const Region<D>& region = Region<D>::whole_box()) const { return build_state(scene, model, region); }
  Scene scene;
  Model<D> model;
};

/// Cuts the box at the given fractions of each side.
template <int D>
std::vector<Region<D>> partition(const std::array<std::vector<double>, D>& cuts) {
  std::vector<Region<D>> regions{Region<D>::whole_box()};
  for (int axis = 0; axis < D; ++axis) {
    std::vector<Region<D>> finer;
    for (const Region<D>& region : regions) {
      Region<D> part = region;
      for (const double cut : cuts[axis]) {
        part.high[axis] = std::floor(cut * box_quanta);
        finer.push_back(part);
        part.low[axis] = part.high[axis];
      }
      part.high[axis] = box_quanta;
      finer.push_back(part);
    }
    regions = finer;
  }
  return regions;
}

template <int D>
void expect_independent_of_partition(const Whole<D>& whole, const std::array<std::vector<double>, D>& cuts) {
  const State<D> all = whole.build();
  std::uint64_t digest = 0;
  std::map<std::uint64_t, std::array<double, 2 * D>> particles;
  std::map<std::uint64_t, Vec<D, double>> solids;
  for (const Region<D>& region : partition<D>(cuts)) {
    const State<D> part = whole.build(region);
    digest += digest_share(part);
    for (std::size_t i = 0; i < part.fluid.size(); ++i) {
      std::array<double, 2 * D> fields;
      Vec<D, double> x;
      for (int f = 0; f < 2 * D; ++f) fields[f] = part.fluid.field[f][i];
      for (int axis = 0; axis < D; ++axis) x[axis] = fields[axis];
      ASSERT_TRUE(region.contains(x));
      ASSERT_TRUE(particles.emplace(part.fluid.id[i], fields).second) << "twice: " << part.fluid.id[i];
    }
    for (const Solid<D>& solid : part.solids) ASSERT_TRUE(solids.emplace(solid.id, solid.x).second);
  }
  EXPECT_EQ(digest, digest_share(all));
  EXPECT_EQ(solids.size(), all.solids.size());
  ASSERT_EQ(particles.size(), all.fluid.size());
  for (std::size_t i = 0; i < all.fluid.size(); ++i)
    for (int f = 0; f < 2 * D; ++f) ASSERT_EQ(particles.at(all.fluid.id[i])[f], all.fluid.field[f][i]);
}

TEST(SceneState, IsTheSameForEveryPartitionInThePlane) {
  const Whole<2> whole(crowded);
  expect_independent_of_partition<2>(whole, {{{0.5}, {}}});
  expect_independent_of_partition<2>(whole, {{{}, {0.1, 0.2, 0.7}}});
  expect_independent_of_partition<2>(whole, {{{0.03, 0.6}, {0.135, 0.5, 0.8}}});
}

TEST(SceneState, IsTheSameForEveryPartitionInSpace) {
  const Whole<3> whole(crowded_3d);
  expect_independent_of_partition<3>(whole, {{{0.5}, {0.3, 0.6}, {0.9}}});
}

TEST(SceneState, DisorderIsTheSameForEveryPartition) {
  const Overrides disorder{"fluid.disorder={amplitude=0.25, seed=9}"};
  const Whole<2> plane(crowded, disorder);
  // Borders through nodes, between them, and at the reach of a displaced PP.
  expect_independent_of_partition<2>(plane, {{{0.5 / 60, 10.25 / 60, 0.5}, {}}});
  expect_independent_of_partition<2>(plane, {{{}, {30.3 / 90, 30.75 / 90, 31.25 / 90}}});
  expect_independent_of_partition<3>(Whole<3>(crowded_3d, disorder), {{{0.52}, {0.3, 0.6}, {0.9}}});
}

TEST(SceneState, AnEmptyRegionIsEmpty) {
  Region<2> region;
  region.low = region.high = {{1e15, 1e15}};
  EXPECT_EQ(Whole<2>(crowded).build(region).fluid.size(), 0u);
}

TEST(SceneState, LatticeOfPowersOfTwoIsExact) {
  const State<2> state = Whole<2>(plain_fluid).build();
  ASSERT_EQ(state.fluid.size(), 256u);
  for (std::size_t i = 0; i < 256; ++i) {
    EXPECT_EQ(state.fluid.id[i], i);
    EXPECT_EQ(state.fluid.x(0)[i], (static_cast<double>(i % 16) + 0.5) * 0x1p48);
    EXPECT_EQ(state.fluid.x(1)[i], (static_cast<double>(i / 16) + 0.5) * 0x1p48);
  }
}

TEST(SceneState, OtherLatticesAreRoundedToTheNearestQuantum) {
  const State<2> state = Whole<2>(plain_fluid, {"box.size=[0.9375, 0.875]"}).build();  // 15 x 14 nodes
  ASSERT_EQ(state.fluid.size(), 210u);
  for (std::size_t i = 0; i < 15; ++i) {
    __extension__ using Wide = unsigned __int128;
    const Wide x = static_cast<Wide>(state.fluid.x(0)[i]);
    const Wide twice = static_cast<Wide>(2 * i + 1) << 52;  // 30 x must lie within 15 of it
    EXPECT_LE(x * 30 > twice ? x * 30 - twice : twice - x * 30, Wide{15});
  }
}

TEST(SceneState, EachSolidDisplacesItsVolume) {
  const Whole<2> whole(crowded);
  const State<2> state = whole.build();
  // 60 x 90 nodes, area of a cell 6 / 5400; two discs, a wall of 0.1875 x 2 and the composite, whose area is that of
  // two circles (r 0.15 and 0.1, centres 0.2 apart) less their lens.
  const double d = 0.2, a = 0.15, b = 0.1;
  const double lens = a * a * std::acos((d * d + a * a - b * b) / (2 * d * a)) +
                      b * b * std::acos((d * d + b * b - a * a) / (2 * d * b)) -
                      0.5 * std::sqrt((-d + a + b) * (d + a - b) * (d - a + b) * (d + a + b));
  const double area = 2 * pi * 0.04 + 0.375 + pi * (a * a + b * b) - lens;
  EXPECT_NEAR(static_cast<double>(state.fluid.size()), 5400.0 * (1.0 - area / 6.0), 1.0);  // one: the composite's grid
  EXPECT_EQ(state.fluid.size(), make_model<2>(whole.scene).fluid_particles);
}

TEST(SceneState, TheDeepestNodesAreTheOnesRemoved) {
  const Whole<2> whole(one_disc);
  const State<2> state = whole.build();
  ASSERT_EQ(state.fluid.size(), 462u);
  // All pairs: signed distances of the 512 nodes, the 50 smallest with ties by id.
  std::set<std::pair<double, std::uint64_t>> ranked;
  for (std::uint64_t id = 0; id < 512; ++id) {
    const double x = (static_cast<double>(id % 16) + 0.5) * 0.125 - 1.0;
    const double y = (static_cast<double>(id / 16) + 0.5) * 0.125 - 1.0;
    ranked.emplace(std::sqrt(x * x + y * y), id);
  }
  std::set<std::uint64_t> kept;
  for (auto rank = std::next(ranked.begin(), 50); rank != ranked.end(); ++rank) kept.insert(rank->second);
  EXPECT_EQ(std::set<std::uint64_t>(state.fluid.id.begin(), state.fluid.id.end()), kept);
}

TEST(SceneState, VelocitiesAreQuantisedAndFollowTheWave) {
  const Whole<2> whole(crowded);
  const State<2> state = whole.build();
  for (std::size_t i = 0; i < state.fluid.size(); ++i) {
    const double u = state.fluid.v(0)[i];
    EXPECT_EQ(u / velocity_quantum, std::nearbyint(u / velocity_quantum));
    const double y = state.fluid.x(1)[i] / box_quanta;
    EXPECT_NEAR(u, 0.025 + 0.05 * std::sin(4.0 * pi * y), 1e-14);  // c = 10; rounding of sin and to 2^-48
    EXPECT_EQ(state.fluid.v(1)[i], 0.0);
  }
}

TEST(SceneState, SolidsCarryTheirMomentum) {
  const State<2> state = Whole<2>(one_disc).build();
  ASSERT_EQ(state.solids.size(), 1u);
  const Solid<2>& solid = state.solids[0];
  const double mass = 32.0 * pi;
  EXPECT_EQ(solid.x, (Vec<2, double>{{0x1p51, 0x1p50}}));
  EXPECT_NEAR(static_cast<double>(solid.momentum[0]) * velocity_quantum, 0.03 * mass, 1e-12);
  EXPECT_NEAR(static_cast<double>(solid.momentum[1]) * velocity_quantum, -0.04 * mass, 1e-12);
  // omega rcut / c = 0.15, I = mass / 2
  EXPECT_NEAR(static_cast<double>(solid.angular_momentum[0]) * velocity_quantum, 0.075 * mass, 1e-12);
  EXPECT_EQ(solid.motion, SolidMotion::free);
}

TEST(SceneState, AngularMomentumInSpaceGivesBackTheDeclaredVelocity) {
  const Whole<3> whole(crowded_3d);
  const State<3> state = whole.build();
  const RigidVelocity<3> velocity = rigid_velocity(state.solids[0], whole.model.shapes[0]);
  const double unit = whole.model.units.time();
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(velocity.angular[axis], (axis + 1.0) * unit, 1e-14);
}

TEST(SceneState, WallsAreCutIntoEqualPiecesOfOneGroup) {
  const Whole<2> whole(crowded);
  const State<2> state = whole.build();
  std::vector<const Solid<2>*> pieces;
  for (const Solid<2>& solid : state.solids)
    if (solid.shape == 2) pieces.push_back(&solid);
  // 2.5 rcut are 7.5 spacings; of the divisors of 60 nodes, 6 is nearer than 10.
  ASSERT_EQ(pieces.size(), 10u);
  for (const Solid<2>* piece : pieces) {
    EXPECT_EQ(piece->group, pieces[0]->group);
    EXPECT_EQ(piece->x[1], pieces[0]->x[1]);
    EXPECT_EQ(piece->momentum, pieces[0]->momentum);
    EXPECT_EQ(piece->motion, SolidMotion::moving);
  }
  EXPECT_EQ(rigid_velocity(*pieces[0], whole.model.shapes[2]).linear[0], 0.05);
  EXPECT_NEAR(pieces[3]->x[0], 0.35 * box_quanta, 1.0);
  for (const Solid<2>& solid : state.solids) EXPECT_EQ(solid.group == pieces[0]->group, solid.shape == 2);

  const std::vector<WallFace<2>>& faces = whole.model.faces;
  ASSERT_EQ(faces.size(), 2u);
  EXPECT_EQ(faces[0].id, std::uint64_t{1} << 62);
  EXPECT_EQ(faces[0].sign, -1.0);
  EXPECT_NEAR(faces[0].x, 2.45 / 3.0 * box_quanta, 1.0);
  EXPECT_EQ(faces[1].sign, 1.0);
  EXPECT_NEAR(faces[1].x, 2.6375 / 3.0 * box_quanta, 1.0);
  EXPECT_EQ(faces[1].velocity, (Vec<2, double>{{0.05, 0.0}}));
}

TEST(SceneState, AWallOfIndivisibleLengthIsRefused) {
  // 61 nodes, a prime
  expect_input_error([] { make_model<2>(read(crowded, {"box.size=[2.0333, 3.0]"})); },
                     {"body.2", "61 lattice nodes", "change box.size"});
}

TEST(SceneState, ACompositeStandsWithItsCentreOfMassBesideItsOrigin) {
  const Whole<2> whole(crowded);
  const Solid<2> solid = whole.build().solids[2];
  const double d = 0.2, a = 0.15, b = 0.1;
  // Union of two circles: first moments of both less that of the lens, integrated on a fine grid.
  double area = 0.0, moment = 0.0;
  const int n = 2000;
  for (int i = 0; i < n; ++i) {
    const double x = -a + (i + 0.5) * (a + d + b) / n;
    const double h1 = std::sqrt(std::max(0.0, a * a - x * x));
    const double h2 = std::sqrt(std::max(0.0, b * b - (x - d) * (x - d)));
    area += std::max(h1, h2);
    moment += x * std::max(h1, h2);
  }
  const double x = (1.85 + moment / area) / 2.0;  // of the box side
  EXPECT_NEAR(solid.x[0] / box_quanta, x, 5e-5);  // make_body integrates on a grid of an eighth of a spacing
  EXPECT_NEAR(solid.x[1] / box_quanta, 1.9 / 3.0, 1e-12);
}

}  // namespace
}  // namespace mappm::test
