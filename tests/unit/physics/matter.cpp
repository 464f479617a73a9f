// Oracles: closed forms of discs, spheres and half spaces, and symmetry.
#include "physics/matter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/kernel.hpp"

namespace mappm {
namespace {

constexpr double pi = 3.14159265358979323846;

TEST(Coverage, by_hand) {
  EXPECT_EQ(coverage(0.0, 0.5), 0.5);
  EXPECT_EQ(coverage(0.125, 0.5), 0.75);
  EXPECT_EQ(coverage(0.3, 0.5), 1.0);
  EXPECT_EQ(coverage(-0.3, 0.5), 0.0);
}

TEST(DepthInUnion, is_that_of_the_ball_in_which_the_point_is_deepest) {
  const std::vector<Ball<2>> balls{{{{0.0, 0.0}}, 2.0, 2.0}, {{{3.0, 0.0}}, 1.5, 1.5}};
  EXPECT_EQ(depth_in_union<2>({{0.0, 1.0}}, balls), 1.0);
  EXPECT_EQ(depth_in_union<2>({{2.5, 0.0}}, balls), 1.0);
  EXPECT_EQ(depth_in_union<2>({{0.0, 5.0}}, balls), -3.0);
}

TEST(IntegrateUnion, disc_and_sphere_against_their_closed_forms) {
  const std::vector<Ball<2>> disc{{{{0.3, -0.2}}, 2.0, 2.0}};
  const auto plane = integrate_union(disc);
  EXPECT_NEAR(plane.volume, 4.0 * pi, 1e-8 * 4.0 * pi);
  EXPECT_NEAR(plane.centre[0], 0.3, 1e-12);  // nodes lie evenly about the body: exact by symmetry
  EXPECT_NEAR(plane.centre[1], -0.2, 1e-12);
  EXPECT_NEAR(plane.second[0][0], 4.0 * pi, 1e-8 * 4.0 * pi);  // pi R^4 / 4
  EXPECT_NEAR(inverse_inertia(plane, 0.5)[0], 1.0 / (4.0 * pi), 1e-8 / (4.0 * pi));

  const std::vector<Ball<3>> sphere{{{{0.0, 0.0, 0.0}}, 1.0, 1.0}};
  const auto space = integrate_union(sphere);
  EXPECT_NEAR(space.volume, 4.0 / 3.0 * pi, 1e-8 * 4.0);
  const double inertia = 2.0 * 0.4 * 4.0 / 3.0 * pi;  // density 2
  const auto inverse = inverse_inertia(space, 2.0);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(inverse[4 * a], 1.0 / inertia, 1e-8 / inertia);
  EXPECT_NEAR(inverse[1], 0.0, 1e-12);
}

TEST(IntegrateUnion, two_separate_spheres_follow_the_theorem_of_parallel_axes) {
  const std::vector<Ball<3>> balls{{{{-2.0, 0.0, 0.0}}, 1.0, 1.0}, {{{2.0, 0.0, 0.0}}, 1.0, 1.0}};
  const auto moments = integrate_union(balls);
  const double volume = 8.0 / 3.0 * pi;
  EXPECT_NEAR(moments.volume, volume, 1e-8 * volume);
  const auto inverse = inverse_inertia(moments, 1.0);
  EXPECT_NEAR(inverse[0] * (0.4 * volume), 1.0, 1e-8);          // about the line of centres
  EXPECT_NEAR(inverse[4] * ((0.4 + 4.0) * volume), 1.0, 1e-8);  // across it: + m d^2
  EXPECT_NEAR(inverse[8] * ((0.4 + 4.0) * volume), 1.0, 1e-8);
}

TEST(IntegrateUnion, overlap_counts_once) {
  // Two discs of radius 1 at distance 1: 2 pi - lens, lens = 2 pi / 3 - sqrt(3) / 2.
  const std::vector<Ball<2>> discs{{{{0.0, 0.0}}, 1.0, 1.0}, {{{1.0, 0.0}}, 1.0, 1.0}};
  const double area = 2.0 * pi - (2.0 * pi / 3.0 - std::sqrt(3.0) / 2.0);
  const auto plane = integrate_union(discs);
  EXPECT_NEAR(plane.volume, area, 1e-8 * area);
  EXPECT_NEAR(plane.centre[0], 0.5, 1e-12);
  // Two spheres of radius R at distance R: lens pi (4 R + R) (2 R - R)^2 / 12. A third one inside them adds nothing.
  const std::vector<Ball<3>> spheres{
      {{{0.0, 0.0, 0.0}}, 0.5, 0.5}, {{{0.5, 0.0, 0.0}}, 0.5, 0.5}, {{{0.25, 0.0, 0.0}}, 0.2, 0.2}};
  const double volume = 2.0 * 4.0 / 3.0 * pi * 0.125 - pi * 2.5 * 0.25 / 12.0;
  EXPECT_NEAR(integrate_union(spheres).volume, volume, 1e-8 * volume);
}

TEST(IntegrateUnion, does_not_depend_on_the_place_or_the_order_of_the_balls) {
  const std::vector<Ball<3>> balls{{{{0.0, 0.0, 0.0}}, 0.5, 0.5}, {{{0.3, 0.2, 0.1}}, 0.4, 0.4}};
  std::vector<Ball<3>> others{balls[1], balls[0]};
  for (Ball<3>& ball : others) ball.offset += Vec<3, double>{{1000.0, -2000.0, 3000.0}};
  const auto one = integrate_union(balls), other = integrate_union(others);
  EXPECT_NEAR(other.volume, one.volume, 1e-9);
  EXPECT_NEAR(other.centre[2] - 3000.0, one.centre[2], 1e-9);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(other.second[a][a], one.second[a][a], 1e-9);
}

TEST(IntegrateUnion, three_spheres_that_meet_in_a_point_turn_with_their_axes) {
  // Where three surfaces meet a slice changes its form without an end of a panel: the stated error. Sliced along other
  // axes the body is the same.
  const std::vector<Ball<3>> balls{
      {{{0.0, 0.0, 0.0}}, 0.5, 0.5}, {{{0.3, 0.2, 0.1}}, 0.4, 0.4}, {{{-0.1, 0.4, 0.2}}, 0.45, 0.45}};
  std::vector<Ball<3>> turned = balls;
  for (Ball<3>& ball : turned) ball.offset = {{ball.offset[1], ball.offset[2], ball.offset[0]}};
  const auto one = integrate_union(balls), other = integrate_union(turned);
  EXPECT_NEAR(other.volume, one.volume, 1e-6 * one.volume);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(other.second[a][a], one.second[(a + 1) % 3][(a + 1) % 3], 1e-6);
}

TEST(IntegrateUnion, many_balls_take_no_longer_than_the_bound) {
  // A rod of touching balls: n times the ball, by the closed form. Its ends of panels are more than are kept.
  std::vector<Ball<3>> rod;
  for (int i = 0; i < 200; ++i) rod.push_back({{{0.0, 0.0, 0.125 * i}}, 0.0625, 0.0625});
  const double volume = 200.0 * 4.0 / 3.0 * pi * 0.0625 * 0.0625 * 0.0625;
  EXPECT_NEAR(integrate_union(rod).volume, volume, 1e-4 * volume);
}

TEST(Direction, covers_the_sphere_evenly) {
  const int n = 500;
  Vec<3, double> sum;
  double second = 0.0;
  for (int i = 0; i < n; ++i) {
    const Vec<3, double> unit = direction<3>(i, n);
    EXPECT_NEAR(dot(unit, unit), 1.0, 1e-14);
    sum += unit;
    second += unit[0] * unit[0] / n;
  }
  EXPECT_LT(std::sqrt(dot(sum, sum)) / n, 2e-3);  // of order 1/n
  EXPECT_NEAR(second, 1.0 / 3.0, 2e-3);
}

/// Share of W's integral behind a plane at `depth` below which the point lies, by sums over planes: the oracle.
template <class Kernel, int D>
double share_behind_plane(double depth) {
  const int n = 2000;
  double inside = 0.0, whole = 0.0;
  for (int i = 0; i < n; ++i) {  // slices of the ball at height z, integrated over rings of radius s
    const double z = -1.0 + (i + 0.5) * 2.0 / n;
    double slice = 0.0;
    const int rings = 400;
    const double edge = std::sqrt(1.0 - z * z);
    for (int k = 0; k < rings; ++k) {
      const double s = (k + 0.5) * edge / rings;
      slice += Kernel::weight(std::min(1.0, std::hypot(s, z))) * (D == 3 ? s : 1.0) * edge / rings;
    }
    whole += slice;
    if (z < depth) inside += slice;
  }
  return inside / whole;
}

template <class Kernel>
class SupportQuadratureTest : public ::testing::Test {};
using Kernels = ::testing::Types<WendlandC2, Lucy, MpsWeight>;
TYPED_TEST_SUITE(SupportQuadratureTest, Kernels);

template <int D, class Kernel>
void expect_half_space_shares() {
  const auto quadrature = SupportQuadrature<D>::of(Kernel{});
  Vec<D, double> normal;
  normal[0] = 0.6;
  normal[1] = 0.8;
  const auto share = [&](double depth) {
    const auto depth_at = [&](const Vec<D, double>& x) { return depth - dot(x, normal); };
    return quadrature.inside_share(Vec<D, double>{}, depth_at);
  };
  EXPECT_NEAR(share(0.0), 0.5, 1e-14);  // by the symmetry of the directions
  EXPECT_EQ(share(1.1), 1.0);
  EXPECT_EQ(share(-1.1), 0.0);
  for (const double depth : {-0.5, -0.2, 0.15, 0.45, 0.8}) {
    // some hundred directions; the weight's singularity makes the MPS oracle itself coarse
    EXPECT_NEAR(share(depth), (share_behind_plane<Kernel, D>(depth)), 3e-3) << depth;
  }
}

TYPED_TEST(SupportQuadratureTest, half_spaces_against_slices) {
  expect_half_space_shares<2, TypeParam>();
  expect_half_space_shares<3, TypeParam>();
}

}  // namespace
}  // namespace mappm
