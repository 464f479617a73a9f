// Oracle: the sums of hand_state.hpp worked by hand.
#include "output/totals.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/single_group.hpp"
#include "unit/output/hand_state.hpp"
#include "unit/output/thread_group.hpp"

namespace mappm {
namespace {

double momentum(Int128 iota) { return static_cast<double>(iota) * velocity_quantum; }

TEST(Totals, are_the_sums_worked_by_hand) {
  State<2> state = hand::state();
  const Totals<2> totals = measure(hand::model(), hand::sample(state), SingleGroup());
  EXPECT_EQ(totals.step, 6u);
  EXPECT_TRUE(totals.fluid_count == 4 && totals.frozen_count == 5);
  EXPECT_TRUE(totals.sp_count == 3 && totals.mobile_count == 2) << "the piece of a wall is no SP";
  EXPECT_EQ(totals.particles(), 9u);
  EXPECT_EQ(momentum(totals.fluid_momentum[0]), 0.5);
  EXPECT_EQ(momentum(totals.fluid_momentum[1]), 0.5);
  EXPECT_EQ(static_cast<double>(totals.mobile_velocity[0]) * mean_velocity_quantum, 0.75);
  EXPECT_EQ(static_cast<double>(totals.mobile_velocity[1]) * mean_velocity_quantum, -0.25);
  EXPECT_EQ(momentum(totals.sp_impulse[0]), 6.0);   // (6-2) + 0 + 2
  EXPECT_EQ(momentum(totals.sp_impulse[1]), -3.0);  // (2-1) - 3 - 1
  EXPECT_EQ(momentum(totals.wall_impulse[0]), 1.0);
  EXPECT_EQ(static_cast<double>(totals.fluid_energy) * energy_quantum, 0.3125);  // (1/4 + 5/16 + 1/16) / 2
  EXPECT_EQ(static_cast<double>(totals.solid_energy) * energy_quantum, 3.0);     // 8 (5/16) + 8 (1/16)
  EXPECT_EQ(static_cast<double>(totals.spin_energy) * energy_quantum, 4.0);      // L^2 / (2 I) = 16 / 4
  // densities 7, 8, 9, 8 about 8: ln(7/8) + 8/7 - 1 + ln(9/8) + 8/9 - 1; each is rounded to a double
  EXPECT_NEAR(static_cast<double>(totals.internal_energy) * energy_quantum, std::log(63.0 / 64.0) + 2.0 / 63.0, 1e-15);
  // PPs about (2, 1): 1/4 - 1/8 + 1/8; the free ball lies in the middle and spins with 4; the other moves radially
  EXPECT_EQ(static_cast<double>(totals.angular_momentum[0]) * angular_quantum, 4.25);
  EXPECT_EQ(momentum(totals.momentum[0]), 12.5);
  EXPECT_EQ(momentum(totals.momentum[1]), -3.5);
  EXPECT_EQ(totals.lowest_density, 7.0);
  EXPECT_EQ(totals.highest_density, 9.0);
  EXPECT_EQ(totals.digest(), digest_share(hand::state()));
}

TEST(Totals, do_not_depend_on_how_many_processes_hold_the_state) {
  State<2> state = hand::state();
  const Totals<2> whole = measure(hand::model(), hand::sample(state), SingleGroup());
  testing_tools::ThreadGroup(2).run([&](const Group& group) {
    State<2> half = hand::state();
    const bool first = group.is_first();
    const auto keep = [&](auto& values) {
      values = first ? std::decay_t<decltype(values)>(values.begin(), values.begin() + 1)
                     : std::decay_t<decltype(values)>(values.begin() + 1, values.end());
    };
    keep(half.fluid.id);
    for (auto& field : half.fluid.field) keep(field);
    keep(half.solids);
    half.outside_impulse = first ? hand::iota(2.5, 0.5) : hand::iota(-2.0, 0.0);
    const Totals<2> totals = measure(hand::model(), hand::sample(half), group);
    EXPECT_EQ(totals.digest(), whole.digest());
    EXPECT_TRUE(totals.momentum == whole.momentum && totals.outside_impulse == whole.outside_impulse);
    EXPECT_TRUE(totals.sp_impulse == whole.sp_impulse && totals.mobile_velocity == whole.mobile_velocity);
    EXPECT_TRUE(totals.fluid_energy == whole.fluid_energy && totals.spin_energy == whole.spin_energy);
    EXPECT_TRUE(totals.internal_energy == whole.internal_energy && totals.angular_momentum == whole.angular_momentum);
    EXPECT_EQ(totals.lowest_density, 7.0);
    EXPECT_EQ(totals.highest_density, 9.0);
  });
}

TEST(Totals, of_angular_momentum_do_not_depend_on_the_image_of_a_solid) {
  State<2> state = hand::state();
  const Totals<2> inside = measure(hand::model(), hand::sample(state), SingleGroup());
  state.solids[3].momentum = hand::iota(4.0, 2.0);
  const Totals<2> turned = measure(hand::model(), hand::sample(state), SingleGroup());
  EXPECT_EQ(static_cast<double>((turned.angular_momentum - inside.angular_momentum)[0]) * angular_quantum, 2.0);
  state.solids[3].x[0] -= box_quanta;
  EXPECT_TRUE(measure(hand::model(), hand::sample(state), SingleGroup()).angular_momentum == turned.angular_momentum);
}

TEST(Totals, of_the_ledger_close_exactly_and_show_a_single_quantum) {
  State<2> state = hand::state();
  EXPECT_TRUE(momentum_defect(measure(hand::model(), hand::sample(state), SingleGroup()), state.start_momentum) ==
              hand::iota(0, 0));
  state.solids[3].momentum[1] += 1;
  const auto defect = momentum_defect(measure(hand::model(), hand::sample(state), SingleGroup()), state.start_momentum);
  EXPECT_TRUE(defect[0] == 0 && defect[1] == 1);
}

TEST(Totals, of_no_fluid_have_no_density) {
  State<2> none;
  const Totals<2> totals = measure(hand::model(), hand::sample(none), SingleGroup());
  EXPECT_TRUE(std::isnan(totals.lowest_density) && std::isnan(totals.highest_density));
}

TEST(MeanForce, is_impulse_over_time_and_zero_before_the_first_step) {
  EXPECT_EQ(mean_force(hand::iota(6.0, -3.0), 2, 0.5)[0], 6.0);
  EXPECT_EQ(mean_force(hand::iota(6.0, -3.0), 4, 0.5)[1], -1.5);
  EXPECT_EQ(mean_force(hand::iota(6.0, -3.0), 0, 0.5)[0], 0.0);
}

TEST(DigestText, has_sixteen_digits) { EXPECT_EQ(digest_text(0xabcu), "0000000000000abc"); }

}  // namespace
}  // namespace mappm
