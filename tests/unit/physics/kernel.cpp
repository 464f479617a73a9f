// Oracles: values worked by hand, finite differences, and lattice sums written out here.
#include "physics/kernel.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/lanes.hpp"

namespace mappm {
namespace {

template <class Kernel>
class KernelTest : public ::testing::Test {};
using Kernels = ::testing::Types<WendlandC2, Lucy, MpsWeight>;
TYPED_TEST_SUITE(KernelTest, Kernels);

TEST(Kernel, values_by_hand) {
  EXPECT_EQ(WendlandC2::weight(0.5), 0.1875);  // (1/2)^4 (1 + 2)
  EXPECT_EQ(WendlandC2::gradient(0.5), 0.125);
  EXPECT_EQ(Lucy::weight(0.5), 0.3125);  // (1/2)^3 (1 + 3/2)
  EXPECT_EQ(Lucy::gradient(0.5), 0.25);
  EXPECT_EQ(MpsWeight::weight(0.5), 1.0);  // 1/q - 1
  EXPECT_EQ(MpsWeight::gradient(0.5), 4.0);
}

TEST(Kernel, value_at_the_particle_itself) {
  EXPECT_EQ(WendlandC2::weight(0.0), WendlandC2::self_weight);
  EXPECT_EQ(Lucy::weight(0.0), Lucy::self_weight);
  EXPECT_EQ(MpsWeight::self_weight, 0.0);
  EXPECT_TRUE(std::isfinite(MpsWeight::weight(0.0)) && std::isfinite(MpsWeight::gradient(0.0)));
}

TYPED_TEST(KernelTest, vanishes_at_the_cutoff) {
  EXPECT_EQ(TypeParam::weight(1.0), 0.0);
  EXPECT_EQ(TypeParam::gradient(1.0), 0.0);
}

TYPED_TEST(KernelTest, lanes_have_the_bits_of_double) {
  const Lanes q([](auto lane) { return 0.07 + 0.11 * static_cast<double>(lane); });
  const Lanes weight = TypeParam::weight(q), gradient = TypeParam::gradient(q);
  for (int lane = 0; lane < lane_count; ++lane) {
    EXPECT_EQ(weight[lane], TypeParam::weight(static_cast<double>(q[lane])));
    EXPECT_EQ(gradient[lane], TypeParam::gradient(static_cast<double>(q[lane])));
  }
}

/// -W'(q) / q by a central difference: error step^2 W''' / 6 + 1e-16 / step, both below 1e-8 of the slope.
template <class Kernel>
double slope_over_q(double q) {
  const double step = 1e-6;
  return (Kernel::weight(q - step) - Kernel::weight(q + step)) / (2.0 * step * q);
}

TEST(Kernel, gradient_is_the_slope_of_the_weight_but_for_the_mps_weight) {
  for (double q = 0.1; q < 0.95; q += 0.05) {
    EXPECT_NEAR(20.0 * WendlandC2::gradient(q), slope_over_q<WendlandC2>(q), 1e-7) << q;
    EXPECT_NEAR(12.0 * Lucy::gradient(q), slope_over_q<Lucy>(q), 1e-7) << q;
    EXPECT_DOUBLE_EQ(MpsWeight::gradient(q), MpsWeight::weight(q) / (q * q)) << q;
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
        density += scale.weight * Kernel::weight(q);
        identity += q * q * scale.gradient * Kernel::gradient(q);
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
