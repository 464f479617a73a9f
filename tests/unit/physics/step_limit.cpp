// Oracle: values worked by hand.
#include "physics/step_limit.hpp"

#include <gtest/gtest.h>

namespace mappm {
namespace {

TEST(StepLimits, by_hand) {
  const StepLimits limits = step_limits(0.5, 2.0, 0.25, 0.5, 0.4);
  EXPECT_EQ(limits.acoustic, 0.0625);      // 0.25 * 0.5 / 2
  EXPECT_EQ(limits.viscous, 0.125);        // 0.125 * 0.25 / 0.25
  EXPECT_EQ(limits.body_force, 0.25);      // 0.25 * sqrt(1)
  EXPECT_DOUBLE_EQ(limits.contact, 0.02);  // 0.4 / 20
  EXPECT_DOUBLE_EQ(limits.smallest(), 0.02);
}

TEST(StepLimits, an_absent_term_does_not_limit) {
  const StepLimits limits = step_limits(0.5, 2.0, 0.0, 0.0, 0.0);
  EXPECT_EQ(limits.viscous, HUGE_VAL);
  EXPECT_EQ(limits.body_force, HUGE_VAL);
  EXPECT_EQ(limits.contact, HUGE_VAL);
  EXPECT_EQ(limits.smallest(), limits.acoustic);
}

TEST(SoundSpeedRule, takes_the_largest_of_three_scales) {
  EXPECT_DOUBLE_EQ(sound_speed_rule(10.0, 3.0, 1.0, 2.0, 1.0, 1.0), 30.0);   // U^2 = 9
  EXPECT_DOUBLE_EQ(sound_speed_rule(10.0, 0.0, -8.0, 2.0, 1.0, 1.0), 40.0);  // |g| L = 16
  EXPECT_DOUBLE_EQ(sound_speed_rule(20.0, 2.0, 0.0, 0.0, 4.5, 1.0), 60.0);   // nu U / R = 9
  EXPECT_DOUBLE_EQ(sound_speed_rule(10.0, 3.0, 0.0, 0.0, 1.0, 0.0), 30.0);   // no solid: no third scale
}

}  // namespace
}  // namespace mappm
