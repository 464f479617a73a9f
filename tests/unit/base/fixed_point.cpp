// Oracles: values worked by hand, and std::nearbyint (ties to even in the default rounding mode).
#include "base/fixed_point.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/lanes.hpp"

namespace mappm {
namespace {

TEST(ToFixed, rounds_ties_to_even) {
  EXPECT_EQ(to_fixed(0.5), 0);
  EXPECT_EQ(to_fixed(1.5), 2);
  EXPECT_EQ(to_fixed(2.5), 2);
  EXPECT_EQ(to_fixed(-0.5), 0);
  EXPECT_EQ(to_fixed(-1.5), -2);
  EXPECT_EQ(to_fixed(-2.5), -2);
  EXPECT_EQ(to_fixed(0.49999999999999994), 0);
}

TEST(ToFixed, is_exact_up_to_its_range_and_tells_when_beyond) {
  EXPECT_EQ(to_fixed(fixed_range - 1.0), (std::int64_t{1} << 51) - 1);
  EXPECT_EQ(to_fixed(1.0 - fixed_range), 1 - (std::int64_t{1} << 51));
  for (const double beyond : {fixed_range, 1.5 * fixed_range, 1e20, 1e300, HUGE_VAL}) {
    EXPECT_GE(to_fixed(beyond), std::int64_t{1} << 51) << beyond;
    EXPECT_LE(to_fixed(-beyond), -(std::int64_t{1} << 51)) << beyond;
  }
}

TEST(ToFixed, is_the_nearest_integer_and_the_same_in_lanes) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> scale(0.0, 50.9);
  std::uniform_real_distribution<double> sign(-1.0, 1.0);
  for (int i = 0; i < 20000; ++i) {
    double x = sign(random) * std::exp2(scale(random));
    if (i % 4 == 0) x = std::floor(x) + 0.5;  // ties, as far as a half can be held
    EXPECT_EQ(static_cast<double>(to_fixed(x)), std::nearbyint(x)) << x;
    const IntLanes lanes = to_fixed(Lanes(x));
    for (int lane = 0; lane < lane_count; ++lane) EXPECT_EQ(lanes[lane], to_fixed(x)) << x;
  }
}

TEST(ToFixedWide, goes_on_where_one_word_ends) {
  EXPECT_TRUE(to_fixed_wide(2.5) == 2);
  EXPECT_TRUE(to_fixed_wide(-3.5) == -4);
  EXPECT_TRUE(to_fixed_wide(-0.25) == 0);
  EXPECT_TRUE(to_fixed_wide(box_quanta + 1.0) == (Int128{1} << 52) + 1);
  EXPECT_TRUE(to_fixed_wide(-0x1p100) == -(Int128{1} << 100));
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> value(-fixed_range, fixed_range);
  for (int i = 0; i < 20000; ++i) {
    const double x = value(random);
    EXPECT_TRUE(to_fixed_wide(x) == Int128{to_fixed(x)}) << x;
  }
}

TEST(WrapPosition, moves_by_one_box_side_at_most) {
  EXPECT_EQ(wrap_position(-1.0), box_quanta - 1.0);
  EXPECT_EQ(wrap_position(0.0), 0.0);
  EXPECT_EQ(wrap_position(box_quanta), 0.0);
  EXPECT_EQ(wrap_position(box_quanta + 5.0), 5.0);
  EXPECT_EQ(wrap_position(box_quanta - 1.0), box_quanta - 1.0);
}

TEST(NearestDifference, takes_the_nearest_image) {
  EXPECT_EQ(nearest_difference(1.0, box_quanta - 1.0), 2.0);
  EXPECT_EQ(nearest_difference(box_quanta - 1.0, 1.0), -2.0);
  EXPECT_EQ(nearest_difference(10.0, 3.0), 7.0);
  EXPECT_EQ(nearest_difference(0.5 * box_quanta, 0.0), -0.5 * box_quanta);  // half open: [-L/2, L/2)
}

TEST(FixedPoint, a_float_is_rounded_to_nearest_and_beyond_the_range_to_the_lowest_number) {
  EXPECT_EQ(to_fixed(0.5f), 0);
  EXPECT_EQ(to_fixed(1.5f), 2);
  EXPECT_EQ(to_fixed(-2.5f), -2);
  EXPECT_EQ(to_fixed(8388607.5f), 8388608);
  EXPECT_EQ(to_fixed(0x1.fffffep30f), 2147483520);
  constexpr std::int32_t lowest = std::numeric_limits<std::int32_t>::min();
  for (const float beyond : {0x1p31f, -0x1p31f, 1e30f, -1e30f, std::numeric_limits<float>::infinity(),
                             std::numeric_limits<float>::quiet_NaN()})
    EXPECT_EQ(to_fixed(beyond), lowest) << beyond;
}

}  // namespace
}  // namespace mappm
