// Oracle: values worked by hand, in quanta.
#include "physics/pseudo_particle.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace mappm
