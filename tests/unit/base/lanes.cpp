// Oracle: the scalar function of the same name, lane by lane.
#include "base/lanes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace mappm {
namespace {

std::array<double, lane_count> ramp(double first, double step) {
  std::array<double, lane_count> values{};
  for (int lane = 0; lane < lane_count; ++lane) values[lane] = first + step * lane;
  return values;
}

TEST(Lanes, elementary_functions_are_those_of_double) {
  const auto a = ramp(0.1, 0.7);
  const auto b = ramp(2.0, -0.3);
  const Lanes x = load_lanes(a.data());
  const Lanes y = load_lanes(b.data());
  const Lanes root = square_root(x), large = larger(x, y), small = smaller(x, y);
  for (int lane = 0; lane < lane_count; ++lane) {
    EXPECT_EQ(root[lane], square_root(a[lane]));
    EXPECT_EQ(large[lane], larger(a[lane], b[lane]));
    EXPECT_EQ(small[lane], smaller(a[lane], b[lane]));
  }
}

TEST(Lanes, numbers_and_whole_parts) {
  std::array<std::int32_t, lane_count> whole;
  whole_numbers(lane_numbers() * 2.75 - 0.5, whole.data());
  for (int lane = 0; lane < lane_count; ++lane) {
    EXPECT_EQ(lane_numbers()[lane], lane);
    EXPECT_EQ(whole[lane], static_cast<int>(lane * 2.75 - 0.5));
  }
}

TEST(Lanes, integers_become_real_and_magnitudes_positive) {
  const std::array<std::int64_t, 5> numbers{0, -1, (std::int64_t{1} << 53) + 1, -(std::int64_t{1} << 53) - 3,
                                            std::numeric_limits<std::int64_t>::max()};
  std::array<std::int64_t, lane_count> some{};
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    some[k % lane_count] = numbers[k];
    const Lanes real = real_of(load_lanes(some.data())), size = magnitude(real);
    for (int lane = 0; lane < lane_count; ++lane) {
      EXPECT_EQ(real[lane], real_of(some[lane]));
      EXPECT_EQ(size[lane], magnitude(double{real[lane]}));
    }
  }
}

TEST(Lanes, any_below_looks_at_every_lane) {
  EXPECT_FALSE(any_below(Lanes(1.0), 1.0));
  for (int lane = 0; lane < lane_count; ++lane) {
    Lanes lanes = 1.0;
    lanes[lane] = 0.99;
    EXPECT_TRUE(any_below(lanes, 1.0));
  }
}

TEST(Lanes, store_and_sum_integers) {
  const auto a = ramp(-3.0, 5.0);
  const IntLanes fixed = to_fixed(load_lanes(a.data()));
  std::array<std::int64_t, lane_count> stored{};
  store_lanes(fixed, stored.data());
  for (int lane = 0; lane < lane_count; ++lane) EXPECT_EQ(stored[lane], static_cast<std::int64_t>(a[lane]));
  EXPECT_EQ(sum_of_lanes(fixed), std::accumulate(stored.begin(), stored.end(), std::int64_t{0}));
  const IntLanes again = load_lanes(stored.data());
  for (int lane = 0; lane < lane_count; ++lane) EXPECT_EQ(again[lane], stored[lane]);
}

TEST(Lanes, floats_are_rounded_as_one_by_one) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (const float value : {0.5f, 1.5f, -2.5f, 8388607.5f, 2147483520.0f, -0x1p31f, 0x1p31f, -0x1.1p31f, infinity,
                            -infinity, std::numeric_limits<float>::quiet_NaN()}) {
    for (std::size_t odd = 0; odd < FloatLanes::size(); ++odd) {
      FloatLanes lanes(1.25f);
      lanes[odd] = value;
      const Int32Lanes fixed = to_fixed(lanes);
      for (std::size_t lane = 0; lane < FloatLanes::size(); ++lane)
        EXPECT_EQ(fixed[lane], lane == odd ? to_fixed(value) : 1) << value;
    }
  }
}

TEST(Lanes, sums_of_32_bits_wrap) {
  std::uint32_t sum = 0;
  UInt32Lanes lanes;
  for (std::size_t lane = 0; lane < UInt32Lanes::size(); ++lane) {
    const auto value = static_cast<std::uint32_t>(0xc0000001u + 0x01010101u * lane * lane);
    lanes[lane] = value;
    sum += value;
  }
  EXPECT_EQ(sum_of_lanes(lanes), sum);
}

TEST(Lanes, an_excess_is_shed_at_the_end) {
  const auto a = ramp(-7.4, 3.3);
  const UIntLanes raw = to_fixed_with_excess(load_lanes(a.data()));
  std::uint64_t sum = 0;
  for (int lane = 0; lane < lane_count; ++lane) {
    EXPECT_EQ(raw[lane], to_fixed_with_excess(a[lane]));
    sum += raw[lane];
  }
  EXPECT_EQ(static_cast<std::int64_t>(sum - lane_count * rounding_excess),
            sum_of_lanes(to_fixed(load_lanes(a.data()))));
}

}  // namespace
}  // namespace mappm
