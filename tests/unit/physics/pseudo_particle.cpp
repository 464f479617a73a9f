// Oracle: values worked by hand, in quanta.
#include "physics/pseudo_particle.hpp"

#include <gtest/gtest.h>

#include <random>

namespace mappm {
namespace {

/// A velocity of 1 drifts 2^20 quanta along x and 2^21 along y; densities from 8 to 12.
ParticleStep<2> make_step() {
  ParticleStep<2> step;
  step.drift = {{0x1p20, 0x1p21}};
  step.kick = {{0.0, -0x1p-10}};
  step.largest_drift = {{0x1p21, 0x1p21}};
  step.self_density = 2.0;
  step.lowest_density = 8.0;
  step.highest_density = 12.0;
  return step;
}

struct Particle {
  Vec<2, double> x{{1000.0, 5.0}}, v{{0.25, 0.0}};
  double density = 10.0;
};

NeighbourSums<2> make_sums() {
  NeighbourSums<2> sums;
  sums.impulse = {{std::int64_t{1} << 46, 0}};  // 1/4
  sums.shift = {{3, -4}};
  sums.density = std::int64_t{7} << 44;
  return sums;
}

TEST(PseudoParticle, is_kicked_then_drifts_with_shift) {
  Particle p;
  EXPECT_EQ(advance(p.x, p.v, p.density, make_sums(), make_step()), RangeFault::none);
  EXPECT_EQ(p.v, (Vec<2, double>{{0.5, -0x1p-10}}));
  EXPECT_EQ(p.x, (Vec<2, double>{{1000.0 + 0x1p19 + 3.0, 5.0 - 0x1p11 - 4.0}}));
  EXPECT_EQ(p.density, 9.0);
}

TEST(PseudoParticle, a_fault_is_named_and_changes_nothing) {
  const auto fault_of = [](const NeighbourSums<2>& sums) {
    Particle p;
    const RangeFault fault = advance(p.x, p.v, p.density, sums, make_step());
    EXPECT_EQ(p.x, Particle{}.x);
    EXPECT_EQ(p.v, Particle{}.v);
    EXPECT_EQ(p.density, 10.0);
    return fault;
  };
  NeighbourSums<2> sums = make_sums();
  sums.impulse[1] = -(std::int64_t{1} << 50);
  EXPECT_EQ(fault_of(sums), RangeFault::impulse);
  sums = make_sums();
  sums.shift[0] = (std::int64_t{1} << 21) - (1 << 19) + 1;  // one quantum above the largest drift
  EXPECT_EQ(fault_of(sums), RangeFault::displacement);
  sums = make_sums();
  sums.density = std::int64_t{11} << 44;
  EXPECT_EQ(fault_of(sums), RangeFault::density);
  sums.density = std::int64_t{5} << 44;
  EXPECT_EQ(fault_of(sums), RangeFault::density);
}

TEST(PseudoParticle, lanes_move_as_one_by_one) {
  const ParticleStep<2> step = make_step();
  std::mt19937_64 random(7);
  std::uniform_int_distribution<std::int64_t> impulse(-(std::int64_t{1} << 46), std::int64_t{1} << 46), shift(-9, 9),
      density(std::int64_t{6} << 44, std::int64_t{10} << 44);
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
      sums.density[lane] = density(random);
    }
    const int odd = trial % lane_count;  // one of them beyond its range, now and then
    if (trial % 3 == 1) sums.density[odd] = std::int64_t{11} << 44;
    if (trial % 7 == 1) sums.shift[1][odd] = std::int64_t{1} << 22;
    const auto motion = motion_of(x, v, sums, step);
    for (int lane = 0; lane < lane_count; ++lane) {
      Particle one{{{x[0][lane], x[1][lane]}}, {{v[0][lane], v[1][lane]}}, 0.0};
      const NeighbourSums<2> given{{{sums.impulse[0][lane], sums.impulse[1][lane]}},
                                   {{sums.shift[0][lane], sums.shift[1][lane]}},
                                   sums.density[lane]};
      const RangeFault fault = advance(one.x, one.v, one.density, given, step);
      EXPECT_EQ(motion.beyond.any()[lane], fault != RangeFault::none);
      EXPECT_EQ(fault != RangeFault::none, lane == odd && (trial % 3 == 1 || trial % 7 == 1));
      if (fault != RangeFault::none) continue;
      for (int axis = 0; axis < 2; ++axis) {
        EXPECT_EQ(motion.x[axis][lane], one.x[axis]);
        EXPECT_EQ(motion.v[axis][lane], one.v[axis]);
      }
      EXPECT_EQ(motion.density[lane], one.density);
    }
  }
}

}  // namespace
}  // namespace mappm
