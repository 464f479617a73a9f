// A model put together by hand: round numbers, exact in binary, so that impulses can be worked out on paper.
#pragma once

#include "particles/solid_step.hpp"

namespace mappm::testing {

inline constexpr double hand_dt = 0.03125;  // 1/32

/// Box side 8 rcut. Shape 0: one ball of radius 1, mass 2, inertia 1. Shape 1: a dumb-bell of two balls of radius 1/2,
/// 3/4 before and behind its centre, mass 4. Linear contact of stiffness 100 without damping, friction 1/2.
template <int D>
Model<D> hand_model() {
  Model<D> model;
  for (int axis = 0; axis < D; ++axis) {
    model.box[axis] = 8.0;
    model.pair.length[axis] = 8.0 / box_quanta;
  }
  model.terms.solids = model.terms.motion = model.terms.rotation = model.terms.contact = true;
  model.dt = hand_dt;
  model.rest_density = 10.0;
  model.contact = make_contact_law(ContactKind::linear, 100.0, 0.0, 0.0, 1.0, 0.5);
  constexpr int n = angular_components<D>;
  Shape<D> ball;
  ball.balls = {{{}, 1.0, 1.0}};
  ball.reach = 1.0;
  ball.mass = 2.0;
  Shape<D> bell;
  bell.balls = {{{{0.75}}, 0.5, 0.5}, {{{-0.75}}, 0.5, 0.5}};
  bell.reach = 1.25;
  bell.mass = 4.0;
  for (int i = 0; i < n; ++i) ball.inverse_inertia[n * i + i] = bell.inverse_inertia[n * i + i] = 1.0;
  model.shapes = {ball, bell};
  model.largest_reach = model.largest_contact_reach = 1.25;
  return model;
}

/// A solid at `x` rcut with linear velocity `v` (c).
template <int D>
Solid<D> hand_solid(const Model<D>& model, std::uint64_t id, std::uint32_t shape, const Vec<D, double>& x,
                    const Vec<D, double>& v) {
  Solid<D> solid;
  solid.id = id;
  solid.shape = shape;
  solid.group = static_cast<std::uint32_t>(id);
  for (int axis = 0; axis < D; ++axis) {
    solid.x[axis] = wrap_position(x[axis] / model.pair.length[axis]);
    solid.momentum[axis] = to_fixed_wide(model.shapes[shape].mass * v[axis] / velocity_quantum);
  }
  return solid;
}

/// The impulse in iota of a force over a step.
inline Int128 quanta(double force) { return to_fixed_wide(force * hand_dt / velocity_quantum); }

}  // namespace mappm::testing
