// Oracle: values worked by hand.
#include "physics/step_limit.hpp"

#include <gtest/gtest.h>

namespace mappm {
namespace {

TEST(WaveLimit, is_h_over_c_where_instability_is_far) {
  const StepLimit limit = wave_limit(0.5, 2.0, 1.375, 1.375);  // h / c = 1/4
  EXPECT_EQ(limit.of, "sound");                                // 0.8 * 1.375 > 1
  EXPECT_DOUBLE_EQ(limit.usual, 0.25);
  EXPECT_DOUBLE_EQ(limit.doubtful, 0.275);  // 0.8 * 1.375 / 4
  EXPECT_DOUBLE_EQ(limit.last, 0.34375);    // 1.375 / 4
}

TEST(WaveLimit, keeps_its_distance_from_instability_and_names_its_cause) {
  const StepLimit viscous = wave_limit(0.5, 2.0, 0.5, 1.375);
  EXPECT_EQ(viscous.of, "viscosity");
  EXPECT_DOUBLE_EQ(viscous.usual, 0.1);  // 0.8 * 0.5 / 4
  EXPECT_DOUBLE_EQ(viscous.doubtful, viscous.usual);
  EXPECT_DOUBLE_EQ(viscous.last, 0.125);
  EXPECT_EQ(wave_limit(0.5, 2.0, 0.5, 1.0).of, "shift");  // it would be near without viscosity too
}

TEST(LightSolidLimit, by_hand) {
  // Gamma = 4 (3.1 * 0.25 / 0.5 + 0.083 * 10 * 2) = 4 (1.55 + 1.66) = 12.84; 2 M / Gamma
  const StepLimit limit = light_solid_limit({2, 6.42, 4.0}, 0.5, 2.0, 0.25, 10.0);
  EXPECT_EQ(limit.of, "added mass");
  EXPECT_DOUBLE_EQ(limit.last, 1.0);
  EXPECT_DOUBLE_EQ(limit.usual, 0.7);
  EXPECT_DOUBLE_EQ(limit.doubtful, 0.8);
}

TEST(LightSolidLimit, a_body_that_turns_by_hand) {
  // 2 I / (R^2 Gamma_mu), Gamma_mu = 4 * 1.55 = 6.2; in space Gamma_mu = 4 * 3.4 / 2 = 6.8, of which 2 / 3 count
  EXPECT_DOUBLE_EQ(light_solid_limit({2, 6.42, 4.0, 1.55}, 0.5, 2.0, 0.25, 10.0).last, 0.5);
  EXPECT_DOUBLE_EQ(light_solid_limit({3, 6.42, 4.0, 1.7}, 0.5, 2.0, 0.25, 10.0).last, 0.75);
}

TEST(LightSolidLimit, without_viscosity_turning_does_not_limit) {
  EXPECT_DOUBLE_EQ(light_solid_limit({2, 3.32, 4.0, 0.01}, 0.5, 2.0, 0.0, 10.0).last, 1.0);  // Gamma = 4 * 1.66
}

TEST(ForceLimit, by_hand) {
  const StepLimit limit = force_limit(0.5, 0.5);
  EXPECT_EQ(limit.usual, 0.25);  // 0.25 * sqrt(1)
  EXPECT_EQ(limit.doubtful, 0.25);
  EXPECT_EQ(limit.last, 0.5);
  EXPECT_EQ(force_limit(0.5, 0.0).usual, HUGE_VAL);
  EXPECT_EQ(force_limit(0.5, 0.0).last, HUGE_VAL);
}

TEST(ContactLimit, by_hand) {
  const StepLimit limit = contact_limit(0.4);
  EXPECT_DOUBLE_EQ(limit.usual, 0.02);  // 0.4 / 20
  EXPECT_DOUBLE_EQ(limit.doubtful, 0.02);
  EXPECT_DOUBLE_EQ(limit.last, 0.04);
  EXPECT_EQ(contact_limit(0.0).usual, HUGE_VAL);
}

TEST(StepLimits, the_shortest_usual_step_rules) {
  StepLimits limits;
  EXPECT_EQ(limits.ruling().usual, HUGE_VAL) << "nothing limits";
  limits.waves = {"sound", 1.0, 1.1, 1.2};
  EXPECT_EQ(limits.ruling().of, "sound");
  limits.light_solids = {"added mass", 0.9, 1.15, 1.3};
  limits.force = {"force", 3.0, 3.0, 6.0};
  EXPECT_EQ(limits.ruling().of, "added mass");
  limits.contact = {"contact", 0.7, 0.7, 1.4};
  EXPECT_EQ(limits.ruling().of, "contact");
}

TEST(StepLimits, a_growing_step_passes_the_lowest_border_first) {
  StepLimits limits;
  limits.waves = {"sound", 1.0, 1.1, 1.2};
  limits.light_solids = {"added mass", 0.9, 1.05, 1.3};
  EXPECT_EQ(limits.first(&StepLimit::doubtful).of, "added mass");
  EXPECT_EQ(limits.first(&StepLimit::last).of, "sound");
}

TEST(SoundSpeedRule, takes_the_largest_of_three_scales) {
  EXPECT_DOUBLE_EQ(sound_speed_rule(10.0, 3.0, 1.0, 2.0, 0.5, 1.0), 30.0);   // U^2 = 9
  EXPECT_DOUBLE_EQ(sound_speed_rule(10.0, 0.0, -8.0, 2.0, 1.0, 1.0), 40.0);  // |g| L = 16
  EXPECT_DOUBLE_EQ(sound_speed_rule(20.0, 2.0, 0.0, 0.0, 4.5, 1.0), 120.0);  // 4 nu U / R = 36
  EXPECT_DOUBLE_EQ(sound_speed_rule(10.0, 3.0, 0.0, 0.0, 1.0, 0.0), 30.0);   // no solid: no third scale
}

}  // namespace
}  // namespace mappm
