// Oracle: values worked by hand, and the linear profile that the factor continues.
#include "physics/wall.hpp"

#include <gtest/gtest.h>

#include "base/lanes.hpp"

namespace mappm {
namespace {

const Vec<2, double> up{{0.0, 1.0}};

TEST(NoSlipFactor, by_hand) {
  // FP at depth 1/8; PP 1/2 above the FP along the normal: 3/8 above the surface; 1 + (1/8) / (3/8).
  EXPECT_DOUBLE_EQ(no_slip_factor<2>({{0.7, 0.5}}, up, 0.125, 0.05, 11.0), 1.0 + 1.0 / 3.0);
  // in space, normal along x
  const double in_space = no_slip_factor<3, double>({{0.75, 0.2, -0.4}}, {{1.0, 0.0, 0.0}}, 0.25, 0.05, 11.0);
  EXPECT_DOUBLE_EQ(in_space, 1.5);
}

TEST(NoSlipFactor, has_a_least_distance) {
  EXPECT_DOUBLE_EQ(no_slip_factor<2>({{0.0, 0.125}}, up, 0.125, 0.0625, 11.0), 3.0);  // PP on the surface: d_f = dx / 4
  EXPECT_DOUBLE_EQ(no_slip_factor<2>({{0.0, -0.5}}, up, 0.125, 0.0625, 11.0), 3.0);   // PP inside the body
}

TEST(NoSlipFactor, is_never_above_its_bound) {
  const Vec<2, double> near{{0.0, 1.0}};
  EXPECT_EQ(no_slip_factor<2>(near, up, 0.99, 0.0625, 4.0), 4.0);  // 1 + 0.99 / 0.0625 = 16.84
  EXPECT_EQ(no_slip_factor<2>(near, up, 0.99, 0.0625, 8.0), 8.0);
  EXPECT_EQ(no_slip_factor<2>(near, up, 0.99, 0.0625, 1.0), 1.0);  // that of a plain wall
  EXPECT_DOUBLE_EQ(no_slip_factor<2>(near, up, 0.99, 0.0625, 17.0), 16.84);
  EXPECT_DOUBLE_EQ(no_slip_factor<2>({{0.0, 0.5}}, up, 0.375, 0.0625, 4.0), 4.0);  // exactly there: 1 + 3/8 : 1/8
}

TEST(NoSlipFactor, continues_a_linear_profile_through_the_surface) {
  // v = k * height: the PP at 0.3 and the velocity -0.2 k continued to the FP differ by (0.3 + 0.2) k = beta * 0.3 k.
  const double height = 0.3, depth = 0.2, k = 1.7;
  const double beta = no_slip_factor<2>({{0.0, height + depth}}, up, depth, 0.01, 4.0);
  EXPECT_NEAR(beta * (k * height), k * (height + depth), 1e-15);
}

TEST(NoSlipFactor, lanes_have_the_bits_of_double) {
  const Lanes height([](auto lane) { return 0.1 + 0.13 * static_cast<double>(lane); });
  const Vec<2, Lanes> r{{Lanes(0.3), height}};
  const Vec<2, Lanes> normal{{Lanes(0.6), Lanes(0.8)}};
  const Lanes beta = no_slip_factor<2>(r, normal, Lanes(0.17), 0.08, 2.5);
  for (int lane = 0; lane < lane_count; ++lane) {
    const Vec<2, double> one{{0.3, height[lane]}};
    EXPECT_EQ(beta[lane], (no_slip_factor<2, double>(one, {{0.6, 0.8}}, 0.17, 0.08, 2.5)));
  }
}

}  // namespace
}  // namespace mappm
