// Oracles: values worked by hand, finite differences, and lattice sums written out here.
#include "physics/kernel.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace mappm {
namespace {

template <class Kernel>
class KernelTest : public ::testing::Test {};
using Kernels = ::testing::Types<WendlandC2, Lucy, MpsWeight>;
TYPED_TEST_SUITE(KernelTest, Kernels);

TEST(Kernel, values_by_hand) {
  const auto wendland = WendlandC2::at(0.5);  // (1/2)^4 (1 + 2), (1/2)^3, 20 (1/2)^3
  EXPECT_EQ(wendland.weight, 0.1875);
  EXPECT_EQ(wendland.gradient, 0.125);
  EXPECT_EQ(wendland.rate, 2.5);
  const auto lucy = Lucy::at(0.5);  // (1/2)^3 (1 + 3/2), (1/2)^2, 12 (1/2)^2
  EXPECT_EQ(lucy.weight, 0.3125);
  EXPECT_EQ(lucy.gradient, 0.25);
  EXPECT_EQ(lucy.rate, 3.0);
  const auto mps = MpsWeight::at(0.5);  // 1/q - 1, (1/q - 1) / q^2, 1 / q^3
  EXPECT_EQ(mps.weight, 1.0);
  EXPECT_EQ(mps.gradient, 4.0);
  EXPECT_EQ(mps.rate, 8.0);
}

TEST(Kernel, value_at_the_particle_itself) {
  EXPECT_EQ(WendlandC2::at(0.0).weight, WendlandC2::self_weight);
  EXPECT_EQ(Lucy::at(0.0).weight, Lucy::self_weight);
  EXPECT_EQ(MpsWeight::self_weight, 0.0);
  EXPECT_TRUE(std::isfinite(MpsWeight::at(0.0).gradient));
}

TYPED_TEST(KernelTest, vanishes_at_the_cutoff) {
  const auto edge = TypeParam::at(1.0);
  EXPECT_EQ(edge.weight, 0.0);
  EXPECT_EQ(edge.gradient, 0.0);
  EXPECT_EQ(edge.rate, 0.0);
}

TYPED_TEST(KernelTest, rate_is_the_slope_of_the_weight) {
  const double step = 1e-6;  // central difference: error step^2 W''' / 6 + 1e-16 / step, both below 1e-8 of the slope
  for (double q = 0.1; q < 0.95; q += 0.05) {
    const double slope = (TypeParam::at(q + step).weight - TypeParam::at(q - step).weight) / (2.0 * step);
    EXPECT_NEAR(TypeParam::at(q).rate * q, -slope, 1e-8 * std::fabs(slope) + 1e-9) << q;
  }
}

TEST(Kernel, force_and_density_share_one_function_except_for_the_mps_weight) {
  for (double q = 0.1; q < 1.0; q += 0.1) {
    EXPECT_DOUBLE_EQ(WendlandC2::at(q).rate, 20.0 * WendlandC2::at(q).gradient);
    EXPECT_DOUBLE_EQ(Lucy::at(q).rate, 12.0 * Lucy::at(q).gradient);
    EXPECT_DOUBLE_EQ(MpsWeight::at(q).gradient, MpsWeight::at(q).weight / (q * q));
  }
}

/// sum W and (1/D) sum V r^2 G over a lattice that is wider than the cutoff on every side.
template <int D, class Kernel>
std::array<double, 2> lattice_sums(const std::array<double, 3>& spacing, const KernelScale& scale) {
  double density = Kernel::self_weight * scale.weight, identity = 0.0;
  const int nodes = 8, layers = D == 3 ? nodes : 0;
  for (int i = -nodes; i <= nodes; ++i)
    for (int j = -nodes; j <= nodes; ++j)
      for (int k = -layers; k <= layers; ++k) {
        const double q = std::hypot(i * spacing[0], j * spacing[1], k * spacing[2]);
        if ((i == 0 && j == 0 && k == 0) || q >= 1.0) continue;
        density += scale.weight * Kernel::at(q).weight;
        identity += q * q * scale.gradient * Kernel::at(q).gradient;
      }
  const double cell = spacing[0] * spacing[1] * (D == 3 ? spacing[2] : 1.0);
  return {density, identity * cell / D};
}

TYPED_TEST(KernelTest, sums_over_the_lattice_are_exact) {
  // 1e-13: some hundred terms, each rounded a few times.
  const std::array<double, 3> spacing{0.28, 0.31, 0.33};
  const double plane[2] = {spacing[0], spacing[1]};
  const auto in_plane = lattice_sums<2, TypeParam>(spacing, normalise<2, TypeParam>(plane));
  EXPECT_NEAR(in_plane[0] * 0.28 * 0.31, 1.0, 1e-13);
  EXPECT_NEAR(in_plane[1], 1.0, 1e-13);
  const double space[3] = {spacing[0], spacing[1], spacing[2]};
  const auto in_space = lattice_sums<3, TypeParam>(spacing, normalise<3, TypeParam>(space));
  EXPECT_NEAR(in_space[0] * 0.28 * 0.31 * 0.33, 1.0, 1e-13);
  EXPECT_NEAR(in_space[1], 1.0, 1e-13);
}

TEST(Kernel, fine_lattices_give_the_integrals_normalisation) {
  // Continuum limit of W: 7 / pi (2D) and 21 / (2 pi) (3D) for support 1 (Wendland 1995; Dehnen and Aly 2012). The
  // midpoint sum over a lattice of 1/20 differs by O(dx^4) of the kernel's smoothness: below 1e-4.
  const double pi = 3.14159265358979323846;
  const double plane[2] = {0.05, 0.05};
  EXPECT_NEAR((normalise<2, WendlandC2>(plane).weight), 7.0 / pi, 1e-4 * 7.0 / pi);
  const double space[3] = {0.05, 0.05, 0.05};
  EXPECT_NEAR((normalise<3, WendlandC2>(space).weight), 10.5 / pi, 1e-4 * 10.5 / pi);
}

}  // namespace
}  // namespace mappm
