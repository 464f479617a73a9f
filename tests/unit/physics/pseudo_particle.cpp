// Oracle: values worked by hand, in quanta.
#include "physics/pseudo_particle.hpp"

#include <gtest/gtest.h>

#include <random>

#include "base/lanes.hpp"

namespace mappm {
namespace {

/// A velocity of 1 drifts 2^20 quanta along x and 2^21 along y; a shear of 2^20 iota c allows the whole shift,
/// where the agitation is at most 4 / 0.9 of it.
ParticleStep<2> make_step() {
  ParticleStep<2> step;
  step.drift = {{0x1p20, 0x1p21}};
  step.kick = {{0.0, -0x1p-10}};
  step.largest_drift = {{0x1p21, 0x1p21}};
  step.shear = 0x1p-20;
  step.outer = 4.0;
  return step;
}

struct Particle {
  Vec<2, double> x{{1000.0, 5.0}}, v{{0.25, 0.0}};
};

NeighbourSums<2> make_sums() {
  NeighbourSums<2> sums;
  sums.impulse = {{std::int64_t{1} << 46, 0}};  // 1/4
  sums.shift = {{3, -4}};
  sums.shear = std::int64_t{1} << 20;
  sums.agitation = std::int64_t{1} << 22;
  return sums;
}

TEST(PseudoParticle, is_kicked_then_drifts_with_shift) {
  Particle p;
  EXPECT_EQ(advance(p.x, p.v, make_sums(), make_step()), RangeFault::none);
  EXPECT_EQ(p.v, (Vec<2, double>{{0.5, -0x1p-10}}));
  EXPECT_EQ(p.x, (Vec<2, double>{{1000.0 + 0x1p19 + 3.0, 5.0 - 0x1p11 - 4.0}}));
}

TEST(PseudoParticle, shifts_by_the_share_that_its_shear_allows) {
  const auto shifted = [](std::int64_t shear) {
    Particle p;
    NeighbourSums<2> sums = make_sums();
    sums.shift = {{1000, -4000}};
    sums.shear = shear;
    sums.agitation = 4 * shear;
    EXPECT_EQ(advance(p.x, p.v, sums, make_step()), RangeFault::none);
    return p.x - Vec<2, double>{{1000.0 + 0x1p19, 5.0 - 0x1p11}};
  };
  EXPECT_EQ(shifted(0), (Vec<2, double>{}));                         // at rest there is none
  EXPECT_EQ(shifted(1 << 18), (Vec<2, double>{{250.0, -1000.0}}));   // a quarter
  EXPECT_EQ(shifted(1 << 20), (Vec<2, double>{{1000.0, -4000.0}}));  // all of it
  EXPECT_EQ(shifted(5 << 20), (Vec<2, double>{{1000.0, -4000.0}}));  // and never more
  EXPECT_EQ(shifted((1 << 20) / 10000), (Vec<2, double>{}));         // 1e-4 of it, rounded to quanta
}

TEST(ShiftShare, by_hand) {
  ParticleStep<2> plane{};
  plane.shear = 0x1p-10;
  plane.outer = 2.0;
  EXPECT_EQ(shift_share(512.0, 1024.0, plane), 0.5);  // a flow: S = S_0
  EXPECT_EQ(shift_share(1024.0, 2048.0, plane), 1.0);
  EXPECT_EQ(shift_share(4e5, 8e5, plane), 1.0);
  EXPECT_EQ(shift_share(0.0, 0.0, plane), 0.0);
}

TEST(ShiftShare, tells_flow_from_what_differs_by_chance) {
  ParticleStep<2> plane{};
  plane.shear = 1.0;
  plane.outer = 2.0;
  EXPECT_NEAR(shift_share(400.0, 1000.0, plane), 0.5, 1e-14);  // S^2 / S_0^2 = 0.8
  EXPECT_NEAR(shift_share(360.0, 1000.0, plane), 0.1, 1e-14);  // 0.72
  EXPECT_NEAR(shift_share(450.0, 1000.0, plane), 1.0, 1e-14);  // 0.9
  EXPECT_EQ(shift_share(900.0, 1000.0, plane), 1.0);           // at an extremum of the velocity it is more than 1
  EXPECT_EQ(shift_share(333.0, 1000.0, plane), 0.0);
}

TEST(PseudoParticle, a_fault_is_named_and_changes_nothing) {
  const auto fault_of = [](const NeighbourSums<2>& sums, const Vec<2, double>& v = Particle{}.v) {
    Particle p;
    p.v = v;
    ParticleStep<2> step = make_step();
    if (v != Particle{}.v) step.drift = {{1.0, 1.0}};
    const RangeFault fault = advance(p.x, p.v, sums, step);
    EXPECT_EQ(p.x, Particle{}.x);
    EXPECT_EQ(p.v, v);
    return fault;
  };
  NeighbourSums<2> sums = make_sums();
  sums.impulse[1] = -(std::int64_t{1} << 50);
  EXPECT_EQ(fault_of(sums), RangeFault::impulse);
  sums = make_sums();
  sums.shift[0] = (std::int64_t{1} << 21) - (1 << 19) + 1;  // one quantum above the largest drift
  EXPECT_EQ(fault_of(sums), RangeFault::displacement);
  EXPECT_EQ(fault_of(make_sums(), {{32.0, 0.0}}), RangeFault::velocity);  // 2^53 quanta are 32 c
}

TEST(PseudoParticle, lanes_move_as_one_by_one) {
  const ParticleStep<2> step = make_step();
  std::mt19937_64 random(7);
  std::uniform_int_distribution<std::int64_t> impulse(-(std::int64_t{1} << 46), std::int64_t{1} << 46), shift(-99, 99),
      shear(0, 1 << 21), agitation(0, 1 << 23);
  for (int trial = 0; trial < 100; ++trial) {
    Vec<2, Lanes> x, v;
    NeighbourSums<2, IntLanes> sums;
    for (int lane = 0; lane < lane_count; ++lane) {
      for (int axis = 0; axis < 2; ++axis) {
        x[axis][lane] = static_cast<double>(impulse(random));
        v[axis][lane] = static_cast<double>(impulse(random)) * velocity_quantum;
        sums.impulse[axis][lane] = impulse(random);
        sums.shift[axis][lane] = shift(random);
      }
      sums.shear[lane] = shear(random);
      sums.agitation[lane] = agitation(random);
    }
    const int odd = trial % lane_count;  // one of them beyond its range, now and then
    if (trial % 3 == 1) sums.impulse[0][odd] = std::int64_t{1} << 51;
    if (trial % 7 == 1) {
      sums.shift[1][odd] = std::int64_t{1} << 23;
      sums.shear[odd] = 1 << 20;
      sums.agitation[odd] = 1 << 22;
    }
    const auto motion = motion_of(x, v, sums, step);
    for (int lane = 0; lane < lane_count; ++lane) {
      Particle one{{{x[0][lane], x[1][lane]}}, {{v[0][lane], v[1][lane]}}};
      const NeighbourSums<2> given{{{sums.impulse[0][lane], sums.impulse[1][lane]}},
                                   {{sums.shift[0][lane], sums.shift[1][lane]}},
                                   sums.shear[lane],
                                   sums.agitation[lane]};
      const RangeFault fault = advance(one.x, one.v, given, step);
      EXPECT_EQ(motion.beyond.any()[lane], fault != RangeFault::none);
      EXPECT_EQ(fault != RangeFault::none, lane == odd && (trial % 3 == 1 || trial % 7 == 1));
      if (fault != RangeFault::none) continue;
      for (int axis = 0; axis < 2; ++axis) {
        EXPECT_EQ(motion.x[axis][lane], one.x[axis]);
        EXPECT_EQ(motion.v[axis][lane], one.v[axis]);
      }
    }
  }
}

}  // namespace
}  // namespace mappm
