// Oracles: literals worked in plain Python, figures measured with LIGGGHTS 3.8 (`gran model hertz tangential history`)
// for impacts integrated here by velocity Verlet as its `fix nve/sphere` does, and Hertz' closed forms. SI units.
#include "physics/contact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace mappm {
namespace {

constexpr double pi = 3.14159265358979323846;

struct Sphere {
  double radius, mass;
};

constexpr Sphere make_sphere(double radius, double density) {
  return {radius, density * 4.0 / 3.0 * pi * radius * radius * radius};
}

/// The sphere of the measurements with LIGGGHTS: E 5e7 Pa, nu 0.3, d 1 mm, rho 2500 kg/m^3.
constexpr Sphere grain = make_sphere(0.5e-3, 2500.0);

ContactLaw hertz_law(double restitution, double friction) {
  return make_contact_law(ContactKind::hertz, 0.0, 5e7, 0.3, restitution, friction);
}

struct HeadOn {
  double restitution, duration, largest_overlap, largest_force;
};

/// Normal impact of two equal spheres, each with `speed`.
HeadOn collide(const ContactLaw& law, const Sphere& sphere, double speed, double dt) {
  HeadOn impact{};
  double overlap = 0.0, relative = -2.0 * speed;
  const auto acceleration = [&] {
    if (overlap <= 0.0) return 0.0;
    ContactPair<3> pair{};
    pair.normal[0] = 1.0;
    pair.overlap = overlap;
    pair.velocity[0] = relative;
    pair.inverse_mass_i = pair.inverse_mass_j = 1.0 / sphere.mass;
    pair.inverse_radius_i = pair.inverse_radius_j = 1.0 / sphere.radius;
    const double force = contact_force(law, pair, dt).force[0];
    impact.largest_force = std::max(impact.largest_force, force);
    return 2.0 / sphere.mass * force;
  };
  double now = 0.0;
  do {
    relative += 0.5 * dt * now;
    overlap -= dt * relative;
    now = acceleration();
    relative += 0.5 * dt * now;
    impact.duration += dt;
    impact.largest_overlap = std::max(impact.largest_overlap, overlap);
  } while (overlap > 0.0);
  impact.restitution = relative / (2.0 * speed);
  return impact;
}

TEST(HertzContact, head_on_impacts_agree_with_liggghts) {
  // Given and measured with a step of 1e-7 s. Measured to five digits (5e-6); where the first step falls: as much.
  const double table[][2] = {{0.3, 0.29984}, {0.5, 0.49997}, {0.7, 0.70004}, {0.9, 0.90001}, {1.0, 1.0}};
  for (const auto& [given, measured] : table)
    EXPECT_NEAR(collide(hertz_law(given, 0.0), grain, 0.1, 1e-7).restitution, measured, 1e-5) << given;
}

TEST(HertzContact, duration_and_overlap_are_those_of_hertz) {
  // Undamped: t = 2.87 (m*^2 / (R* E*^2 v))^(1/5) and d_max = (15 m* v^2 / (16 E* sqrt(R*)))^(2/5). 2.87 has three
  // digits (2.868); the step is 1/4000 of the duration.
  const ContactLaw law = hertz_law(1.0, 0.0);
  const double m = 0.5 * grain.mass, r = 0.5 * grain.radius, E = 5e7 / (2.0 * 0.91), v = 0.2;
  const HeadOn impact = collide(law, grain, 0.1, 1e-8);
  EXPECT_NEAR(contact_duration(law, m, r, v), 2.87 * std::pow(m * m / (r * E * E * v), 0.2), 1e-18);
  EXPECT_NEAR(impact.duration, contact_duration(law, m, r, v), 1.5e-3 * impact.duration);
  EXPECT_NEAR(impact.largest_overlap, std::pow(15.0 * m * v * v / (16.0 * E * std::sqrt(r)), 0.4),
              1e-5 * impact.largest_overlap);
  EXPECT_EQ(contact_duration(law, m, r, 0.0), HUGE_VAL);
}

TEST(HertzContact, two_glass_spheres_of_chung_and_ooi) {
  // Their test 1 (Granular Matter 13, 2011, 643): R 10 mm, 2800 kg/m^3, E 48 GPa, nu 0.2, 10 m/s each. Force: five
  // digits. Their duration of 40.36 us has the rounded factor 2.87; Hertz' integral gives 2.8683, hence 40.339 us.
  const ContactLaw glass = make_contact_law(ContactKind::hertz, 0.0, 48e9, 0.2, 1.0, 0.35);
  const HeadOn impact = collide(glass, make_sphere(0.01, 2800.0), 10.0, 1e-9);
  EXPECT_NEAR(impact.largest_force, 10697.0, 0.5);
  EXPECT_NEAR(impact.duration, 40.339e-6, 0.002e-6);  // a whole number of steps, one at each end
  EXPECT_NEAR(contact_duration(glass, 0.5 * make_sphere(0.01, 2800.0).mass, 0.005, 20.0), 40.36e-6, 0.005e-6);
}

TEST(LinearContact, duration_is_half_a_period_and_restitution_as_given) {
  const double k = 100.0, m = 0.5 * grain.mass;
  const ContactLaw elastic = make_contact_law(ContactKind::linear, k, 0.0, 0.0, 1.0, 0.0);
  EXPECT_DOUBLE_EQ(contact_duration(elastic, m, 1.0, 1.0), pi * std::sqrt(m / k));
  const HeadOn impact = collide(elastic, grain, 0.1, 1e-8);
  EXPECT_NEAR(impact.duration, pi * std::sqrt(m / k), 2e-8);
  EXPECT_NEAR(impact.largest_overlap, 0.2 * std::sqrt(m / k), 1e-5 * impact.largest_overlap);
  EXPECT_NEAR(impact.restitution, 1.0, 1e-5);
  // The damped oscillator gives e exactly in the limit of small steps, when the contact lasts half a damped period.
  for (const double e : {0.3, 0.6, 0.9}) {
    const ContactLaw law = make_contact_law(ContactKind::linear, k, 0.0, 0.0, e, 0.0);
    EXPECT_NEAR(collide(law, grain, 0.1, 1e-8).restitution, e, 1e-3);
  }
}

struct Rebound {
  double tangential, normal, spin;
};

/// A sphere of spin 0 that hits a plane obliquely with vt = along x and vn = downwards.
Rebound hit_wall(const ContactLaw& law, double vt, double vn, double dt) {
  Vec<3, double> v{{vt, 0.0, -vn}}, force, torque, stretch;
  Vec<3, double> omega;
  const auto [radius, mass] = grain;
  double height = radius;
  const double inertia = 0.4 * mass * radius * radius;
  do {
    v += (0.5 * dt / mass) * force;
    omega += (0.5 * dt / inertia) * torque;
    height += dt * v[2];
    if (height < radius) {
      const Vec<3, double> normal{{0.0, 0.0, 1.0}};
      const double overlap = radius - height;
      const Vec<3, double> lever = -((radius - 0.5 * overlap) * normal);
      const ContactPair<3> pair{
          normal, overlap, v + rotational_velocity<3>(omega, lever), 1.0 / mass, 0.0, 1.0 / radius, 0.0, stretch};
      const ContactResult<3> result = contact_force(law, pair, dt);
      force = result.force;
      stretch = result.stretch;
      torque = cross<3, double>(lever, force);
    }
    v += (0.5 * dt / mass) * force;
    omega += (0.5 * dt / inertia) * torque;
  } while (height < radius);
  return {v[0], v[2], omega[1]};
}

TEST(HertzContact, oblique_impacts_on_a_wall_agree_with_liggghts) {
  // Where in a step the contact starts is not known of the measurement; it moves the tangential velocity of a sliding
  // impact by 7e-5 m/s, of a sticking one by 2e-5, and the spin by 0.3 /s (0.4 % of what the impact changes).
  const Rebound sliding = hit_wall(hertz_law(0.8, 0.1), 0.5, 0.1, 1e-7);
  EXPECT_NEAR(sliding.tangential, 0.48176, 1e-4);
  EXPECT_NEAR(sliding.normal, 0.08000, 1e-5);
  EXPECT_NEAR(sliding.spin, 91.0, 0.4);
  const double table[][3] = {{0.02, 0.01672, 3e-5}, {0.1, 0.06476, 3e-5}, {0.5, 0.44507, 1e-4}};  // mu 0.3
  for (const auto& [before, after, tolerance] : table)
    EXPECT_NEAR(hit_wall(hertz_law(0.8, 0.3), before, 0.1, 1e-7).tangential, after, tolerance) << before;
}

template <int D>
void expect_result(const ContactResult<D>& result, const Vec<D, double>& force, const Vec<D, double>& stretch) {
  for (int axis = 0; axis < D; ++axis) {  // a dozen roundings; ln e is good to 1e-15
    EXPECT_NEAR(result.force[axis], force[axis], 1e-14);
    EXPECT_NEAR(result.stretch[axis], stretch[axis], 1e-17);
  }
}

// Literals: the formulas of LIGGGHTS' normal_model_hertz, normal_model_hooke and tangential_model_history evaluated
// once in Python with math.log and math.pi; E 1000, nu 1/4, k 200.
TEST(ContactForce, literals_in_space) {
  const ContactPair<3> pair{{{0.6, 0.0, 0.8}}, 0.01,      {{-0.3, 0.2, 0.1}}, 1.0 / 3.0,
                            1.0 / 5.0,         1.0 / 0.5, 1.0 / 0.75,         {{0.001, 0.002, -0.0005}}};
  const auto hertz = [](double mu) { return make_contact_law(ContactKind::hertz, 0.0, 1000.0, 0.25, 0.7, mu); };
  const auto linear = [](double e, double mu) { return make_contact_law(ContactKind::linear, 200.0, 0.0, 0.0, e, mu); };
  const Vec<3, double> stuck{{0.00064, 0.0022, -0.00048}};
  expect_result(contact_force(hertz(0.9), pair, 0.001),
                {{0.8099602443878324, -0.5093175263074066, 0.14884936505658308}}, stuck);
  expect_result(contact_force(hertz(0.1), pair, 0.001),
                {{0.34649149782280436, -0.05686273100741484, 0.4964509249803542}},
                {{0.00033032576239207115, 0.0011354948082227447, -0.00024774432179405336}});
  expect_result(contact_force(linear(0.7, 0.9), pair, 0.001),
                {{2.3827157525431026, -1.313810501695402, 1.2590947491522988}}, stuck);
  expect_result(contact_force(linear(1.0, 0.1), pair, 0.001),
                {{1.1453211099061273, -0.1879586846976874, 1.6410091675704046}},
                {{0.00027339445046936346, 0.000939793423488437, -0.00020504583785202265}});
}

TEST(ContactForce, literals_in_the_plane_against_a_wall) {
  const ContactPair<2> pair{{{0.6, 0.8}}, 0.02, {{-0.3, 0.1}}, 1.0 / 3.0, 0.0, 2.0, 0.0, {{0.001, -0.0005}}};
  const ContactLaw law = make_contact_law(ContactKind::hertz, 0.0, 1000.0, 0.25, 0.7, 0.9);
  expect_result(contact_force(law, pair, 0.001), {{1.8345192249714266, 0.8624269305045235}}, {{0.00064, -0.00048}});
}

TEST(ContactForce, is_antisymmetric_to_the_last_bit) {
  const ContactPair<3> pair{{{0.36, 0.48, 0.8}},      0.013, {{-0.37, 0.21, 0.11}}, 0.31, 0.23, 2.1, 1.3,
                            {{0.001, 0.002, -0.0017}}};
  const ContactPair<3> swapped{-pair.normal,        pair.overlap,          -pair.velocity,        pair.inverse_mass_j,
                               pair.inverse_mass_i, pair.inverse_radius_j, pair.inverse_radius_i, -pair.stretch};
  for (const double friction : {0.05, 5.0}) {
    const ContactLaw law = make_contact_law(ContactKind::hertz, 0.0, 1000.0, 0.25, 0.7, friction);
    const auto on_i = contact_force(law, pair, 0.01), on_j = contact_force(law, swapped, 0.01);
    EXPECT_EQ(on_i.force, -on_j.force);
    EXPECT_EQ(on_i.stretch, -on_j.stretch);
  }
}

TEST(ContactForce, friction_never_exceeds_coulombs_limit_while_the_spring_slides) {
  const ContactLaw law = make_contact_law(ContactKind::linear, 200.0, 0.0, 0.0, 1.0, 0.3);
  const ContactPair<2> pair{{{0.0, 1.0}}, 0.01, {{5.0, 0.0}}, 1.0, 1.0, 1.0, 1.0, {{1.0, 0.0}}};
  const auto result = contact_force(law, pair, 0.001);
  EXPECT_DOUBLE_EQ(result.force[1], 2.0);
  EXPECT_DOUBLE_EQ(result.force[0], -0.6);
  EXPECT_DOUBLE_EQ(result.stretch[0], 0.003);
}

TEST(ContactLaw, elastic_contact_has_no_damping) {
  EXPECT_EQ(make_contact_law(ContactKind::hertz, 0.0, 1.0, 0.3, 1.0, 0.0).damping, 0.0);
  // ln(1/2) / sqrt(ln^2(1/2) + pi^2)
  EXPECT_NEAR(make_contact_law(ContactKind::hertz, 0.0, 1.0, 0.3, 0.5, 0.0).damping, -0.2154537619662468, 1e-14);
}

}  // namespace
}  // namespace mappm
