// Oracles: scalars for the lanes, and whole boxes as images.
#include "parallel/lane_numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "unit/physics/pair_setup.hpp"

namespace mappm {
namespace {

using testing::make_law;

constexpr double rest_density = 10.24;

/// Boxes shorter and longer than the window of positions.
TEST(SingleLanes, see_one_distance_in_lanes_and_alone_whatever_the_image) {
  for (const double side : {2.1, 5.0, 7.9, 8.0, 100.0, 1e5, 1e8}) {
    SCOPED_TRACE(side);
    testing::Fluid<2> fluid = testing::plane_fluid();
    fluid.box = {side, 1.5 * side};
    const SingleLanes<2> single(make_law<2, WendlandC2>(fluid), rest_density);
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int trial = 0; trial < 200; ++trial)
      for (int axis = 0; axis < 2; ++axis) {
        const double cutoff = box_quanta / fluid.box[static_cast<std::size_t>(axis)];
        const double a = std::floor(0.5 * (unit(random) + 1.0) * (box_quanta - 1.0));
        const double b = std::nearbyint(a + unit(random) * cutoff);  // may lie outside the box: a ghost
        const float alone =
            single.difference(axis, nearest_difference(single.seen(axis, a), single.seen(axis, wrap_position(b))));
        EXPECT_EQ(single.difference(axis, single.seen(axis, a) - single.seen(axis, b)), alone);
        const Int32Lanes one(single.coordinate(axis, a)), other(single.coordinate(axis, b));
        EXPECT_EQ(SingleLanes<2>::apart(one, other)[0], alone);
        EXPECT_EQ(single.coordinate(axis, Lanes(b))[0], single.coordinate(axis, b));
        EXPECT_LE(std::fabs(static_cast<double>(alone * single.law().length[axis]) - (a - b) / cutoff), 2e-7);
      }
  }
}

}  // namespace
}  // namespace mappm
