// Oracles: the pair law in double precision, scalars for the lanes, and whole boxes as images.
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

/// Boxes shorter and longer than the window of the places.
TEST(SinglePairs, see_one_distance_in_lanes_and_alone_whatever_the_image) {
  for (const double side : {2.1, 5.0, 7.9, 8.0, 100.0, 1e5, 1e8}) {
    SCOPED_TRACE(side);
    testing::Fluid<2> fluid = testing::plane_fluid();
    fluid.box = {side, 1.5 * side};
    const SinglePairs<2> single(make_law<2, WendlandC2>(fluid), rest_density);
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int trial = 0; trial < 200; ++trial)
      for (int axis = 0; axis < 2; ++axis) {
        const double cutoff = box_quanta / fluid.box[static_cast<std::size_t>(axis)];
        const double a = std::floor(0.5 * (unit(random) + 1.0) * (box_quanta - 1.0));
        const double b = std::nearbyint(a + unit(random) * cutoff);  // may lie outside the box: a ghost
        const float alone =
            single.difference(axis, nearest_difference(single.seen(axis, a), single.seen(axis, wrap_position(b))));
        EXPECT_EQ(single.difference(axis, single.seen(axis, a) - single.seen(axis, b)), alone);
        const Int32Lanes one(single.coordinate(axis, a)), other(single.coordinate(axis, b));
        EXPECT_EQ(SinglePairs<2>::apart(one, other)[0], alone);
        EXPECT_EQ(single.coordinate(axis, Lanes(b))[0], single.coordinate(axis, b));
        EXPECT_LE(std::fabs(static_cast<double>(alone * single.law().length[axis]) - (a - b) / cutoff), 2e-7);
      }
  }
}

}  // namespace
}  // namespace mappm
