// Oracles: literals from an independent computation in numpy (long double), the law's equations written out in plain
// formulas, symmetry, and the scalar law for the lanes.
#include "physics/fluid_pair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/lanes.hpp"
#include "physics/state_equation.hpp"
#include "unit/physics/pair_setup.hpp"

namespace mappm {
namespace {

using testing::Fluid;
using testing::interact;
using testing::make_law;
using testing::random_pair;
using testing::shared_density;

/// Impulse, displacement and density of one pair, in internal units.
template <int D>
struct Values {
  std::array<double, D> impulse, displacement;
  double density;
};

template <int D, class Kernel>
void expect_values(const Fluid<D>& fluid, const FluidPair<D, double>& pair, double beta, const Values<D>& expected) {
  const PairLaw<D> law = make_law<D, Kernel>(fluid);
  const auto result = interact<Kernel, true>(law, pair, beta);
  // A rounding to quanta and some twenty operations; pressure and friction cancel to a third at worst.
  const double relative = 2e-14;
  for (int axis = 0; axis < D; ++axis) {
    EXPECT_NEAR(static_cast<double>(result.impulse[axis]) * velocity_quantum, expected.impulse[axis],
                velocity_quantum + relative * std::fabs(expected.impulse[axis]));
    EXPECT_NEAR(static_cast<double>(result.shift[axis]) * law.length[axis], expected.displacement[axis],
                law.length[axis] + relative * std::fabs(expected.displacement[axis]));
  }
  EXPECT_NEAR(static_cast<double>(shared_density<Kernel>(law, pair)) * density_quantum, expected.density,
              density_quantum + relative * expected.density);
}

// numpy: a lattice of the spacings is summed for the two normalisations  n0 = a_w (W(0) + sum W)  and
// 1 = a_g V / D sum r^2 G  with W by its polynomial and G = -W'/r by its derivative (mps: W = 1/q - 1, G = W / q^2);
//   F dt = a_g G dt ((p_i/rho_i^2 + p_j/rho_j^2) r - beta mu (1/rho_i^2 + 1/rho_j^2) v)
//   u dt = kappa h (1/rho_i^2 + 1/rho_j^2) / (2 V_0) a_g G r dt,  rho = a_w W
TEST(FluidPair, literals_in_the_plane) {
  const Fluid<2> fluid = testing::plane_fluid();
  const double rho0 = 10.24, background = 0.125;
  const auto i = volume_terms(10.5, rho0, 1.0, background);
  const auto j = volume_terms(10.0, rho0, 1.0, background);
  const FluidPair<2, double> pair{
      {{450359962737049.0, -315251973915934.0}}, {{0.015625, -0.0078125}}, i.v2 + j.v2, i.pv2 + j.pv2};
  expect_values<2, WendlandC2>(fluid, pair, 1.75,
                               {{3.330416687727347961e-05, -2.928174380716029399e-05},
                                {3.510177804071785678e-04, -3.071405578562809545e-04},
                                3.341565107958126176e-01});
  expect_values<2, Lucy>(fluid, pair, 1.75,
                         {{3.071854216377965046e-05, -2.700840663824124246e-05},
                          {3.237659277714085164e-04, -2.832951867999821822e-04},
                          4.238544537792169823e-01});
  expect_values<2, MpsWeight>(fluid, pair, 1.75,
                              {{2.246437558841236116e-05, -1.975116486749866104e-05},
                               {2.367690291228587731e-04, -2.071729004825012294e-04},
                               4.384256476025340288e-01});
}

TEST(FluidPair, literals_in_space) {
  const Fluid<3> fluid = testing::space_fluid();
  const double rho0 = 19.25;
  const auto i = volume_terms(19.5, rho0, 1.0, 0.0);
  const auto j = volume_terms(19.0, rho0, 1.0, 0.0);
  const FluidPair<3, double> pair{{{225179981368524.0, -204709073971385.0, 250000000000001.0}},
                                  {{0.015625, -0.0078125, 0.03125}},
                                  i.v2 + j.v2,
                                  i.pv2 + j.pv2};
  expect_values<3, WendlandC2>(fluid, pair, 1.0,
                               {{-6.642991812160402964e-07, 5.229671684252634911e-07, -8.722056178153179630e-07},
                                {2.104632447790772007e-04, -1.753860373158972778e-04, 2.531329018736413355e-04},
                                4.985525242574176324e-01});
  expect_values<3, Lucy>(fluid, pair, 1.0,
                         {{-5.257473064154986820e-07, 4.138926976246041931e-07, -6.902910122024350868e-07},
                          {1.665672443544384971e-04, -1.388060369620317727e-04, 2.003373556498856046e-04},
                          5.569355920182711993e-01});
  expect_values<3, MpsWeight>(fluid, pair, 1.0,
                              {{-5.037450008292754401e-07, 3.965714607834098325e-07, -6.614026211283051792e-07},
                               {1.595964746211074655e-04, -1.329970621842559259e-04, 1.919533208378059113e-04},
                               4.978226519216045978e-01});
}

/// W(r) and G(r) = -W'(r) / r of Wendland's kernel, before normalisation of each.
double wendland(double q) { return q < 1.0 ? std::pow(1.0 - q, 4.0) * (1.0 + 4.0 * q) : 0.0; }
double wendland_g(double q) { return q < 1.0 ? std::pow(1.0 - q, 3.0) : 0.0; }

template <int D>
void compare_with_plain_formulas(const Fluid<D>& fluid, double rho0) {
  const PairLaw<D> law = make_law<D, WendlandC2>(fluid);
  const KernelScale scale = testing::scale_of<D, WendlandC2>(fluid);
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 5000; ++trial) {
    const FluidPair<D, double> pair = random_pair(random, law, rho0);
    const double beta = trial % 2 == 0 ? 1.0 : 2.25;
    double square = 0.0;
    Vec<D, double> r;
    for (int axis = 0; axis < D; ++axis) {
      r[axis] = pair.d[axis] / box_quanta * fluid.box[axis];
      square += r[axis] * r[axis];
    }
    const double q = std::sqrt(square);
    const double g = scale.gradient * wendland_g(q);
    const double roundings = 1e-14 * (1.0 + 1.0 / std::max(1.0 - q, 1e-3));  // 1 - q loses digits near the cutoff
    const auto result = interact<WendlandC2, true>(law, pair, beta);
    for (int axis = 0; axis < D; ++axis) {
      const double pressure = fluid.dt * g * pair.pv2 * r[axis];
      const double friction = fluid.dt * g * beta * fluid.mu * pair.v2 * pair.v[axis];
      EXPECT_NEAR(static_cast<double>(result.impulse[axis]) * velocity_quantum, pressure - friction,
                  velocity_quantum + roundings * (std::fabs(pressure) + std::fabs(friction)));
      const double u = fluid.shift_rate * 0.5 * pair.v2 / (2.0 * fluid.volume()) * g * r[axis];
      EXPECT_NEAR(static_cast<double>(result.shift[axis]) * law.length[axis], u * fluid.dt,
                  law.length[axis] + roundings * std::fabs(u * fluid.dt));
    }
    const double agitation = fluid.dt * g * pair.v2 * dot(pair.v, pair.v), shear = agitation * q * q * q * q;
    EXPECT_NEAR(static_cast<double>(result.shear) * velocity_quantum, shear, velocity_quantum + roundings * shear);
    EXPECT_NEAR(static_cast<double>(result.agitation) * velocity_quantum, agitation,
                velocity_quantum + roundings * agitation);
    EXPECT_NEAR(static_cast<double>(shared_density<WendlandC2>(law, pair)) * density_quantum,
                scale.weight * wendland(q), density_quantum + 1e-14 * scale.weight);
  }
}

TEST(FluidPair, agrees_with_its_equations_in_plain_formulas) {
  compare_with_plain_formulas<2>(testing::plane_fluid(), 10.24);
  compare_with_plain_formulas<3>(testing::space_fluid(), 19.1);
}

template <class Kernel>
class PairLawTest : public ::testing::Test {};
using Kernels = ::testing::Types<WendlandC2, Lucy, MpsWeight>;
TYPED_TEST_SUITE(PairLawTest, Kernels);

template <class Kernel, int D>
void expect_antisymmetry(const Fluid<D>& fluid, double rho0) {
  const PairLaw<D> law = make_law<D, Kernel>(fluid);
  std::mt19937_64 random(11);
  for (int trial = 0; trial < 5000; ++trial) {
    const FluidPair<D, double> pair = random_pair(random, law, rho0);
    const FluidPair<D, double> swapped{-pair.d, -pair.v, pair.v2, pair.pv2};
    const auto on_i = interact<Kernel, true>(law, pair, 1.5);
    const auto on_j = interact<Kernel, true>(law, swapped, 1.5);
    for (int axis = 0; axis < D; ++axis) {
      EXPECT_EQ(on_i.impulse[axis], -on_j.impulse[axis]);
      EXPECT_EQ(on_i.shift[axis], -on_j.shift[axis]);
    }
    EXPECT_EQ(on_i.shear, on_j.shear);
    EXPECT_EQ(on_i.agitation, on_j.agitation);
    EXPECT_EQ(shared_density<Kernel>(law, pair), shared_density<Kernel>(law, swapped));
  }
}

TYPED_TEST(PairLawTest, is_antisymmetric_to_the_last_bit) {
  expect_antisymmetry<TypeParam>(testing::plane_fluid(), 10.24);
  expect_antisymmetry<TypeParam>(testing::space_fluid(), 19.1);
}

template <class Kernel, bool transport, int D>
void expect_lanes_like_double(const Fluid<D>& fluid, double rho0) {
  const PairLaw<D> law = make_law<D, Kernel>(fluid);
  std::mt19937_64 random(5);
  for (int batch = 0; batch < 1000; ++batch) {
    std::array<FluidPair<D, double>, lane_count> pairs;
    FluidPair<D, Lanes> wide;
    Lanes beta(1.0);
    for (int lane = 0; lane < lane_count; ++lane) {
      pairs[lane] = random_pair(random, law, rho0);
      if (batch == 0 && lane == 0) pairs[lane].d = {};  // two particles at one position
      for (int axis = 0; axis < D; ++axis) {
        wide.d[axis][lane] = pairs[lane].d[axis];
        wide.v[axis][lane] = pairs[lane].v[axis];
      }
      wide.v2[lane] = pairs[lane].v2;
      wide.pv2[lane] = pairs[lane].pv2;
      beta[lane] = 1.0 + 0.25 * lane;
    }
    const auto lanes = interact<Kernel, transport>(law, wide, beta);
    const IntLanes shared = shared_density<Kernel>(law, wide);
    for (int lane = 0; lane < lane_count; ++lane) {
      const auto one = interact<Kernel, transport>(law, pairs[lane], 1.0 + 0.25 * lane);
      for (int axis = 0; axis < D; ++axis) {
        EXPECT_EQ(lanes.impulse[axis][lane], one.impulse[axis]);
        if constexpr (transport) {
          EXPECT_EQ(lanes.shift[axis][lane], one.shift[axis]);
        }
      }
      if constexpr (transport) {
        EXPECT_EQ(lanes.shear[lane], one.shear);
        EXPECT_EQ(lanes.agitation[lane], one.agitation);
      }
      EXPECT_EQ(shared[lane], shared_density<Kernel>(law, pairs[lane]));
    }
  }
}

TYPED_TEST(PairLawTest, has_the_same_bits_in_lanes_and_doubles) {
  expect_lanes_like_double<TypeParam, true>(testing::plane_fluid(), 10.24);
  expect_lanes_like_double<TypeParam, false>(testing::plane_fluid(), 10.24);
  expect_lanes_like_double<TypeParam, true>(testing::space_fluid(), 19.1);
  expect_lanes_like_double<TypeParam, false>(testing::space_fluid(), 19.1);
}

TYPED_TEST(PairLawTest, gives_exactly_nothing_from_the_cutoff_on) {
  const PairLaw<2> law = make_law<2, TypeParam>(testing::plane_fluid());
  for (const double distance : {1.0, 1.0000001, 1.3, 1.9}) {
    const FluidPair<2, double> pair{{{std::nearbyint(distance / law.length[0]), 0.0}}, {{0.1, 0.2}}, 0.02, 0.01};
    const auto result = interact<TypeParam, true>(law, pair, 3.0);
    EXPECT_EQ(result.impulse, (Vec<2, std::int64_t>{}));
    EXPECT_EQ(result.shift, (Vec<2, std::int64_t>{}));
    EXPECT_EQ(result.shear, 0);
    EXPECT_EQ(result.agitation, 0);
    EXPECT_EQ(shared_density<TypeParam>(law, pair), 0);
  }
}

TYPED_TEST(PairLawTest, viscosity_slows_and_pressure_repels) {
  const PairLaw<2> law = make_law<2, TypeParam>(testing::plane_fluid());
  const Vec<2, double> d{{std::nearbyint(0.5 / law.length[0]), 0.0}};
  const auto pushed = interact<TypeParam, true>(law, FluidPair<2, double>{d, {}, 0.02, 0.01}, 1.0);
  EXPECT_GT(pushed.impulse[0], 0);
  EXPECT_GT(pushed.shift[0], 0);
  const auto slowed = interact<TypeParam, true>(law, FluidPair<2, double>{d, {{0.0, 0.1}}, 0.02, 0.0}, 1.0);
  EXPECT_LT(slowed.impulse[1], 0);
  EXPECT_EQ(slowed.impulse[0], 0);
}

}  // namespace
}  // namespace mappm
