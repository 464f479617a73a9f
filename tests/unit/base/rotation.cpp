// Oracles: the mathematics library (for the two functions that replace it), and the closed form of Cayley's rotation.
#include "base/rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace mappm {
namespace {

TEST(UnitCircle, agrees_with_the_mathematics_library) {
  // 1e-15 is what the header promises: the argument's rounding and nine terms of a series.
  for (int i = -4096; i <= 4096; ++i) {
    const long double turns = i / 4096.0L;
    const long double angle = 2.0L * std::numbers::pi_v<long double> * turns;
    const Vec<2, double> point = unit_circle(static_cast<double>(turns));
    EXPECT_NEAR(point[0], static_cast<double>(std::cos(angle)), 1e-15) << turns;
    EXPECT_NEAR(point[1], static_cast<double>(std::sin(angle)), 1e-15) << turns;
  }
}

TEST(UnitCircle, has_exact_quarters_and_period_one) {
  EXPECT_EQ(unit_circle(0.0), (Vec<2, double>{{1.0, 0.0}}));
  EXPECT_EQ(unit_circle(0.25), (Vec<2, double>{{0.0, 1.0}}));
  EXPECT_EQ(unit_circle(0.5), (Vec<2, double>{{-1.0, 0.0}}));
  EXPECT_EQ(unit_circle(-0.25), (Vec<2, double>{{0.0, -1.0}}));
  EXPECT_EQ(unit_circle(0.3125), unit_circle(7.3125));
}

TEST(NaturalLog, agrees_with_the_mathematics_library) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-300.0, 300.0);
  for (int i = 0; i < 2000; ++i) {
    const double x = i < 1000 ? (i + 1) / 1000.0 : std::exp(exponent(random));
    const double expected = std::log(x);
    EXPECT_NEAR(natural_log(x), expected, 1e-15 * std::fabs(expected)) << x;
  }
  EXPECT_EQ(natural_log(1.0), 0.0);
}

TEST(Turn, is_cayleys_angle_in_the_plane) {
  // A turn by a advances the angle by 2 atan(a / 2). One turn has an error of two roundings.
  for (const double angle : {1e-9, 1e-3, -0.3, 2.0}) {
    const Rotation<2> turned = turn<2>(Rotation<2>{}, {{angle}});
    EXPECT_NEAR(std::atan2(turned.component[1], turned.component[0]), 2.0 * std::atan(0.5 * angle), 4e-16);
  }
}

TEST(Turn, is_cayleys_angle_about_the_axis_in_space) {
  const Vec<3, double> axis{{2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0}};
  const double angle = 0.4;
  const Rotation<3> turned = turn<3>(Rotation<3>{}, angle * axis);
  const double half = std::atan(0.5 * angle);  // of the quaternion: half the angle of the rotation
  EXPECT_NEAR(turned.component[0], std::cos(half), 4e-16);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(turned.component[i + 1], std::sin(half) * axis[i], 4e-16);
}

TEST(Turn, keeps_unit_length_over_many_steps) {
  Rotation<2> plane;
  Rotation<3> space;
  for (int i = 0; i < 100000; ++i) {
    plane = turn<2>(plane, {{0.01}});
    space = turn<3>(space, {{0.01, -0.02, 0.005}});
  }
  EXPECT_NEAR(dot(plane.component, plane.component), 1.0, 5e-16);  // normalised each step: no drift
  EXPECT_NEAR(dot(space.component, space.component), 1.0, 5e-16);
}

TEST(Turn, by_nothing_keeps_every_bit) {
  const Rotation<2> plane = turn<2>(Rotation<2>{}, {{0.7}});
  const Rotation<3> space = turn<3>(Rotation<3>{}, {{0.7, 0.1, -0.3}});
  EXPECT_EQ(turn<2>(plane, {{0.0}}).component, plane.component);
  EXPECT_EQ(turn<3>(space, {{0.0, -0.0, 0.0}}).component, space.component);
}

TEST(Rotate, quarter_turns_by_hand) {
  const Rotation<2> left{{{0.0, 1.0}}};
  EXPECT_EQ(rotate(left, {{1.0, 2.0}}), (Vec<2, double>{{-2.0, 1.0}}));
  const double root = std::sqrt(0.5);
  const Rotation<3> about_z{{{root, 0.0, 0.0, root}}};
  const Vec<3, double> turned = rotate(about_z, {{1.0, 2.0, 3.0}});
  EXPECT_NEAR(turned[0], -2.0, 1e-15);
  EXPECT_NEAR(turned[1], 1.0, 1e-15);
  EXPECT_NEAR(turned[2], 3.0, 1e-15);
}

TEST(Rotate, back_is_the_inverse_and_lengths_stay) {
  const Vec<3, double> v{{0.3, -1.7, 2.5}};
  const Rotation<3> rotation = turn<3>(turn<3>(Rotation<3>{}, {{1.0, 0.2, -0.4}}), {{0.0, -2.0, 0.3}});
  const Vec<3, double> there = rotate(rotation, v);
  const Vec<3, double> back = rotate_back(rotation, there);
  EXPECT_NEAR(dot(there, there), dot(v, v), 1e-14);  // |v|^2 = 9.2, some ten roundings
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(back[i], v[i], 4e-15);
}

TEST(Rotate, follows_the_velocity_of_rotation) {
  // d(R r)/dt = omega x (R r): a small turn against `rotational_velocity`; the remainder is angle^2 / 2.
  const AngularVec<3, double> omega{{0.2, -0.5, 0.7}};
  const Rotation<3> start = turn<3>(Rotation<3>{}, {{0.5, 0.4, -1.0}});
  const Vec<3, double> r{{1.0, 2.0, -1.0}};
  const double dt = 1e-5;
  const Vec<3, double> before = rotate(start, r);
  const Vec<3, double> after = rotate(turn<3>(start, dt * omega), r);
  const Vec<3, double> velocity = rotational_velocity<3>(omega, before);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR((after[i] - before[i]) / dt, velocity[i], 2e-5);
}

}  // namespace
}  // namespace mappm
