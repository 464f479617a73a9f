// Oracles: impulses worked by hand on a model of round numbers, and Newton's third law to the last bit.
#include "particles/solid_step.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "unit/particles/hand_model.hpp"

namespace mappm {
namespace {

using testing::hand_dt;
using testing::hand_model;
using testing::hand_solid;
using testing::quanta;

template <int D>
struct Both {
  SolidLoad<D> on_first, on_second;
};

template <int D>
Both<D> touch(const Model<D>& model, const Solid<D>& first, const Solid<D>& second) {
  const SolidInStep<D> a = solid_in_step(model, first), b = solid_in_step(model, second);
  Both<D> loads;
  add_contacts(model, b, a, loads.on_second);
  add_contacts(model, a, b, loads.on_first);
  return loads;
}

TEST(SolidContact, head_on_by_hand) {
  // Centres 1.875 apart: overlap 1/8, force 12.5 along x, no torque.
  const Model<2> model = hand_model<2>();
  const Both<2> loads =
      touch(model, hand_solid(model, 3, 0, {{2.0, 4.0}}, {}), hand_solid(model, 5, 0, {{3.875, 4.0}}, {}));
  EXPECT_TRUE(loads.on_first.contact.linear[0] == -quanta(12.5));
  EXPECT_TRUE(loads.on_second.contact.linear[0] == quanta(12.5));
  EXPECT_TRUE(loads.on_first.contact.linear[1] == 0);
  EXPECT_TRUE(loads.on_first.contact.angular[0] == 0);
  ASSERT_EQ(loads.on_first.kept.size(), 1u);
  EXPECT_EQ(loads.on_first.kept[0].partner, 5u);
  EXPECT_EQ(loads.on_second.kept[0].partner, 3u);
}

TEST(SolidContact, sliding_gives_friction_and_torque_by_hand) {
  // The second moves along y with 1/4: at the contact point the first is the slower one by 1/4, the spring stretches to
  // -1/128 and pulls the first with 25/32 along y. Lever of both 1 - 1/16 = 15/16 towards each other.
  const Model<2> model = hand_model<2>();
  const Both<2> loads =
      touch(model, hand_solid(model, 0, 0, {{2.0, 4.0}}, {}), hand_solid(model, 1, 0, {{3.875, 4.0}}, {{0.0, 0.25}}));
  EXPECT_TRUE(loads.on_first.contact.linear[1] == quanta(0.78125));
  EXPECT_TRUE(loads.on_second.contact.linear[1] == -quanta(0.78125));
  EXPECT_TRUE(loads.on_first.contact.angular[0] == quanta(0.78125 * 0.9375));
  EXPECT_TRUE(loads.on_second.contact.angular[0] == quanta(0.78125 * 0.9375));
  EXPECT_EQ(loads.on_first.kept[0].stretch, (Vec<2, double>{{0.0, -0.0078125}}));
  EXPECT_EQ(loads.on_second.kept[0].stretch, loads.on_first.kept[0].stretch);
}

TEST(SolidContact, the_kept_stretch_is_taken_up_again) {
  const Model<2> model = hand_model<2>();
  Solid<2> first = hand_solid(model, 0, 0, {{2.0, 4.0}}, {}), second = hand_solid(model, 1, 0, {{3.875, 4.0}}, {});
  first.contacts = {{1, 0, 0, {{0.0, -0.0078125}}}};
  second.contacts = {{0, 0, 0, {{0.0, -0.0078125}}}};
  const Both<2> loads = touch(model, first, second);
  EXPECT_TRUE(loads.on_first.contact.linear[1] == quanta(0.78125));
  EXPECT_TRUE(loads.on_second.contact.linear[1] == -quanta(0.78125));
}

TEST(SolidContact, reaches_through_the_periodic_border) {
  const Model<2> model = hand_model<2>();
  const Both<2> loads =
      touch(model, hand_solid(model, 1, 0, {{0.5, 4.0}}, {}), hand_solid(model, 0, 0, {{6.625, 4.0}}, {}));
  EXPECT_TRUE(loads.on_first.contact.linear[0] == quanta(12.5));  // pushed away from the border, to larger x
  EXPECT_TRUE(loads.on_second.contact.linear[0] == -quanta(12.5));
}

TEST(SolidContact, none_beyond_touch) {
  const Model<2> model = hand_model<2>();
  const Both<2> loads =
      touch(model, hand_solid(model, 0, 0, {{2.0, 4.0}}, {}), hand_solid(model, 1, 0, {{4.0, 4.0}}, {}));
  EXPECT_TRUE(loads.on_first.contact.linear == (Vec<2, Int128>{}));
  EXPECT_TRUE(loads.on_first.kept.empty());
}

TEST(SolidContact, names_the_balls_that_touch) {
  // A dumb-bell at 2, its front ball at 2.75; the other turned by half a turn, so that its ball 0 points back,
  // to 3.625.
  const Model<2> model = hand_model<2>();
  const Solid<2> first = hand_solid(model, 0, 1, {{2.0, 4.0}}, {});
  Solid<2> second = hand_solid(model, 1, 1, {{4.375, 4.0}}, {});
  second.orientation.component = {{-1.0, 0.0}};
  const Both<2> loads = touch(model, first, second);
  ASSERT_EQ(loads.on_first.kept.size(), 1u);
  EXPECT_EQ(loads.on_first.kept[0].own, 0u);
  EXPECT_EQ(loads.on_first.kept[0].other, 0u);
  EXPECT_TRUE(loads.on_first.contact.linear[0] == -quanta(12.5));
  second.orientation.component = {{1.0, 0.0}};
  const Both<2> turned = touch(model, first, second);
  ASSERT_EQ(turned.on_second.kept.size(), 1u);
  EXPECT_EQ(turned.on_second.kept[0].own, 1u);
  EXPECT_EQ(turned.on_second.kept[0].other, 0u);
  EXPECT_EQ(turned.on_first.kept[0].own, 0u);
  EXPECT_EQ(turned.on_first.kept[0].other, 1u);
}

TEST(SolidContact, balls_that_touch_at_once_share_the_mass) {
  // A dumb-bell that lands flat on a wide one, 3/4 of the way: two contacts, each of overlap 1/8 as above, and each
  // damped as half of the mass: together 2 k and the dashpot of one contact of stiffness 2 k.
  Model<2> model = hand_model<2>();
  model.shapes[0].balls = {{{{0.75}}, 1.0, 1.0}, {{{-0.75}}, 1.0, 1.0}};
  model.shapes[0].reach = 1.75;
  model.contact = make_contact_law(ContactKind::linear, 100.0, 0.0, 0.0, 0.8, 0.0);
  const Solid<2> low = hand_solid(model, 0, 0, {{4.0, 2.0}}, {});
  const Solid<2> high = hand_solid(model, 1, 1, {{4.0, 3.375}}, {{0.0, -0.25}});
  const Both<2> loads = touch(model, low, high);
  ASSERT_EQ(loads.on_first.kept.size(), 2u);
  const double effective = 1.0 / (1.0 / 2.0 + 1.0 / 4.0), stiffness = 2.0 * 100.0;
  const double force = stiffness * 0.125 - 2.0 * model.contact.damping * std::sqrt(effective * stiffness) * 0.25;
  const double impulse = static_cast<double>(loads.on_second.contact.linear[1]) * velocity_quantum;
  EXPECT_NEAR(impulse, force * hand_dt, 1e-12);
}

TEST(Overlap, the_deepest_is_kept_whichever_comes_first) {
  const Overlap shallow{0.1, 1, 2.0}, deep{0.2, 5, 6.0}, same{0.2, 5, 3.0}, face{0.2, 5, Overlap::of_face(1)};
  for (const auto& all : {std::vector{shallow, deep, same, face}, {face, same, deep, shallow}, {deep, face, shallow}}) {
    Overlap kept;
    for (const Overlap& overlap : all) kept.add(overlap);
    EXPECT_EQ(kept.depth, 0.2);
    EXPECT_EQ(Overlap::face_of(kept.partner), 1u);
  }
}

TEST(Overlap, is_noted_with_step_and_solids_once_it_passes_a_bound) {
  const Model<2> model = hand_model<2>();
  FirstOverlaps first;
  const auto meet = [&](double distance, std::uint64_t step) {
    const Both<2> loads =
        touch(model, hand_solid(model, 7, 0, {{2.0, 4.0}}, {}), hand_solid(model, 3, 0, {{2.0 + distance, 4.0}}, {}));
    note_overlaps(model, step, std::vector{loads.on_first, loads.on_second}, first);
  };
  meet(1.90625, 10);  // overlap 3/32 of the radius 1
  EXPECT_TRUE(first.doubtful.text.empty());
  meet(1.75, 11);
  EXPECT_EQ(first.doubtful.step, 11.0);
  EXPECT_EQ(first.doubtful.text.find("step 11: solids 3 and 7 overlap by 0.25 of the smaller contact radius, more than "
                                     "0.1: "),
            0u)
      << first.doubtful.text;
  EXPECT_NE(first.doubtful.text.find("raise contact.stiffness"), std::string::npos);
  meet(1.625, 12);
  EXPECT_EQ(first.doubtful.step, 11.0);
  EXPECT_TRUE(first.last.text.empty());
  meet(1.4375, 13);
  EXPECT_EQ(first.last.text.find("step 13: solids 3 and 7 overlap by 0.562 "), 0u) << first.last.text;
}

TEST(FinishStep, tells_of_contacts_that_would_be_missed) {
  const Model<2> model = hand_model<2>();
  Vec<2, Int128> outside{};
  const auto end_of = [&](double speed) {
    Solid<2> solid = hand_solid(model, 4, 1, {{4.0, 4.0}}, {{speed, 0.0}});
    return finish_step(model, 6, solid, SolidLoad<2>{}, outside);
  };
  EXPECT_EQ(end_of(7.0), "");  // 7/32 rcut of a ball of 1/2
  Model<2> small = model;
  small.shapes[1].balls[1].contact_radius = 0.25;
  Solid<2> solid = hand_solid(small, 4, 1, {{4.0, 4.0}}, {{7.0, 0.0}});
  const std::string message = finish_step(small, 6, solid, SolidLoad<2>{}, outside);
  EXPECT_EQ(message.find("step 6: solid 4: moves 0.875 of its contact radius in one step, more than 0.5: "), 0u)
      << message;
}

TEST(Overlap, with_a_wall_names_its_face) {
  Model<2> model = hand_model<2>();
  model.faces = {{77, 0, 1.0, 1.0 / model.pair.length[0], 1.0, {}}, {78, 1, 1.0, 1.5 / model.pair.length[1], 1.0, {}}};
  model.units.length = 2.0;
  const Solid<2> solid = hand_solid(model, 4, 0, {{4.0, 2.25}}, {});
  std::vector<SolidLoad<2>> loads(1);
  add_face_contacts(model, solid_in_step(model, solid), loads[0]);
  FirstOverlaps first;
  note_overlaps(model, 5, loads, first);
  EXPECT_EQ(first.doubtful.text.find("step 5: solid 4 and the wall at y = 3 overlap by 0.25 "), 0u)
      << first.doubtful.text;
}

template <int D>
void expect_opposite_impulses(const ContactLaw& law) {
  Model<D> model = hand_model<D>();
  model.contact = law;
  std::mt19937_64 random(99);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::size_t contacts = 0;
  for (int n = 0; n < 300; ++n) {
    Vec<D, double> x, apart, v, w;
    for (int axis = 0; axis < D; ++axis) {
      x[axis] = 4.0 + 3.9 * unit(random);
      apart[axis] = 1.1 * unit(random);
      v[axis] = 0.3 * unit(random);
      w[axis] = 0.3 * unit(random);
    }
    Solid<D> first = hand_solid(model, 20 + random() % 5, random() % 2, x, v);
    Solid<D> second = hand_solid(model, 10 + random() % 20, random() % 2, x + apart, w);
    if (first.id == second.id) continue;
    for (Solid<D>* solid : {&first, &second})
      for (int i = 0; i < angular_components<D>; ++i) solid->angular_momentum[i] = quanta(10.0 * unit(random));
    first.orientation = turn(first.orientation, 0.7 * rigid_velocity(second, model.shapes[0]).angular);
    const Both<D> loads = touch(model, first, second);
    ASSERT_TRUE(loads.on_first.contact.linear == -loads.on_second.contact.linear);
    ASSERT_EQ(loads.on_first.kept.size(), loads.on_second.kept.size());
    contacts += loads.on_first.kept.size();
    for (std::size_t k = 0; k < loads.on_first.kept.size(); ++k) {
      const Contact<D>&a = loads.on_first.kept[k], &b = loads.on_second.kept[k];
      ASSERT_EQ(a.partner, second.id);
      ASSERT_EQ(b.partner, first.id);
      ASSERT_EQ(a.own, b.other);
      ASSERT_EQ(a.other, b.own);
      ASSERT_EQ(a.stretch, b.stretch);
    }
  }
  EXPECT_GT(contacts, 100u);
}

TEST(SolidContact, is_equal_and_opposite_to_the_last_bit_whichever_is_evaluated_first) {
  const ContactLaw linear = make_contact_law(ContactKind::linear, 137.0, 0.0, 0.0, 0.83, 0.3);
  const ContactLaw hertz = make_contact_law(ContactKind::hertz, 0.0, 1234.5, 0.27, 0.83, 0.3);
  expect_opposite_impulses<2>(linear);
  expect_opposite_impulses<3>(hertz);
}

TEST(FaceContact, by_hand) {
  // Centre 7/8 above an upward face at y = 1: force 12.5 up. Sliding along x with 1/4: friction 25/32 against it, whose
  // torque about the centre with the lever (0, -15/16) is -(15/16) (25/32).
  Model<2> model = hand_model<2>();
  model.faces = {{77, 1, 1.0, 1.0 / model.pair.length[1], 1.0, {}}};
  const Solid<2> solid = hand_solid(model, 0, 0, {{2.0, 1.875}}, {{0.25, 0.0}});
  SolidLoad<2> load;
  add_face_contacts(model, solid_in_step(model, solid), load);
  EXPECT_TRUE(load.wall.linear[0] == -quanta(0.78125));
  EXPECT_TRUE(load.wall.linear[1] == quanta(12.5));
  EXPECT_TRUE(load.wall.angular[0] == -quanta(0.78125 * 0.9375));
  EXPECT_TRUE(load.contact.linear == (Vec<2, Int128>{}));
  ASSERT_EQ(load.kept.size(), 1u);
  EXPECT_EQ(load.kept[0].partner, 77u);
  EXPECT_EQ(load.kept[0].stretch, (Vec<2, double>{{0.0078125, 0.0}}));
}

TEST(FaceContact, a_face_that_moves_along_does_not_rub_and_the_other_side_pushes_down) {
  Model<2> model = hand_model<2>();
  model.faces = {{77, 1, -1.0, 6.0 / model.pair.length[1], 1.0, {{0.25, 0.0}}}};
  const Solid<2> solid = hand_solid(model, 0, 0, {{2.0, 5.125}}, {{0.25, 0.0}});
  SolidLoad<2> load;
  add_face_contacts(model, solid_in_step(model, solid), load);
  EXPECT_TRUE(load.wall.linear[0] == 0);
  EXPECT_TRUE(load.wall.linear[1] == -quanta(12.5));
  const Solid<2> above = hand_solid(model, 0, 0, {{2.0, 7.5}}, {});  // behind the face, out of reach
  SolidLoad<2> none;
  add_face_contacts(model, solid_in_step(model, above), none);
  EXPECT_TRUE(none.kept.empty());
}

TEST(FaceContact, a_ball_beyond_the_middle_of_the_wall_is_left_to_the_other_face) {
  // A wall of thickness 1 below y = 1. The ball's centre is 3/8 below the face, then 5/8.
  Model<2> model = hand_model<2>();
  model.faces = {{77, 1, 1.0, 1.0 / model.pair.length[1], 1.0, {}}};
  const Solid<2> shallow = hand_solid(model, 0, 0, {{2.0, 0.625}}, {}),
                 deep = hand_solid(model, 0, 0, {{2.0, 0.375}}, {});
  SolidLoad<2> pushed, left;
  add_face_contacts(model, solid_in_step(model, shallow), pushed);
  EXPECT_TRUE(pushed.wall.linear[1] == quanta(137.5));  // overlap 1 3/8
  add_face_contacts(model, solid_in_step(model, deep), left);
  EXPECT_TRUE(left.kept.empty());
}

TEST(SolidContact, two_that_cannot_move_do_not_touch) {
  Model<2> model = hand_model<2>();
  model.faces = {{77, 1, 1.0, 3.5 / model.pair.length[1], 1.0, {}}};
  Solid<2> first = hand_solid(model, 0, 0, {{2.0, 4.0}}, {}), second = hand_solid(model, 1, 0, {{3.875, 4.0}}, {});
  first.motion = SolidMotion::fixed;
  second.motion = SolidMotion::moving;
  const Both<2> loads = touch(model, first, second);
  EXPECT_TRUE(loads.on_first.kept.empty());
  EXPECT_TRUE(loads.on_second.contact.linear == (Vec<2, Int128>{}));
  SolidLoad<2> load;
  add_face_contacts(model, solid_in_step(model, first), load);
  EXPECT_TRUE(load.kept.empty());
}

TEST(FinishStep, body_force_kicks_a_free_solid_after_the_relaxation) {
  // mass 2, acceleration (1/2, -1/4): force (1, -1/2).
  Model<2> model = hand_model<2>();
  model.terms.body_force = true;
  model.relax = 5;
  model.solid_acceleration = {{0.5, -0.25}};
  Solid<2> solid = hand_solid(model, 0, 0, {{2.0, 4.0}}, {});
  Vec<2, Int128> outside{};
  finish_step(model, 4, solid, {}, outside);
  EXPECT_TRUE(solid.momentum == (Vec<2, Int128>{}));
  finish_step(model, 5, solid, {}, outside);
  EXPECT_TRUE(solid.momentum[0] == quanta(1.0));
  EXPECT_TRUE(solid.momentum[1] == quanta(-0.5));
  EXPECT_TRUE(outside == solid.momentum);
  // It has drifted by (1/2) dt^2 along x.
  EXPECT_EQ(solid.x[0], (2.0 + 0.5 * hand_dt * hand_dt) / model.pair.length[0]);
}

SolidLoad<2> some_load() {
  SolidLoad<2> load;
  load.fluid.linear = {{7, -3}};
  load.fluid.angular = {{11}};
  load.contact.linear = {{100, 200}};
  load.wall.linear = {{1000, 0}};
  load.kept = {{9, 0, 0, {}}, {4, 1, 0, {}}, {4, 0, 2, {}}};
  return load;
}

TEST(FinishStep, a_free_solid_takes_all_and_only_walls_come_from_outside) {
  const Model<2> model = hand_model<2>();
  Solid<2> solid = hand_solid(model, 0, 0, {{2.0, 4.0}}, {});
  Vec<2, Int128> outside{};
  finish_step(model, 0, solid, some_load(), outside);
  EXPECT_TRUE((solid.momentum == Vec<2, Int128>{{1107, 197}}));
  EXPECT_TRUE(solid.angular_momentum[0] == 11);
  EXPECT_TRUE((solid.fluid_impulse == Vec<2, Int128>{{7, -3}}));
  EXPECT_TRUE((outside == Vec<2, Int128>{{1000, 0}}));
  ASSERT_EQ(solid.contacts.size(), 3u);  // sorted by partner, own ball, other ball
  EXPECT_EQ(solid.contacts[0].other, 2u);
  EXPECT_EQ(solid.contacts[1].own, 1u);
  EXPECT_EQ(solid.contacts[2].partner, 9u);
}

TEST(FinishStep, what_a_fixed_or_moving_solid_receives_goes_outside) {
  const Model<2> model = hand_model<2>();
  for (const SolidMotion motion : {SolidMotion::fixed, SolidMotion::moving}) {
    Solid<2> solid = hand_solid(model, 0, 0, {{2.0, 4.0}}, {{0.25, 0.0}});
    solid.motion = motion;
    const Solid<2> before = solid;
    Vec<2, Int128> outside{};
    finish_step(model, 0, solid, some_load(), outside);
    EXPECT_TRUE(solid.momentum == before.momentum);
    EXPECT_TRUE(solid.angular_momentum[0] == 0);
    EXPECT_TRUE((outside == Vec<2, Int128>{{-107, -197}}));
    EXPECT_TRUE((solid.fluid_impulse == Vec<2, Int128>{{7, -3}}));
    const double moved = motion == SolidMotion::moving ? 0.25 * hand_dt / model.pair.length[0] : 0.0;
    EXPECT_EQ(solid.x[0] - before.x[0], moved);
  }
}

TEST(FinishStep, a_solid_that_moves_too_far_stays_and_is_reported) {
  // A step of 1/32: a quarter of rcut is 8 c.
  const Model<2> model = hand_model<2>();
  Vec<2, Int128> outside{};
  Solid<2> allowed = hand_solid(model, 4, 0, {{2.0, 4.0}}, {{0.0, 8.0}});
  EXPECT_EQ(finish_step(model, 3, allowed, {}, outside), "");
  EXPECT_EQ(allowed.x[1], 4.25 / model.pair.length[1]);
  Solid<2> fast = hand_solid(model, 4, 0, {{2.0, 4.0}}, {{6.0, -8.0}});
  const Solid<2> before = fast;
  EXPECT_EQ(finish_step(model, 3, fast, {}, outside),
            "step 3: solid 4: a point of it moves more than rcut/4 in one step (velocity 10 c, rim 0 c before it); the "
            "step is too long or the contact too stiff");
  EXPECT_EQ(fast.x, before.x);
  EXPECT_TRUE(fast.momentum == before.momentum);
}

using What = FaultOrigin::What;

/// What is noted of a density, in units of that at rest.
std::string density_fault(const FaultOrigin& origin, double ratio) {
  const Model<2> model = hand_model<2>();
  FirstFault fault;
  note_density(model, origin, ratio * model.rest_density, fault);
  return fault.text();
}

TEST(DensityFault, names_step_place_value_and_cause) {
  EXPECT_EQ(
      density_fault({3, What::frozen_density, 4, 1}, 0.05),
      "step 3: solid 4, frozen particle 1: density 0.05 times rest, outside 0.1 to 10; the fluid tears or collapses "
      "there: raise the sound speed or resolve the gap");
  EXPECT_EQ(density_fault({12, What::fluid_density, 345}, 15.0).find("step 12: particle 345: density 15 times rest"),
            0u);
  EXPECT_EQ(density_fault({12, What::fluid_density, 345}, 9.0), "");
}

TEST(ParticleStepConstants, by_hand) {
  Model<3> model = hand_model<3>();
  model.terms.body_force = true;
  model.relax = 2;
  model.shift_shear = 0.75;
  model.shift_outer = 3.5;
  model.fluid_kick = {{0x1p-20, 0.0, -0x1p-21}};
  EXPECT_EQ(particle_step(model, 1).kick, (Vec<3, double>{}));
  const ParticleStep<3> step = particle_step(model, 2);
  EXPECT_EQ(step.kick, model.fluid_kick);
  EXPECT_EQ(step.drift[1], hand_dt * box_quanta / 8.0);
  EXPECT_EQ(step.largest_drift[2], 0.25 * box_quanta / 8.0);
  EXPECT_EQ(step.shear, 0.75);
  EXPECT_EQ(step.outer, 3.5);
}

std::string motion_fault(RangeFault what, const Vec<2, double>& v, const NeighbourSums<2>& sums) {
  FirstFault fault;
  note_motion(what, {12, What::fluid_motion, 345}, v, sums, fault);
  return fault.text();
}

TEST(MotionFault, names_step_particle_value_and_cause) {
  NeighbourSums<2> sums{};
  sums.impulse = {{5, -(std::int64_t{1} << 51)}};  // the larger of the two is named
  EXPECT_EQ(
      motion_fault(RangeFault::impulse, {}, sums),
      "step 12: particle 345: impulse -8 m c is too large for its fixed-point range; particles overlap or the step "
      "is too long");
  EXPECT_EQ(
      motion_fault(RangeFault::displacement, {{3.0, 4.0}}, sums),
      "step 12: particle 345: moves more than rcut/4 in one step (velocity 5 c before it); the step is too long or "
      "the sound speed too low");
  EXPECT_EQ(motion_fault(RangeFault::none, {}, sums), "");
}

}  // namespace
}  // namespace mappm
