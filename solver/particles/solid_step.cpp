#include "particles/solid_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace mappm {

namespace {

template <int D>
Vec<D, double> kept_stretch(const Solid<D>& solid, std::uint64_t partner, std::uint32_t own, std::uint32_t other) {
  for (const Contact<D>& contact : solid.contacts)
    if (contact.partner == partner && contact.own == own && contact.other == other) return contact.stretch;
  return {};
}

template <int D>
double inverse_mass(const SolidInStep<D>& body) {
  return body.solid->motion == SolidMotion::free ? 1.0 / body.shape->mass : 0.0;
}

template <int D>
Vec<D, double> point_velocity(const SolidInStep<D>& body, const Vec<D, double>& lever) {
  return body.velocity.linear + rotational_velocity<D, double>(body.velocity.angular, lever);
}

/// Impulse of a force over one step, rounded once.
template <int D>
Vec<D, Int128> contact_impulse(const Vec<D, double>& force, double dt) {
  Vec<D, Int128> impulse;
  for (int axis = 0; axis < D; ++axis) impulse[axis] = to_fixed_wide(force[axis] * dt / velocity_quantum);
  return impulse;
}

template <int D>
void apply(const Vec<D, Int128>& impulse, const Vec<D, double>& lever, SolidImpulse<D>& to) {
  Vec<D, double> value;
  for (int axis = 0; axis < D; ++axis) value[axis] = static_cast<double>(impulse[axis]);
  to.linear += impulse;
  to.angular += torque_impulse<D>(lever, value);
}

/// Vector from `b` to `a` by the nearest image, in rcut.
template <int D>
Vec<D, double> vector_between(const Model<D>& model, const Vec<D, double>& a, const Vec<D, double>& b) {
  Vec<D, double> r;
  for (int axis = 0; axis < D; ++axis) r[axis] = nearest_difference(a[axis], b[axis]) * model.pair.length[axis];
  return r;
}

/// Two balls that touch: from `low` to `high`, the solid of the smaller and that of the larger id.
template <int D>
struct Touch {
  std::uint32_t a, b;               // balls of low and high
  Vec<D, double> lever_a, lever_b;  // of the contact point
  Vec<D, double> normal;            // from b to a
  double overlap;
};

/// Calls visit(touch) for all pairs of balls of two solids that touch.
template <int D, class Visit>
void for_each_touch(const Model<D>& model, const SolidInStep<D>& low, const SolidInStep<D>& high, Visit&& visit) {
  const Vec<D, double> centres = vector_between(model, low.solid->x, high.solid->x);
  const double reach = low.shape->reach + high.shape->reach;
  if (dot(centres, centres) >= reach * reach) return;
  for (std::uint32_t a = 0; a < low.shape->balls.size(); ++a)
    for (std::uint32_t b = 0; b < high.shape->balls.size(); ++b) {
      const Ball<D>& ball_a = low.shape->balls[a];
      const Ball<D>& ball_b = high.shape->balls[b];
      const Vec<D, double> offset_a = rotate(low.solid->orientation, ball_a.offset);
      const Vec<D, double> offset_b = rotate(high.solid->orientation, ball_b.offset);
      const Vec<D, double> r = centres + offset_a - offset_b;
      const double square = dot(r, r);
      const double touch = ball_a.contact_radius + ball_b.contact_radius;
      if (square >= touch * touch || square == 0.0) continue;
      const double distance = square_root(square);
      const Vec<D, double> normal = (1.0 / distance) * r;
      const double overlap = touch - distance;
      visit(Touch<D>{a, b, offset_a - (ball_a.contact_radius - 0.5 * overlap) * normal,
                     offset_b + (ball_b.contact_radius - 0.5 * overlap) * normal, normal, overlap});
    }
}

/// Calls visit(touch) for all balls of a solid that touch the face of a wall; of the touch only `a` has a meaning.
template <int D, class Visit>
void for_each_touch(const Model<D>& model, const SolidInStep<D>& one, const WallFace<D>& face, Visit&& visit) {
  for (std::uint32_t a = 0; a < one.shape->balls.size(); ++a) {
    const Ball<D>& ball = one.shape->balls[a];
    const Vec<D, double> offset = rotate(one.solid->orientation, ball.offset);
    const int axis = face.axis;
    const double centre = nearest_difference(one.solid->x[axis], face.x) * model.pair.length[axis] + offset[axis];
    const double height = face.sign * centre;
    // Deeper than the wall's middle the ball is nearer to the other face, which pushes it the other way.
    if (height >= ball.contact_radius || height <= -0.5 * face.thickness) continue;
    Touch<D> touch{a, 0, {}, {}, {}, ball.contact_radius - height};
    touch.normal[axis] = face.sign;
    touch.lever_a = offset - (ball.contact_radius - 0.5 * touch.overlap) * touch.normal;
    visit(touch);
  }
}

/// The number of touches, of which each bears as much of a body's mass as the others.
template <int D, class... Pair>
double count_touches(const Model<D>& model, const Pair&... pair) {
  double count = 0.0;
  for_each_touch(model, pair..., [&](const Touch<D>&) { count += 1.0; });
  return count;
}

template <int D>
std::string names_of(const Model<D>& model, const Overlap& overlap) {
  if (overlap.partner >= 0.0) return fmt::format("solids {} and {}", overlap.solid, overlap.partner);
  const WallFace<D>& face = model.faces[Overlap::face_of(overlap.partner)];
  return fmt::format("solid {} and the wall at {} = {:.6g}", overlap.solid, "xyz"[face.axis],
                     face.x * model.pair.length[face.axis] * model.units.length);
}

/// A ball that goes farther in a step than the deepest overlap allowed could go through another one unseen. Empty if
/// none does.
template <int D>
std::string missed_contacts(const Model<D>& model, std::uint64_t step, const Solid<D>& solid) {
  const Shape<D>& shape = model.shapes[solid.shape];
  if (is_wall_piece(shape) || solid.motion == SolidMotion::fixed) return {};
  const double smallest = std::min_element(shape.balls.begin(), shape.balls.end(), [](const auto& a, const auto& b) {
                            return a.contact_radius < b.contact_radius;
                          })->contact_radius;
  const Vec<D, double> moved = model.dt * rigid_velocity(solid, shape).linear;
  const double radii = square_root(dot(moved, moved)) / smallest;
  if (radii <= last_overlap) return {};
  return fmt::format(
      "step {}: solid {}: moves {:.3g} of its contact radius in one step, more than {}: contacts would be missed; "
      "lower run.step",
      step, solid.id, radii, last_overlap);
}

}  // namespace

template <int D>
void add_contacts(const Model<D>& model, const SolidInStep<D>& one, const SolidInStep<D>& other, SolidLoad<D>& load) {
  const bool first = one.solid->id < other.solid->id;
  const SolidInStep<D>& low = first ? one : other;
  const SolidInStep<D>& high = first ? other : one;
  if (inverse_mass(low) + inverse_mass(high) == 0.0) return;  // neither can be moved
  const double sharing = count_touches(model, low, high);
  if (sharing == 0.0) return;
  for_each_touch(model, low, high, [&](const Touch<D>& touch) {
    ContactPair<D> pair;
    pair.normal = touch.normal;
    pair.overlap = touch.overlap;
    pair.velocity = point_velocity(low, touch.lever_a) - point_velocity(high, touch.lever_b);
    pair.inverse_mass_i = sharing * inverse_mass(low);
    pair.inverse_mass_j = sharing * inverse_mass(high);
    pair.inverse_radius_i = 1.0 / low.shape->balls[touch.a].contact_radius;
    pair.inverse_radius_j = 1.0 / high.shape->balls[touch.b].contact_radius;
    const std::uint32_t own = first ? touch.a : touch.b, partner_ball = first ? touch.b : touch.a;
    pair.stretch = kept_stretch(*one.solid, other.solid->id, own, partner_ball);
    const ContactResult<D> result = contact_force(model.contact, pair, model.dt);
    const Vec<D, Int128> on_low = contact_impulse(result.force, model.dt);
    apply(first ? on_low : -on_low, first ? touch.lever_a : touch.lever_b, load.contact);
    load.kept.push_back({other.solid->id, own, partner_ball, result.stretch});
    load.overlap.add({pair.overlap * std::max(pair.inverse_radius_i, pair.inverse_radius_j), low.solid->id,
                      static_cast<double>(high.solid->id)});
  });
}

template <int D>
void add_face_contacts(const Model<D>& model, const SolidInStep<D>& one, SolidLoad<D>& load) {
  if (inverse_mass(one) == 0.0) return;  // neither can be moved
  for (std::size_t index = 0; index < model.faces.size(); ++index) {
    const WallFace<D>& face = model.faces[index];
    const double sharing = count_touches(model, one, face);
    if (sharing == 0.0) continue;
    for_each_touch(model, one, face, [&](const Touch<D>& touch) {
      ContactPair<D> pair;
      pair.normal = touch.normal;
      pair.overlap = touch.overlap;
      pair.velocity = point_velocity(one, touch.lever_a) - face.velocity;
      pair.inverse_mass_i = sharing * inverse_mass(one);
      pair.inverse_mass_j = 0.0;
      pair.inverse_radius_i = 1.0 / one.shape->balls[touch.a].contact_radius;
      pair.inverse_radius_j = 0.0;
      pair.stretch = kept_stretch(*one.solid, face.id, touch.a, 0);
      const ContactResult<D> result = contact_force(model.contact, pair, model.dt);
      apply(contact_impulse(result.force, model.dt), touch.lever_a, load.wall);
      load.kept.push_back({face.id, touch.a, 0, result.stretch});
      load.overlap.add({pair.overlap * pair.inverse_radius_i, one.solid->id, Overlap::of_face(index)});
    });
  }
}

template <int D>
void note_overlaps(const Model<D>& model, std::uint64_t step, const std::vector<SolidLoad<D>>& loads,
                   FirstOverlaps& first) {
  Overlap deepest;
  for (const SolidLoad<D>& load : loads) deepest.add(load.overlap);
  const auto note = [&](FirstOverlap& noted, double bound, const char* consequence) {
    if (deepest.depth <= bound || noted.step <= static_cast<double>(step)) return;
    const std::string stiffness = model.contact.kind == ContactKind::hertz ? "contact.young" : "contact.stiffness";
    noted = {static_cast<double>(step), deepest,
             fmt::format("step {}: {} overlap by {:.3g} of the smaller contact radius, more than {}: {}; raise {} or "
                         "lower the speeds",
                         step, names_of(model, deepest), deepest.depth, bound, consequence, stiffness)};
  };
  note(first.doubtful, doubtful_overlap, "the contact is soft for what acts on it");
  note(first.last, last_overlap, "they would pass through each other");
}

template <int D>
std::string finish_step(const Model<D>& model, std::uint64_t step, Solid<D>& solid, SolidLoad<D>&& load,
                        Vec<D, Int128>& outside_impulse) {
  const Shape<D>& shape = model.shapes[solid.shape];
  solid.fluid_impulse += load.fluid.linear;
  std::sort(load.kept.begin(), load.kept.end(), [](const Contact<D>& a, const Contact<D>& b) {
    return std::tie(a.partner, a.own, a.other) < std::tie(b.partner, b.own, b.other);
  });
  solid.contacts = std::move(load.kept);
  SolidImpulse<D> total = load.fluid;
  total.linear += load.contact.linear;
  total.angular += load.contact.angular;
  if (solid.motion != SolidMotion::free) {
    outside_impulse -= total.linear;
  } else {
    total.linear += load.wall.linear;
    total.angular += load.wall.angular;
    outside_impulse += load.wall.linear;
    if (model.terms.fluid && shape.rotates)
      total.angular += stress_couple(model.pair.viscosity, shape, rigid_velocity(solid, shape).angular, model.dt);
    if (model.terms.body_force && step >= model.relax)
      for (int axis = 0; axis < D; ++axis) {
        const double impulse = shape.mass * model.solid_acceleration[axis] * model.dt;
        const Int128 kick = to_fixed_wide(impulse / velocity_quantum);
        total.linear[axis] += kick;
        outside_impulse[axis] += kick;
      }
  }
  if (advance(solid, shape, total, model.dt, model.pair.length) != RangeFault::none) {
    const RigidVelocity<D> velocity = rigid_velocity(solid, shape);
    return fmt::format(
        "step {}: solid {}: a point of it moves more than rcut/4 in one step (velocity {:.3g} c, rim {:.3g} "
        "c before it); the step is too long or the contact too stiff{}",
        step, solid.id, square_root(dot(velocity.linear, velocity.linear)),
        square_root(dot(velocity.angular, velocity.angular)) * shape.reach,
        model.terms.fluid ? "" : ": lower run.step, or raise fluid.rcut");
  }
  return model.terms.contact ? missed_contacts(model, step, solid) : std::string();
}

template <int D>
ParticleStep<D> particle_step(const Model<D>& model, std::uint64_t step) {
  ParticleStep<D> constants;
  for (int axis = 0; axis < D; ++axis) {
    constants.drift[axis] = model.dt / model.pair.length[axis];
    constants.largest_drift[axis] = largest_displacement / model.pair.length[axis];
  }
  constants.kick = model.terms.body_force && step >= model.relax ? model.fluid_kick : Vec<D, double>{};
  constants.shear = model.shift_shear;
  constants.outer = model.shift_outer;
  return constants;
}

template <int D>
void note_density(const Model<D>& model, const FaultOrigin& origin, double density, FirstFault& first) {
  if (is_in_range(density, model.rest_density) || !first.follows(origin)) return;
  const std::string where = origin.what == FaultOrigin::What::frozen_density
                                ? fmt::format("solid {}, frozen particle {}", origin.id, origin.index)
                                : fmt::format("particle {}", origin.id);
  first.note(origin, fmt::format("step {}: {}: density {:.3g} times rest, outside {} to {}; the fluid tears or "
                                 "collapses there: raise the sound speed or resolve the gap",
                                 origin.step, where, density / model.rest_density, lowest_density_ratio,
                                 highest_density_ratio));
}

namespace {

/// Step, particle, value and likely cause.
template <int D>
std::string motion_message(RangeFault fault, std::uint64_t step, std::uint64_t id, const Vec<D, double>& v,
                           const NeighbourSums<D>& sums) {
  switch (fault) {
    case RangeFault::impulse: {
      double largest = 0.0;
      for (const std::int64_t component : sums.impulse.component)
        if (std::fabs(static_cast<double>(component)) > std::fabs(largest)) largest = static_cast<double>(component);
      return fmt::format(
          "step {}: particle {}: impulse {:.3g} m c is too large for its fixed-point range; "
          "particles overlap or the step is too long",
          step, id, largest * velocity_quantum);
    }
    case RangeFault::velocity:
      return fmt::format(
          "step {}: particle {}: velocity beyond 32 c, the largest that is held exactly ({:.3g} c before "
          "the step); the step is too long",
          step, id, square_root(dot(v, v)));
    case RangeFault::displacement:
      return fmt::format(
          "step {}: particle {}: moves more than rcut/4 in one step (velocity {:.3g} c before it); "
          "the step is too long or the sound speed too low",
          step, id, square_root(dot(v, v)));
    case RangeFault::none:
      break;
  }
  return {};
}

}  // namespace

template <int D>
void note_motion(RangeFault fault, const FaultOrigin& origin, const Vec<D, double>& v, const NeighbourSums<D>& sums,
                 FirstFault& first) {
  if (first.follows(origin)) first.note(origin, motion_message(fault, origin.step, origin.id, v, sums));
}

#define MAPPM_INSTANTIATE(D)                                                                                        \
  template void add_contacts<D>(const Model<D>&, const SolidInStep<D>&, const SolidInStep<D>&, SolidLoad<D>&);      \
  template void add_face_contacts<D>(const Model<D>&, const SolidInStep<D>&, SolidLoad<D>&);                        \
  template void note_overlaps<D>(const Model<D>&, std::uint64_t, const std::vector<SolidLoad<D>>&, FirstOverlaps&); \
  template std::string finish_step<D>(const Model<D>&, std::uint64_t, Solid<D>&, SolidLoad<D>&&, Vec<D, Int128>&);  \
  template ParticleStep<D> particle_step<D>(const Model<D>&, std::uint64_t);                                        \
  template void note_density<D>(const Model<D>&, const FaultOrigin&, double, FirstFault&);                          \
  template void note_motion<D>(RangeFault, const FaultOrigin&, const Vec<D, double>&, const NeighbourSums<D>&,      \
                               FirstFault&);
MAPPM_INSTANTIATE(2)
MAPPM_INSTANTIATE(3)
#undef MAPPM_INSTANTIATE

}  // namespace mappm
