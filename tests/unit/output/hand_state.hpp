// A model and a state small enough to be summed by hand, with units that are powers of two so that every figure below
// is exact. Box 4 x 2 rcut; scene units of an internal unit: length 0.5, velocity 4, mass 8, hence time 0.125, force
// 256, energy 128.
#pragma once

#include <cmath>
#include <vector>

#include "particles/density_field.hpp"
#include "particles/model.hpp"

namespace mappm::hand {

inline constexpr double one = 1.0 / velocity_quantum;  // an internal unit of momentum, in iota

inline Int128 iota(double momentum) { return static_cast<Int128>(momentum * one); }
inline Vec<2, Int128> iota(double x, double y) { return {{iota(x), iota(y)}}; }

/// Shape 0: a ball of mass 16, moment of inertia 2, one FP. Shape 1: a piece of a wall with two FPs.
inline Model<2> model() {
  Model<2> model;
  model.box = {{4.0, 2.0}};
  model.pair.length = {{4.0 / box_quanta, 2.0 / box_quanta}};
  model.rest_density = 8.0;
  model.dt = 0.5;
  model.units = {.length = 0.5, .velocity = 4.0, .mass = 8.0};
  model.terms.solids = model.terms.motion = model.terms.rotation = true;
  Shape<2> ball;
  ball.balls.push_back({.offset = {}, .radius = 0.25, .contact_radius = 0.25});
  ball.frozen.resize(1);
  ball.frozen[0].offset = {{0.125, 0.0}};
  ball.mass = 16.0;
  ball.inverse_inertia[0] = 0.5;
  Shape<2> wall;
  wall.frozen.resize(2);
  wall.frozen[1].offset = {{0.0, -0.25}};
  wall.mass = 1.0;
  wall.rotates = false;
  model.shapes = {ball, wall};
  return model;
}

/// x: fractions of the box.
inline void add_pp(State<2>& state, std::uint64_t id, Vec<2, double> x, Vec<2, double> v) {
  state.fluid.id.push_back(id);
  for (int axis = 0; axis < 2; ++axis) {
    state.fluid.x(axis).push_back(x[axis] * box_quanta);
    state.fluid.v(axis).push_back(v[axis]);
  }
}

inline Solid<2> solid(std::uint64_t id, std::uint32_t shape, SolidMotion motion, Vec<2, double> x) {
  Solid<2> solid;
  solid.id = id;
  solid.shape = shape;
  solid.motion = motion;
  for (int axis = 0; axis < 2; ++axis) solid.x[axis] = x[axis] * box_quanta;
  return solid;
}

/// Four PPs; a free, a fixed and a moving ball; a piece of a wall. At step 6.
inline State<2> state() {
  State<2> state;
  state.step = 6;
  add_pp(state, 0, {{0.125, 0.25}}, {{0.5, 0.0}});
  add_pp(state, 1, {{0.375, 0.25}}, {{0.25, 0.5}});
  add_pp(state, 2, {{0.625, 0.75}}, {{-0.25, 0.0}});
  add_pp(state, 3, {{0.875, 0.75}}, {{0.0, 0.0}});

  Solid<2> free = solid(0, 0, SolidMotion::free, {{0.5, 0.5}});
  free.momentum = iota(8.0, -4.0);
  free.angular_momentum[0] = iota(4.0);
  free.orientation.component = {{0.0, 1.0}};  // a quarter turn
  free.fluid_impulse = iota(6.0, 2.0);
  free.sampled_impulse = iota(2.0, 1.0);
  Contact<2> contact;
  contact.partner = 2;
  contact.other = 1;
  contact.stretch = {{0.1, -1e-9}};
  free.contacts = {contact};

  Solid<2> fixed = solid(1, 0, SolidMotion::fixed, {{0.25, 0.0}});
  fixed.fluid_impulse = iota(0.0, -3.0);
  Solid<2> wall = solid(2, 1, SolidMotion::fixed, {{0.5, 0.0625}});
  wall.group = 7;
  wall.fluid_impulse = iota(1.0, 1.0);
  Solid<2> moving = solid(3, 0, SolidMotion::moving, {{0.75, 0.5}});
  moving.momentum = iota(4.0, 0.0);
  moving.fluid_impulse = iota(2.0, -1.0);
  state.solids = {free, fixed, wall, moving};

  // Momentum of all is (0.5, 0.5) + (12, -4) = (12.5, -3.5).
  state.start_momentum = iota(12.0, -4.0);
  state.outside_impulse = iota(0.5, 0.5);
  return state;
}

/// With densities of 7, 8, 9 and 8 at the four PPs, and of 8.5 at the FPs. `of`: the state above, or a part of it.
inline Sample<2> sample(State<2>& of) {
  constexpr double densities[] = {7.0, 8.0, 9.0, 8.0};
  Sample<2> sample{of, {}};
  for (const std::uint64_t id : of.fluid.id) sample.density.fluid.push_back(densities[id]);
  const Model<2> model = hand::model();
  for (const Solid<2>& solid : of.solids) {
    const std::vector<FrozenParticle<2>>& frozen = model.shapes[solid.shape].frozen;
    const RigidVelocity<2> velocity = rigid_velocity(solid, model.shapes[solid.shape]);
    for (std::uint32_t k = 0; k < frozen.size(); ++k) {
      const PlacedFrozen<2> placed = place(solid, velocity, frozen[k], model.pair.length);
      sample.density.frozen.push_back({solid.id, k, placed.x, placed.v, 8.5});
    }
  }
  return sample;
}

}  // namespace mappm::hand
