// Oracles: an independent program (numpy, waves in all directions of a hexagonal lattice), the eigenvalues of the step,
// and the continuum.
#include "physics/stability.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace mappm {
namespace {

constexpr std::array viscosities{1e-6, 0.001, 0.01, 0.03, 0.1, 0.3};  // nu / (c h)

/// The independent program looks at fewer waves, and ours is cut to two decimals.
void expect_first_instability(double reach, double shift_rate, const std::array<double, 6>& expected) {
  for (std::size_t n = 0; n < expected.size(); ++n) {
    const double found = first_instability<2>(KernelKind::wendland_c2, reach, viscosities[n], shift_rate);
    EXPECT_LE(found, expected[n] + 1e-3) << "nu / (c h) = " << viscosities[n];
    EXPECT_GE(found, expected[n] - 0.02) << "nu / (c h) = " << viscosities[n];
  }
}

TEST(FirstInstability, is_that_of_an_independent_program) {
  expect_first_instability(3.5, 0.5, {1.359, 1.358, 1.347, 1.323, 1.238, 0.967});
  expect_first_instability(3.0, 0.0, {1.79, 1.79, 1.77, 1.72, 1.56, 1.02});
}

TEST(FirstInstability, comes_earlier_with_more_viscosity_and_with_more_shift) {
  for (const KernelKind kernel : {KernelKind::wendland_c2, KernelKind::lucy, KernelKind::mps}) {
    double last = 4.0;
    for (const double viscosity : viscosities) {
      const double found = first_instability<3>(kernel, 3.0, viscosity, 0.5);
      EXPECT_LE(found, last);
      EXPECT_LE(found, first_instability<3>(kernel, 3.0, viscosity, 0.0));
      EXPECT_GT(found, 0.0);
      last = found;
    }
  }
}

TEST(FirstInstability, in_viscous_flow_goes_with_one_over_viscosity) {
  // 1 - dt nu g = -1 of the wave with the largest g, without sound and shift.
  const double reach = 3.0, h = 0.5 * reach;
  const auto waves = lattice_waves<2>(KernelKind::wendland_c2, reach);
  const double largest =
      std::ranges::max_element(waves, {}, [](const LatticeWave& wave) { return wave.friction; })->friction;
  const double found = first_instability<2>(KernelKind::wendland_c2, reach, 30.0, 0.0);
  const double alone = 2.0 / (30.0 * h * largest) / h;  // dt c / h
  EXPECT_LE(found, alone);
  EXPECT_GT(found, 0.95 * alone - 0.01);
}

TEST(LatticeWaves, are_sound_and_viscosity_where_they_are_long) {
  // p and g go to k^2. k reach = 0.4 in the plane and 0.5 in space: the next term is about a twentieth of its square.
  const auto plane = lattice_waves<2>(KernelKind::wendland_c2, 3.5);
  const double k = 1.3 * std::numbers::pi * std::sqrt(2.0) / 48.0;
  EXPECT_NEAR(plane[0].pressure / (k * k), 1.0, 0.04);
  EXPECT_NEAR(plane[0].friction / (k * k), 1.0, 0.02);
  const auto space = lattice_waves<3>(KernelKind::lucy, 3.0);
  const double in_space = 1.3 * std::numbers::pi * std::sqrt(3.0) / 48.0;
  EXPECT_NEAR(space[0].pressure / (in_space * in_space), 1.0, 0.04);
  EXPECT_NEAR(space[0].friction / (in_space * in_space), 1.0, 0.02);
}

TEST(LatticeWaves, across_have_no_pressure) {
  const auto waves = lattice_waves<2>(KernelKind::wendland_c2, 3.0);
  for (std::size_t n = 0; n < waves.size(); n += 2) {
    EXPECT_EQ(waves[n + 1].pressure, 0.0);
    EXPECT_EQ(waves[n + 1].friction, waves[n].friction);
  }
}

/// The smaller eigenvalue of the step as a matrix, or the real part of both.
bool is_above_minus_one(const LatticeWave& wave, double dt, double nu, double shift_rate) {
  // v' = d v - dt p x, x' = s x + dt v'
  const double d = 1.0 - dt * nu * wave.friction, s = 1.0 + dt * shift_rate * (wave.shift + wave.pressure);
  const double half = 0.5 * (d + s - dt * dt * wave.pressure), product = d * s;
  if (half * half < product) return half >= -1.0;
  return half - std::sqrt(half * half - product) >= -1.0;
}

TEST(IsStable, says_whether_the_eigenvalues_of_the_step_are_above_minus_one) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int stable = 0;
  constexpr int trials = 10000;
  for (int trial = 0; trial < trials; ++trial) {
    const LatticeWave wave{4.0 * unit(random), 1.0 - 3.0 * unit(random), 4.0 * unit(random)};
    const double dt = 1.5 * unit(random), nu = unit(random), shift_rate = 2.0 * unit(random);
    EXPECT_EQ(is_stable(wave, dt, nu, shift_rate), is_above_minus_one(wave, dt, nu, shift_rate)) << trial;
    stable += is_stable(wave, dt, nu, shift_rate) ? 1 : 0;
  }
  EXPECT_GT(stable, trials / 10);
  EXPECT_LT(stable, trials * 9 / 10);
}

TEST(IsStable, by_hand) {
  // Sound alone: dt^2 p <= 4. Viscosity alone: dt nu g <= 2. Shift alone: dt kappa h |H| <= 2.
  EXPECT_TRUE(is_stable({1.0, 0.0, 0.0}, 2.0, 0.0, 0.0));
  EXPECT_FALSE(is_stable({1.0, 0.0, 0.0}, 2.01, 0.0, 0.0));
  EXPECT_TRUE(is_stable({0.0, 0.0, 4.0}, 1.0, 0.5, 0.0));
  EXPECT_FALSE(is_stable({0.0, 0.0, 4.0}, 1.01, 0.5, 0.0));
  EXPECT_TRUE(is_stable({0.0, -4.0, 0.0}, 1.0, 0.0, 0.5));
  EXPECT_FALSE(is_stable({0.0, -4.0, 0.0}, 1.01, 0.0, 0.5));
}

TEST(WallFriction, is_that_of_the_fluid_where_the_factor_is_one_and_grows_with_its_bound) {
  for (const KernelKind kernel : {KernelKind::wendland_c2, KernelKind::lucy, KernelKind::mps})
    for (const double reach : {2.6, 3.0, 3.5}) {
      // An FP does not move, so it counts half of a PP that moves the other way. The nearest row of the wall is 0.5 dx
      // away, where the weight of MPS has grown a lot.
      if (kernel != KernelKind::mps) {
        EXPECT_LT(wall_friction<2>(kernel, reach, 1.0, 1), 1.06);
        EXPECT_LT(wall_friction<3>(kernel, reach, 1.0, 1), 1.06);
      }
      double plane = 1.0, space = 1.0;
      for (const double largest : {1.0, 2.0, 4.0, 8.0}) {
        const double in_plane = wall_friction<2>(kernel, reach, largest, 1);
        const double in_space = wall_friction<3>(kernel, reach, largest, 1);
        EXPECT_GE(in_plane, plane);
        EXPECT_GE(in_space, space);
        plane = in_plane;
        space = in_space;
      }
      EXPECT_GT(plane, 1.2);
      EXPECT_GT(space, 1.2);
    }
}

TEST(WallFriction, in_a_corner_is_that_of_a_sum_by_hand) {
  // rcut 1.2 dx: of the lattice four neighbours at 1, PPs, which count twice. In the corner two of them are left, and
  // FPs at (-0.5, 0), (0, -0.5), (-0.5, 1), (1, -0.5), all at 0.25 dx of the PP, so beta = 1 + 0.5 / 0.25; and one at
  // (-0.5, -0.5).
  const auto weight = [](double distance) { return WendlandC2::gradient(distance / 1.2); };
  const double fluid = 8.0 * weight(1.0);
  const double corner =
      4.0 * weight(1.0) + 3.0 * (2.0 * weight(0.5) + 2.0 * weight(std::sqrt(1.25)) + weight(std::sqrt(0.5)));
  EXPECT_NEAR((wall_friction<2>(KernelKind::wendland_c2, 1.2, 4.0, 2)), corner / fluid, 1e-12);
  for (const double reach : {2.6, 3.0, 3.5}) {
    const KernelKind kernel = KernelKind::wendland_c2;
    EXPECT_GT(wall_friction<2>(kernel, reach, 4.0, 2), 1.4 * wall_friction<2>(kernel, reach, 4.0, 1));
    EXPECT_GT(wall_friction<3>(kernel, reach, 8.0, 2), 1.2 * wall_friction<3>(kernel, reach, 8.0, 1));
    EXPECT_GT(wall_friction<3>(kernel, reach, 8.0, 3), 1.1 * wall_friction<3>(kernel, reach, 8.0, 2));
  }
}

}  // namespace
}  // namespace mappm
