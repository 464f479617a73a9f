// Oracles: the pair law in double precision, and the same pair from the other side.
#include "physics/pair_numbers.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "unit/physics/pair_setup.hpp"

namespace mappm {
namespace {

using testing::make_law;

constexpr double rest_density = 10.24;

/// A point anywhere in the box, moving at up to a tenth of the sound speed, its density within 2 % of that at rest.
template <int D>
PairPoint<D> random_point(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  PairPoint<D> point;
  for (int axis = 0; axis < D; ++axis) {
    point.x[axis] = std::floor(0.5 * (unit(random) + 1.0) * box_quanta);
    point.v[axis] = std::nearbyint(0.1 * unit(random) / velocity_quantum) * velocity_quantum;
  }
  point.volume = volume_terms(rest_density * (1.0 + 0.02 * unit(random)), rest_density, 1.0, 0.0);
  return point;
}

template <class Numbers, int D>
NeighbourSums<D> given(const Numbers& numbers, const PairPoint<D>& i, const PairPoint<D>& j) {
  const auto pair = pair_of(numbers, i, j, nearest_difference);
  return numbers.sums(testing::interact<WendlandC2, true>(numbers.law(), pair, static_cast<typename Numbers::Real>(1)));
}

template <class Numbers, int D>
std::int64_t density_given(const Numbers& numbers, const PairPoint<D>& i, const PairPoint<D>& j) {
  const auto pair = pair_of(numbers, i, j, nearest_difference);
  return numbers.density(testing::shared_density<WendlandC2>(numbers.law(), pair));
}

template <int D, class Fluid>
void expect_near_double(const Fluid& fluid) {
  const PairLaw<D> law = make_law<D, WendlandC2>(fluid);
  const DoublePairs<D> full(law, rest_density);
  const SinglePairs<D> single(law, rest_density);
  std::mt19937_64 random(7);
  for (int trial = 0; trial < 5000; ++trial) {
    const PairPoint<D> i = random_point<D>(random);
    PairPoint<D> j = random_point<D>(random);
    for (int axis = 0; axis < D; ++axis) {
      const double near = (j.x[axis] / box_quanta - 0.5) / law.length[axis];  // up to half a cutoff
      j.x[axis] = wrap_position(i.x[axis] + std::floor(near));
    }
    const NeighbourSums<D> exact = given(full, i, j), coarse = given(single, i, j);
    for (int axis = 0; axis < D; ++axis) {
      // Some roundings of 6e-8 of a pressure and a friction below 2e-3 m c, and one to 2^-26 m c.
      EXPECT_NEAR(static_cast<double>(coarse.impulse[axis]) * velocity_quantum,
                  static_cast<double>(exact.impulse[axis]) * velocity_quantum, 0x1p-27 + 2e-9);
      EXPECT_NEAR(static_cast<double>(coarse.shift[axis]) * law.length[axis],
                  static_cast<double>(exact.shift[axis]) * law.length[axis], 5e-9);
    }
    // G v^2 dt is far below what friction gives, and q^4 times it more so.
    EXPECT_NEAR(static_cast<double>(coarse.agitation) * velocity_quantum,
                static_cast<double>(exact.agitation) * velocity_quantum, 0x1p-27 + 2e-9);
    EXPECT_NEAR(static_cast<double>(coarse.shear) * velocity_quantum,
                static_cast<double>(exact.shear) * velocity_quantum, 0x1p-27 + 2e-9);
    EXPECT_NEAR(static_cast<double>(density_given(single, i, j)) * density_quantum,
                static_cast<double>(density_given(full, i, j)) * density_quantum, 1e-7 * rest_density);
  }
}

TEST(SinglePairs, are_near_those_in_double_precision) {
  expect_near_double<2>(testing::plane_fluid());
  expect_near_double<3>(testing::space_fluid());
}

TEST(SinglePairs, give_the_opposite_to_the_other) {
  const SinglePairs<2> single(make_law<2, WendlandC2>(testing::plane_fluid()), rest_density);
  std::mt19937_64 random(8);
  for (int trial = 0; trial < 5000; ++trial) {
    const PairPoint<2> i = random_point<2>(random), j = random_point<2>(random);
    const NeighbourSums<2> to_i = given(single, i, j), to_j = given(single, j, i);
    EXPECT_EQ(to_i.impulse, -to_j.impulse);
    EXPECT_EQ(to_i.shift, -to_j.shift);
    EXPECT_EQ(to_i.shear, to_j.shear);
    EXPECT_EQ(to_i.agitation, to_j.agitation);
    EXPECT_EQ(density_given(single, i, j), density_given(single, j, i));
  }
}

}  // namespace
}  // namespace mappm
