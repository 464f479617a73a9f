// Oracle: values worked by hand.
#include "base/vec.hpp"

#include <gtest/gtest.h>

namespace mappm {
namespace {

TEST(Vec, arithmetic) {
  const Vec<3, int> a{{1, -2, 3}};
  const Vec<3, int> b{{4, 5, 6}};
  EXPECT_EQ(a + b, (Vec<3, int>{{5, 3, 9}}));
  EXPECT_EQ(a - b, (Vec<3, int>{{-3, -7, -3}}));
  EXPECT_EQ(-a, (Vec<3, int>{{-1, 2, -3}}));
  EXPECT_EQ(2 * a, (Vec<3, int>{{2, -4, 6}}));
  EXPECT_FALSE(a == b);
  EXPECT_EQ(dot(a, b), 12);
}

TEST(Vec, products_of_rotation) {
  EXPECT_EQ((cross<2, int>({{1, 2}}, {{3, 4}})), (Vec<1, int>{{-2}}));
  EXPECT_EQ((cross<3, int>({{1, 2, 3}}, {{4, 5, 6}})), (Vec<3, int>{{-3, 6, -3}}));
  EXPECT_EQ((rotational_velocity<2, int>({{2}}, {{3, 4}})), (Vec<2, int>{{-8, 6}}));
  EXPECT_EQ((rotational_velocity<3, int>({{0, 0, 2}}, {{3, 4, 5}})), (Vec<3, int>{{-8, 6, 0}}));
}

}  // namespace
}  // namespace mappm
