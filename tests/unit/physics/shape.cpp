// Oracles: areas and volumes in closed form, the geometry the FPs must obey, and sums of the kernel over a fluid that
// surrounds the body.
#include "physics/shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/kernel.hpp"
#include "physics/matter.hpp"

namespace mappm {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double dx = 0.3125;
const FrozenLayer plane_layer{dx, 1.0 / (dx * dx)};
const FrozenLayer space_layer{dx, 1.0 / (dx * dx * dx)};

double length_of(const auto& v) { return std::sqrt(dot(v, v)); }

template <int D>
void expect_sound_frozen_particles(const Shape<D>& shape, double number_density) {
  for (const FrozenParticle<D>& point : shape.frozen) {
    EXPECT_NEAR(length_of(point.normal), 1.0, 1e-14);
    const double steps = point.own_density / density_quantum;
    EXPECT_EQ(steps, std::floor(steps));
    EXPECT_GT(point.own_density, 0.3 * number_density);
    EXPECT_LE(point.own_density, number_density + density_quantum);
  }
}

TEST(MakeBody, disc) {
  const double radius = 2.5, contact_radius = 2.6;  // R = 8 dx
  const auto shape = make_body<2, WendlandC2>({{{{0.7, 0.1}}, radius, contact_radius}}, 30.0, plane_layer);
  ASSERT_EQ(shape.balls.size(), 1u);
  EXPECT_EQ(shape.balls[0].offset, (Vec<2, double>{}));  // the centre of mass is the origin
  EXPECT_DOUBLE_EQ(shape.volume, pi * radius * radius);
  EXPECT_DOUBLE_EQ(shape.mass, 30.0 * shape.volume);
  EXPECT_DOUBLE_EQ(shape.inverse_inertia[0], 2.0 / (shape.mass * radius * radius));
  EXPECT_DOUBLE_EQ(shape.reach, contact_radius);
  EXPECT_TRUE(shape.rotates);
  expect_sound_frozen_particles(shape, plane_layer.number_density);
  // Rings at depths dx/2, 3dx/2, 5dx/2 (the last below 1): they fill the annulus down to 3 dx.
  const double area = pi * (radius * radius - (radius - 3 * dx) * (radius - 3 * dx));
  EXPECT_NEAR(static_cast<double>(shape.frozen.size()), area / (dx * dx), 1.5);  // half an FP per ring
  for (const auto& point : shape.frozen) {
    EXPECT_NEAR(length_of(point.offset) + point.depth, radius, 1e-14);
    EXPECT_NEAR(dot(point.offset, point.normal), length_of(point.offset), 1e-14);
    const double ring = point.depth / dx - 0.5;
    EXPECT_NEAR(ring, std::round(ring), 1e-12);
    EXPECT_LT(point.depth, 1.0);
  }
}

TEST(MakeBody, sphere) {
  const double radius = 1.875;  // 6 dx
  const auto shape = make_body<3, WendlandC2>({{{}, radius, radius}}, 60.0, space_layer);
  EXPECT_DOUBLE_EQ(shape.volume, 4.0 / 3.0 * pi * radius * radius * radius);
  for (int a = 0; a < 3; ++a) EXPECT_DOUBLE_EQ(shape.inverse_inertia[4 * a], 2.5 / (shape.mass * radius * radius));
  EXPECT_EQ(shape.inverse_inertia[1], 0.0);
  expect_sound_frozen_particles(shape, space_layer.number_density);
  const double inner = radius - 3 * dx;
  const double volume = 4.0 / 3.0 * pi * (radius * radius * radius - inner * inner * inner);
  EXPECT_NEAR(static_cast<double>(shape.frozen.size()), volume / (dx * dx * dx), 1.5);
  for (const auto& point : shape.frozen) EXPECT_NEAR(length_of(point.offset) + point.depth, radius, 1e-14);
  // Neighbours on the outer shell keep their distance: the spiral has no clusters.
  const auto on_outer_shell = [](const auto& point) { return point.depth < dx; };
  for (const auto& a : shape.frozen)
    for (const auto& b : shape.frozen)
      if (&a != &b && on_outer_shell(a) && on_outer_shell(b)) {
        EXPECT_GT(length_of(a.offset - b.offset), 0.6 * dx);
      }
}

TEST(MakeBody, small_bodies_are_filled_to_the_centre) {
  for (const double radius : {0.1, 0.2, 0.5, 0.625, 0.8}) {
    const auto disc = make_body<2, Lucy>({{{}, radius, radius}}, 10.0, plane_layer);
    const double expected = std::max(1.0, pi * radius * radius / (dx * dx));
    EXPECT_NEAR(static_cast<double>(disc.frozen.size()), expected, 1.5) << radius;
    for (const auto& point : disc.frozen) EXPECT_NEAR(length_of(point.offset) + point.depth, radius, 1e-14);
  }
}

TEST(MakeBody, dumbbell_is_balanced_and_has_no_inner_surface) {
  const double radius = 1.25;
  const std::vector<Ball<2>> balls{{{{5.0, 1.0}}, radius, radius}, {{{6.5, 1.0}}, radius, radius}};
  const auto shape = make_body<2, WendlandC2>(balls, 20.0, plane_layer);
  EXPECT_NEAR(shape.balls[0].offset[0], -0.75, 1e-12);
  EXPECT_NEAR(shape.balls[1].offset[0], 0.75, 1e-12);
  EXPECT_NEAR(shape.balls[0].offset[1], 0.0, 1e-12);
  EXPECT_NEAR(shape.reach, 0.75 + radius, 1e-12);
  // 2 pi R^2 minus the lens of two circles at distance d: 2 R^2 acos(d / 2R) - d/2 sqrt(4 R^2 - d^2)
  const double lens = 2.0 * radius * radius * std::acos(0.6) - 0.75 * 2.0;
  EXPECT_NEAR(shape.volume, 2.0 * pi * radius * radius - lens, 1e-6 * shape.volume);
  EXPECT_DOUBLE_EQ(shape.mass, 20.0 * shape.volume);
  expect_sound_frozen_particles(shape, plane_layer.number_density);
  for (const auto& point : shape.frozen) {
    EXPECT_NEAR(depth_in_union(point.offset, shape.balls), point.depth, 2e-9);
    EXPECT_LT(point.depth, 1.0);
  }
  // The parts of both rings that lie in the other ball are gone: FPs match the area of the filled layer.
  double area = 0.0;
  const double cell = 1.0 / 128.0;
  for (double x = -2.5; x < 2.5; x += cell)
    for (double y = -2.5; y < 2.5; y += cell) {
      const double depth = depth_in_union<2>({{x, y}}, shape.balls);
      if (depth > 0.0 && depth < 3 * dx) area += cell * cell;
    }
  const double expected = area / (dx * dx);
  EXPECT_NEAR(static_cast<double>(shape.frozen.size()), expected, 0.1 * expected);  // ring ends at the seam
}

TEST(MakeBody, mass_and_inertia_of_a_composite_do_not_depend_on_the_spacing) {
  const std::vector<Ball<3>> balls{{{{0.0, 0.0, 0.0}}, 0.5, 0.5}, {{{0.5, 0.0, 0.0}}, 0.5, 0.5}};
  const auto coarse = make_body<3, WendlandC2>(balls, 2.0, {0.5, 8.0});
  const auto fine = make_body<3, WendlandC2>(balls, 2.0, {0.125, 512.0});
  EXPECT_EQ(coarse.mass, fine.mass);
  EXPECT_EQ(coarse.inverse_inertia, fine.inverse_inertia);
}

TEST(MakeBody, no_layer_no_frozen_particles) {
  const std::vector<Ball<2>> balls{{{{-0.3, 0.0}}, 0.5, 0.5}, {{{0.3, 0.0}}, 0.5, 0.5}};
  EXPECT_TRUE((make_body<2, WendlandC2>(balls, 2.0, {1e-6, 1e12, 0.0}).frozen.empty()));
}

TEST(MakeBody, equal_halves_do_not_stand_twice_in_the_seam) {
  const std::vector<Ball<3>> balls{{{{-0.9, 0.0, 0.0}}, 1.25, 1.25}, {{{0.9, 0.0, 0.0}}, 1.25, 1.25}};
  const auto shape = make_body<3, WendlandC2>(balls, 50.0, space_layer);
  for (std::size_t a = 0; a < shape.frozen.size(); ++a)
    for (std::size_t b = a + 1; b < shape.frozen.size(); ++b)
      EXPECT_GT(length_of(shape.frozen[a].offset - shape.frozen[b].offset), 1e-6);
}

TEST(MakeBody, ring_points_in_the_seam_itself_stand_once) {
  // The outer ring of R = 2.4 dx has 12 FPs, and that at 60 degrees lies half its radius of 1.9 dx out: in the seam.
  const double radius = 2.4 * dx, half = 0.95 * dx;
  const auto shape =
      make_body<2, WendlandC2>({{{{-half, 0.0}}, radius, radius}, {{{half, 0.0}}, radius, radius}}, 20.0, plane_layer);
  int in_seam = 0;
  for (const auto& point : shape.frozen)
    if (std::fabs(point.offset[0]) < 1e-9 && point.depth < dx) ++in_seam;
  EXPECT_EQ(in_seam, 2);  // one above, one below
}

TEST(MakeBody, rings_stand_with_a_gap_behind_an_fp) {
  const auto shape = make_body<2, WendlandC2>({{{}, 2.5, 2.5}}, 30.0, plane_layer);
  std::vector<double> first_angle;
  for (const auto& point : shape.frozen)
    if (first_angle.size() == static_cast<std::size_t>(point.depth / dx))
      first_angle.push_back(std::atan2(point.normal[1], point.normal[0]));
  ASSERT_EQ(first_angle.size(), 3u);
  EXPECT_EQ(first_angle[0], 0.0);
  EXPECT_NEAR(first_angle[1], pi / 41.0, 1e-15);  // half of a step: 2 pi 6.5 = 40.8 FPs
  EXPECT_EQ(first_angle[2], 0.0);
}

/// Density that an FP sees: its own body as a continuum, and a fine lattice of fluid outside.
template <int D, class Kernel>
double density_in_surroundings(const Shape<D>& shape, const FrozenParticle<D>& point, double number_density) {
  const int nodes = 20;  // per cutoff
  const double cell = 1.0 / nodes;
  double outside = 0.0, whole = 0.0;
  const int layers = D == 3 ? nodes : 0;
  for (int i = -nodes; i <= nodes; ++i)
    for (int j = -nodes; j <= nodes; ++j)
      for (int k = -layers; k <= layers; ++k) {
        Vec<D, double> step;
        step[0] = (i + 0.5) * cell;
        step[1] = (j + 0.5) * cell;
        if constexpr (D == 3) step[2] = (k + 0.5) * cell;
        if (dot(step, step) >= 1.0) continue;
        const double weight = Kernel::weight(length_of(step));
        whole += weight;
        outside += weight * (1.0 - coverage(depth_in_union(point.offset + step, shape.balls), cell));
      }
  return point.own_density + number_density * outside / whole;
}

TEST(OwnDensity, completes_the_rest_density_about_a_body) {
  // Two quadratures of a smooth integral, 1/20 and 1/32 of the cutoff: within half a per cent.
  const auto disc = make_body<2, WendlandC2>({{{}, 1.25, 1.25}}, 10.0, plane_layer);
  const auto sphere = make_body<3, WendlandC2>({{{}, 1.25, 1.25}}, 10.0, space_layer);
  const std::vector<Ball<2>> pair{{{{-0.8, 0.0}}, 1.25, 1.25}, {{{0.8, 0.0}}, 0.9, 0.9}};
  const auto composite = make_body<2, WendlandC2>(pair, 10.0, plane_layer);
  for (std::size_t i = 0; i < 30; ++i) {
    const auto near = [](double rho, double rest) { EXPECT_NEAR(rho, rest, 5e-3 * rest); };
    const auto pick = [&](const auto& shape) { return shape.frozen[i * (shape.frozen.size() - 1) / 29]; };
    near(density_in_surroundings<2, WendlandC2>(disc, pick(disc), plane_layer.number_density),
         plane_layer.number_density);
    near(density_in_surroundings<3, WendlandC2>(sphere, pick(sphere), space_layer.number_density),
         space_layer.number_density);
    near(density_in_surroundings<2, WendlandC2>(composite, pick(composite), plane_layer.number_density),
         plane_layer.number_density);
  }
}

TEST(MakeBody, large_sphere_has_one_own_density_a_shell) {
  const double R = 16.0 / 3.0;
  const auto shape = make_body<3, WendlandC2>({{{}, R, R}}, 100.0, {1.0 / 3.0, 27.0});
  const double inner = R - 1.0;
  EXPECT_NEAR(static_cast<double>(shape.frozen.size()), 36.0 * pi * (R * R * R - inner * inner * inner), 1.5);
  double density_at[3] = {};
  for (const auto& point : shape.frozen) {
    double& known = density_at[static_cast<int>(point.depth * 3.0)];
    if (known == 0.0) known = point.own_density;
    EXPECT_EQ(point.own_density, known);
  }
  EXPECT_LT(density_at[0], density_at[1]);
  EXPECT_LT(density_at[1], density_at[2]);
}

template <class Kernel>
class WallTest : public ::testing::Test {};
using Kernels = ::testing::Types<WendlandC2, Lucy, MpsWeight>;
TYPED_TEST_SUITE(WallTest, Kernels);

TYPED_TEST(WallTest, piece_of_a_thick_wall) {
  const auto shape = make_wall_piece<2, TypeParam>(1, {4 * dx, 10 * dx}, {dx, dx}, plane_layer);
  EXPECT_TRUE(shape.balls.empty());
  EXPECT_FALSE(shape.rotates);
  EXPECT_DOUBLE_EQ(shape.volume, 40.0 * dx * dx);
  EXPECT_DOUBLE_EQ(shape.mass, 40.0);
  EXPECT_DOUBLE_EQ(shape.reach, 0.5 * dx * std::hypot(4.0, 10.0));
  ASSERT_EQ(shape.frozen.size(), 24u);  // 4 columns, 2 faces, depths 1/2, 3/2 and 5/2 dx: 7/2 dx is above rcut
  for (const auto& point : shape.frozen) {
    EXPECT_NEAR(point.depth, 5 * dx - std::fabs(point.offset[1]), 1e-14);
    EXPECT_EQ(point.normal, (Vec<2, double>{{0.0, point.offset[1] > 0.0 ? 1.0 : -1.0}}));
    const double column = point.offset[0] / dx + 2.0;  // 1/2, 3/2, 5/2, 7/2
    EXPECT_NEAR(column - std::floor(column), 0.5, 1e-12);
  }
}

TYPED_TEST(WallTest, own_density_goes_from_half_to_full) {
  const double fine = 1.0 / 64.0;
  FrozenLayer layer{fine, 4096.0};
  layer.thickness = 1.5;
  const auto shape = make_wall_piece<2, TypeParam>(0, {4.0, fine}, {fine, fine}, layer);
  ASSERT_EQ(shape.frozen.size(), 2u * 96u);
  const auto& at_face = shape.frozen[0];
  const auto& next = shape.frozen[1];
  EXPECT_EQ(at_face.depth, 0.5 * fine);
  // Continued to depth 0 along the line through the first two FPs. Half by symmetry; the line's error is
  // curvature, largest for the MPS weight, whose slope is infinite there.
  EXPECT_NEAR((1.5 * at_face.own_density - 0.5 * next.own_density) / 4096.0, 0.5, 5e-3);
  for (const auto& point : shape.frozen)
    if (point.depth > 1.02) {
      EXPECT_EQ(point.own_density, 4096.0) << point.depth;  // the quadrature's cell reaches 1/64 beyond the cutoff
    }
  for (std::size_t i = 1; i < 96; ++i) EXPECT_GE(shape.frozen[i].own_density, shape.frozen[i - 1].own_density);
}

TYPED_TEST(WallTest, an_end_takes_what_lies_beyond_it) {
  const double fine = 1.0 / 32.0;
  FrozenLayer layer{fine, 1024.0};
  layer.thickness = 3.0;
  const std::array<double, 2> sides{4.0, 4.0}, spacing{fine, fine};
  const auto whole = make_wall_piece<2, TypeParam>(1, sides, spacing, layer);
  const auto ended = make_wall_piece<2, TypeParam>(1, sides, spacing, layer, {.below = {true, false}});
  const auto mirrored = make_wall_piece<2, TypeParam>(1, sides, spacing, layer, {.above = {true, false}});
  ASSERT_EQ(ended.frozen.size(), 128u * 128u);
  const auto at = [](const Shape<2>& shape, int column, int row) { return shape.frozen[128 * row + column]; };
  for (int row = 0; row < 128; row += 9)
    for (int column = 0; column < 128; ++column) {
      const auto point = at(ended, column, row);
      EXPECT_EQ(point.depth, at(whole, column, row).depth);
      EXPECT_EQ(point.normal, at(whole, column, row).normal);
      EXPECT_NEAR(point.own_density, at(mirrored, 127 - column, row).own_density, 1e-9);  // another order of the sum
      const double continued = at(whole, column, row).own_density;
      if (column >= 33) {
        EXPECT_EQ(point.own_density, continued);
      } else if (column < 30) {
        EXPECT_LT(point.own_density, continued);
      }
    }
  // The FP at half a spacing from end and face sees a quarter: it is symmetric in the two, and far from one as a plane
  // surface is from the other.
  EXPECT_EQ(at(ended, 64, 0).own_density, at(whole, 0, 0).own_density);
  EXPECT_NEAR(at(ended, 0, 64).own_density, at(whole, 64, 0).own_density, 0.01 * 1024.0);
  const double face = at(whole, 0, 0).own_density / 1024.0;
  EXPECT_NEAR(at(ended, 0, 0).own_density / 1024.0, face * face, 0.02);  // exact for a product of profiles
}

TYPED_TEST(WallTest, ends_along_two_axes_take_what_lies_beyond_either) {
  const double fine = 1.0 / 6.0;
  FrozenLayer layer{fine, 216.0};
  layer.thickness = 1.5;
  const std::array<double, 3> sides{3.0, 3.0, 3.0}, spacing{fine, fine, fine};
  const auto first = make_wall_piece<3, TypeParam>(1, sides, spacing, layer, {.below = {true, false, false}});
  const auto second = make_wall_piece<3, TypeParam>(1, sides, spacing, layer, {.above = {false, false, true}});
  const auto both = make_wall_piece<3, TypeParam>(1, sides, spacing, layer,
                                                  {.below = {true, false, false}, .above = {false, false, true}});
  ASSERT_EQ(both.frozen.size(), 18u * 18u * 18u);
  const auto density = [](const Shape<3>& shape, int x, int y, int z) {
    return shape.frozen[18 * (18 * z + y) + x].own_density;
  };
  for (int i = 0; i < 18; ++i) {
    EXPECT_EQ(density(both, i, 0, 5), density(first, i, 0, 5));  // farther than the range from the end along z
    EXPECT_NEAR(density(both, 9, 0, i), density(second, 9, 0, i), 0.005 * 216.0);      // but for the quadrature
    EXPECT_NEAR(density(both, 12, 0, 17 - i), density(both, i, 0, 5), 0.005 * 216.0);  // likewise, alike
  }
  // Half a spacing from the face and from both ends: in product form, as each surface is to the two others.
  const double face = density(both, 9, 0, 9) / 216.0;
  EXPECT_NEAR(density(both, 0, 0, 17) / 216.0, face * face * face, 0.02);
}

TEST(MakeWallPiece, thin_wall_has_one_middle_sheet_and_sees_both_faces) {
  const auto shape = make_wall_piece<3, WendlandC2>(2, {2 * dx, dx, 3 * dx}, {dx, dx, dx}, space_layer);
  ASSERT_EQ(shape.frozen.size(), 6u);
  for (const auto& point : shape.frozen) {
    const double z = point.offset[2];
    EXPECT_NEAR(point.depth, 1.5 * dx - std::fabs(z), 1e-14);
    EXPECT_NEAR(std::fabs(z), std::fabs(z) < 0.1 ? 0.0 : dx, 1e-14);
    EXPECT_LT(point.own_density, 0.95 * space_layer.number_density);  // fluid on both sides is within reach
  }
}

TEST(MakeWallPiece, wall_of_two_sheets_has_one_to_each_face) {
  const auto shape = make_wall_piece<2, WendlandC2>(0, {2 * dx, dx}, {dx, dx}, plane_layer);
  ASSERT_EQ(shape.frozen.size(), 2u);
  for (const auto& point : shape.frozen) {
    EXPECT_EQ(point.depth, 0.5 * dx);
    EXPECT_EQ(point.normal, (Vec<2, double>{{point.offset[0] < 0.0 ? -1.0 : 1.0, 0.0}}));
  }
  EXPECT_EQ(shape.frozen[0].own_density, shape.frozen[1].own_density);
}

TEST(MakeWallPiece, spacing_is_fitted_to_the_sides) {
  const auto shape = make_wall_piece<2, WendlandC2>(1, {1.0, 1.0}, {0.3, 0.3}, {0.3, 1.0 / 0.09});
  ASSERT_EQ(shape.frozen.size(), 9u);
  EXPECT_NEAR(shape.frozen[0].offset[0], -1.0 / 3.0, 1e-15);
  EXPECT_NEAR(shape.frozen[0].depth, 1.0 / 6.0, 1e-15);
}

}  // namespace
}  // namespace mappm
