// Oracles: values worked by hand, conservation, and the closed forms of free rotation: the precession of a symmetric
// top, and the period of any other body, by an elliptic integral.
#include "physics/rigid_body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace mappm {
namespace {

Int128 quanta(double value) { return to_fixed_wide(value / velocity_quantum); }

/// Half axes of inertia about 2, 5, 4 in the body's frame; mass 8.
Shape<3> make_top(double about_x, double about_y, double about_z) {
  Shape<3> shape;
  shape.mass = 8.0;
  shape.inverse_inertia[0] = 1.0 / about_x;
  shape.inverse_inertia[4] = 1.0 / about_y;
  shape.inverse_inertia[8] = 1.0 / about_z;
  return shape;
}

Shape<2> make_disc() {
  Shape<2> shape;
  shape.mass = 4.0;
  shape.inverse_inertia[0] = 0.5;
  return shape;
}

const Vec<2, double> plane_length{{4.0 / box_quanta, 8.0 / box_quanta}};
const Vec<3, double> space_length{{4.0 / box_quanta, 8.0 / box_quanta, 16.0 / box_quanta}};

TEST(RigidVelocity, by_hand_in_the_plane) {
  Solid<2> solid;
  solid.momentum = {{quanta(0.5), quanta(-1.0)}};
  solid.angular_momentum = {{quanta(0.25)}};
  const auto velocity = rigid_velocity(solid, make_disc());
  EXPECT_EQ(velocity.linear, (Vec<2, double>{{0.125, -0.25}}));
  EXPECT_EQ(velocity.angular[0], 0.125);
}

TEST(RigidVelocity, uses_the_inertia_in_the_bodys_frame) {
  // The body is turned by a quarter about z: its x axis (inertia 2) lies along y of the box, its y axis (5) along -x.
  Solid<3> solid;
  solid.orientation = {{{std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)}}};
  solid.angular_momentum = {{quanta(1.0), quanta(1.0), quanta(1.0)}};
  const auto velocity = rigid_velocity(solid, make_top(2.0, 5.0, 4.0));
  EXPECT_NEAR(velocity.angular[0], 0.2, 1e-15);
  EXPECT_NEAR(velocity.angular[1], 0.5, 1e-15);
  EXPECT_NEAR(velocity.angular[2], 0.25, 1e-15);
}

TEST(RigidVelocity, is_zero_about_a_held_orientation) {
  Shape<2> shape = make_disc();
  shape.rotates = false;
  Solid<2> solid;
  solid.angular_momentum = {{quanta(0.25)}};
  EXPECT_EQ(rigid_velocity(solid, shape).angular[0], 0.0);
}

TEST(Place, by_hand_in_the_plane) {
  Solid<2> solid;
  solid.x = {{box_quanta - 1.0, 100.0}};
  solid.orientation = {{{0.0, 1.0}}};
  const FrozenParticle<2> frozen{{{0.5, -0.25}}, {{0.0, -1.0}}, 0.125, 0.0};
  const auto placed = place(solid, RigidVelocity<2>{{{1.0, 2.0}}, {{4.0}}}, frozen, plane_length);
  // offset in the box: (1/4, 1/2) -> 2^52 / 16 quanta of 4 and 8; v = V + omega x offset
  EXPECT_EQ(placed.x, (Vec<2, double>{{box_quanta - 1.0 + box_quanta / 16.0, 100.0 + box_quanta / 16.0}}));
  EXPECT_EQ(placed.v, (Vec<2, double>{{1.0 - 2.0, 2.0 + 1.0}}));
  EXPECT_EQ(placed.normal, (Vec<2, double>{{1.0, 0.0}}));
  EXPECT_EQ(placed.lever, (Vec<2, double>{{0.25 + 0.125, 0.5}}));  // to the surface, 1/8 along the normal
}

TEST(Place, differs_between_frames_by_whole_boxes_only) {
  Solid<3> solid;
  solid.x = {{123456789.0, 3.0, box_quanta - 7.0}};
  solid.orientation = turn<3>(Rotation<3>{}, {{0.3, -0.7, 0.2}});
  Solid<3> image = solid;
  image.x[0] += box_quanta;
  image.x[2] -= box_quanta;
  const FrozenParticle<3> frozen{{{0.51, -0.23, 0.77}}, {{0.6, 0.0, 0.8}}, 0.1, 0.0};
  const RigidVelocity<3> velocity{{{0.1, 0.2, 0.3}}, {{-0.4, 0.5, 0.6}}};
  const auto here = place(solid, velocity, frozen, space_length);
  const auto there = place(image, velocity, frozen, space_length);
  EXPECT_EQ(there.x - here.x, (Vec<3, double>{{box_quanta, 0.0, -box_quanta}}));
  EXPECT_EQ(there.v, here.v);
  EXPECT_EQ(there.normal, here.normal);
}

/// The couple is mu times the integral over the surface of x cross (n cross omega), summed here over points of a circle
/// and of a sphere.
template <int D>
double couple_over_the_surface(double omega) {
  const double pi = 3.14159265358979323846, radius = 0.75;
  const int rings = 400;
  double sum = 0.0;
  for (int k = 0; k < rings; ++k) {
    if constexpr (D == 2) {
      sum += 2.0 * pi * radius / rings * -radius * omega;  // x cross (n cross omega) = -R omega in the plane
    } else {
      const double height = (2.0 * k + 1.0) / rings - 1.0;  // bands of equal area; omega along z
      sum += 4.0 * pi * radius * radius / rings * radius * (height * height - 1.0) * omega;
    }
  }
  return sum;
}

template <int D>
void expect_couple_of_a_ball() {
  const double pi = 3.14159265358979323846, radius = 0.75, viscosity = 0.3, dt = 0.125, omega = -0.6;
  Shape<D> shape;
  shape.volume = D == 2 ? pi * radius * radius : 4.0 / 3.0 * pi * radius * radius * radius;
  AngularVec<D, double> turning;
  turning[angular_components<D> - 1] = omega;
  const auto couple = stress_couple(viscosity, shape, turning, dt);
  const double expected = viscosity * couple_over_the_surface<D>(omega) * dt;
  EXPECT_NEAR(static_cast<double>(couple[angular_components<D> - 1]) * velocity_quantum, expected, 1e-5 * expected);
  EXPECT_GT(expected, 0.0);  // against the rotation
  for (int i = 0; i + 1 < angular_components<D>; ++i) EXPECT_EQ(couple[i], 0);
}

TEST(StressCouple, of_a_ball_is_the_integral_over_its_surface) {
  expect_couple_of_a_ball<2>();
  expect_couple_of_a_ball<3>();
}

TEST(TorqueImpulse, by_hand_and_rounded) {
  EXPECT_TRUE((torque_impulse<2>({{0.5, 0.25}}, {{10.0, 20.0}})[0]) == 8);  // 7.5, a tie to even
  const auto torque = torque_impulse<3>({{1.0, 2.0, 3.0}}, {{4.0, 5.0, 0x1p70}});
  EXPECT_TRUE(torque[0] == (Int128{1} << 71));  // 2 * 2^70 - 15, and 15 is below the last bit of that double
  EXPECT_TRUE(torque[1] == -(Int128{1} << 70));
  EXPECT_TRUE(torque[2] == -3);
}

TEST(Advance, kicks_then_drifts_and_wraps) {
  Solid<2> solid;
  solid.x = {{box_quanta - 2.0, 5.0}};
  SolidImpulse<2> impulse;
  impulse.linear = {{quanta(1.0), quanta(-2.0)}};  // V = (1/4, -1/2)
  advance(solid, make_disc(), impulse, 0.0625, plane_length);
  EXPECT_TRUE(solid.momentum == impulse.linear);
  EXPECT_EQ(solid.x[0], box_quanta / 256.0 - 2.0);               // 1/64 of a side of 4
  EXPECT_EQ(solid.x[1], box_quanta - box_quanta / 256.0 + 5.0);  // -1/32 of a side of 8
  EXPECT_EQ(solid.orientation.component, Rotation<2>{}.component);
}

TEST(Advance, fixed_and_moving_solids_take_no_impulse) {
  SolidImpulse<2> impulse;
  impulse.linear = {{quanta(1.0), quanta(1.0)}};
  impulse.angular = {{quanta(1.0)}};
  Solid<2> solid;
  solid.momentum = {{quanta(0.5), quanta(0.0)}};
  solid.angular_momentum = {{quanta(0.25)}};
  solid.motion = SolidMotion::fixed;
  Solid<2> before = solid;
  advance(solid, make_disc(), impulse, 0.125, plane_length);
  EXPECT_EQ(solid.x, before.x);
  EXPECT_TRUE(solid.momentum == before.momentum);
  EXPECT_EQ(solid.orientation.component, before.orientation.component);

  solid.motion = SolidMotion::moving;
  advance(solid, make_disc(), impulse, 0.125, plane_length);
  EXPECT_TRUE(solid.momentum == before.momentum);
  EXPECT_TRUE(solid.angular_momentum == before.angular_momentum);
  EXPECT_EQ(solid.x[0], box_quanta / 256.0);                    // V dt = 1/64 of a side of 4
  EXPECT_NEAR(solid.orientation.component[1], 0.015625, 1e-6);  // omega dt = 1/64, sine of it within angle^3 / 6
}

TEST(Advance, holds_the_orientation_of_what_does_not_rotate) {
  Shape<2> shape = make_disc();
  shape.rotates = false;
  Solid<2> solid;
  SolidImpulse<2> impulse;
  impulse.linear[0] = quanta(1.0);
  impulse.angular[0] = quanta(1.0);
  advance(solid, shape, impulse, 0.125, plane_length);
  EXPECT_TRUE(solid.angular_momentum[0] == 0);
  EXPECT_TRUE(solid.momentum[0] == quanta(1.0));
  EXPECT_EQ(solid.orientation.component, Rotation<2>{}.component);
}

TEST(Advance, free_flight_keeps_momentum_and_a_straight_path) {
  Solid<2> solid;
  solid.momentum = {{quanta(0.4), quanta(0.2)}};
  solid.angular_momentum = {{quanta(0.1)}};
  const Vec<2, Int128> start = solid.momentum;
  for (int step = 0; step < 1000; ++step) advance(solid, make_disc(), SolidImpulse<2>{}, 0.01, plane_length);
  EXPECT_TRUE(solid.momentum == start);
  // V t = (1, 1/2) in a box of 4 x 8; a thousand roundings of half a quantum
  EXPECT_NEAR(solid.x[0], box_quanta / 4.0, 500.0);
  EXPECT_NEAR(solid.x[1], box_quanta / 16.0, 500.0);
  // a thousand turns of 2 atan(omega dt / 2); a rounding or two a step
  const double angle = 2000.0 * std::atan(0.5 * 0.05 * 0.01);
  EXPECT_NEAR(std::atan2(solid.orientation.component[1], solid.orientation.component[0]), angle, 2e-13);
}

/// Turns a free symmetric top (inertia 3, 3, 2) for one time unit; returns its symmetry axis.
Vec<3, double> symmetry_axis_after_unit_time(int steps) {
  const Shape<3> shape = make_top(3.0, 3.0, 2.0);
  Solid<3> solid;
  solid.orientation = turn<3>(Rotation<3>{}, {{0.8, 0.0, 0.0}});
  solid.angular_momentum = {{quanta(0.0), quanta(0.0), quanta(6.0)}};
  const auto start = solid.angular_momentum;
  for (int step = 0; step < steps; ++step) advance(solid, shape, SolidImpulse<3>{}, 1.0 / steps, space_length);
  EXPECT_TRUE(solid.angular_momentum == start);
  return rotate(solid.orientation, {{0.0, 0.0, 1.0}});
}

TEST(Advance, free_top_precesses_at_the_rate_of_the_closed_form) {
  // The axis of a symmetric top precesses about L at L / I1 = 2 rad per unit time, at a constant angle.
  const Vec<3, double> start = rotate(turn<3>(Rotation<3>{}, {{0.8, 0.0, 0.0}}), {{0.0, 0.0, 1.0}});
  const Vec<3, double> expected{{start[0] * std::cos(2.0) - start[1] * std::sin(2.0),
                                 start[0] * std::sin(2.0) + start[1] * std::cos(2.0), start[2]}};
  double error[2];
  for (int k = 0; k < 2; ++k) {
    const Vec<3, double> difference = symmetry_axis_after_unit_time(k == 0 ? 2000 : 4000) - expected;
    error[k] = std::sqrt(dot(difference, difference));
  }
  EXPECT_LT(error[0], 1e-6);
  EXPECT_NEAR(error[0] / error[1], 4.0, 0.05);  // second order in dt
}

/// A body in free rotation: axes of inertia, angular velocity at the start in the body's frame.
struct FreeBody {
  Vec<3, double> inertia, omega;

  /// Turns it for a number of turns by `angle` a step; calls after_step(solid, shape, dt) after each.
  template <class AfterStep>
  void rotate_freely(double angle, int turns, const AfterStep& after_step) const {
    const Shape<3> shape = make_top(inertia[0], inertia[1], inertia[2]);
    const double dt = angle / std::sqrt(dot(omega, omega));
    Solid<3> solid;
    for (int axis = 0; axis < 3; ++axis) solid.angular_momentum[axis] = quanta(inertia[axis] * omega[axis]);
    const auto start = solid.angular_momentum;
    const int steps = static_cast<int>(2.0 * 3.14159265358979323846 * turns / angle);
    for (int step = 0; step < steps; ++step) {
      advance(solid, shape, SolidImpulse<3>{}, dt, space_length);
      after_step(solid, shape, dt);
    }
    EXPECT_TRUE(solid.angular_momentum == start);  // integers that the rotation leaves alone
  }

  /// Largest |E / E0 - 1|.
  double energy_error(double angle, int turns) const {
    double twice_start = 0.0, error = 0.0;
    for (int axis = 0; axis < 3; ++axis) twice_start += inertia[axis] * omega[axis] * omega[axis];
    rotate_freely(angle, turns, [&](const Solid<3>& solid, const Shape<3>& shape, double) {
      Vec<3, double> momentum;
      for (int axis = 0; axis < 3; ++axis)
        momentum[axis] = static_cast<double>(solid.angular_momentum[axis]) * velocity_quantum;
      const double twice = dot(momentum, rigid_velocity(solid, shape).angular);
      error = std::fmax(error, std::fabs(twice / twice_start - 1.0));
    });
    return error;
  }

  /// Mean time between two zeros of omega about the body's y axis, over 100 turns by `angle` a step.
  double half_period(double angle) const {
    double time = 0.0, first = 0.0, last = 0.0, before = omega[1];
    int zeros = 0;
    rotate_freely(angle, 100, [&](const Solid<3>& solid, const Shape<3>& shape, double dt) {
      const double now = rotate_back(solid.orientation, rigid_velocity(solid, shape).angular)[1];
      if ((now > 0.0) != (before > 0.0)) {
        last = time + dt * before / (before - now);
        if (zeros++ == 0) first = last;
      }
      before = now;
      time += dt;
    });
    EXPECT_GE(zeros, 3);
    return (last - first) / (zeros - 1);
  }

  /// The same in closed form, of three moments of inertia in ascending order: Landau and Lifshitz, Mechanics, section
  /// 37, for L^2 > 2 E I2; else the first axis and the third change places.
  double closed_half_period() const {
    double twice_energy = 0.0, square = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double momentum = inertia[axis] * omega[axis];
      twice_energy += momentum * omega[axis];
      square += momentum * momentum;
    }
    double first = inertia[0], third = inertia[2];
    const double middle = inertia[1];
    if (square < twice_energy * middle) std::swap(first, third);
    const double rate = (third - middle) * (square - twice_energy * first);
    const double modulus = std::sqrt((middle - first) * (twice_energy * third - square) / rate);
    return 2.0 * std::comp_ellint_1(modulus) * std::sqrt(first * middle * third / rate);
  }
};

const FreeBody dumbbell{{{0.4, 2.4, 2.4}}, {{0.6, 0.3, 0.7}}};
const FreeBody three_balls{{{1.0, 2.0, 2.6}}, {{0.5, 0.6, 0.4}}};
const FreeBody near_its_middle_axis{{{1.0, 2.0, 2.6}}, {{1e-3, 1.0, 1e-3}}};  // it overturns again and again
const FreeBody needle{{{0.02, 1.0, 1.0}}, {{0.9, 0.4, 0.1}}};

TEST(FreeRotation, keeps_its_energy) {
  for (const FreeBody& body : {dumbbell, three_balls, near_its_middle_axis, needle}) {
    EXPECT_LT(body.energy_error(0.01, 100), 1e-12);  // 62832 steps, a rounding or two each, up and down alike
    // In coarser steps, what seven iterations leave; the needle has most of it, 2e-11 and 3e-7.
    EXPECT_LT(body.energy_error(0.1, 100), 1e-10);
    EXPECT_LT(body.energy_error(0.3, 100), 1e-6);
  }
}

TEST(FreeRotation, does_not_drift_from_its_energy) {
  for (const FreeBody& body : {dumbbell, three_balls, near_its_middle_axis})
    EXPECT_LT(body.energy_error(0.05, 1000), 1e-12);
}

TEST(FreeRotation, has_the_period_of_the_closed_form_in_second_order) {
  for (const FreeBody& body : {three_balls, near_its_middle_axis}) {
    const double expected = body.closed_half_period();
    const double error = body.half_period(0.02) / expected - 1.0;
    EXPECT_LT(std::fabs(error), 1e-4);
    EXPECT_NEAR(error / (body.half_period(0.01) / expected - 1.0), 4.0, 0.1);
  }
}

TEST(FreeRotation, of_a_ball_is_about_its_own_omega_to_the_last_bit) {
  const Shape<3> shape = make_top(3.3, 3.3, 3.3);
  Solid<3> solid;
  solid.angular_momentum = {{quanta(0.7), quanta(-1.1), quanta(1e-9)}};  // the last shows roundings of the others
  for (int step = 0; step < 100; ++step) {
    const Rotation<3> expected = turn(solid.orientation, 0.05 * rigid_velocity(solid, shape).angular);
    advance(solid, shape, SolidImpulse<3>{}, 0.05, space_length);
    EXPECT_EQ(solid.orientation.component, expected.component);
  }
}

}  // namespace
}  // namespace mappm
