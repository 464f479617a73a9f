#include "physics/rigid_body.hpp"

#include <cmath>

namespace mappm {

namespace {

/// I^-1 v in the body's frame.
template <int D>
AngularVec<D, double> multiply_inverse_inertia(const Shape<D>& shape, const AngularVec<D, double>& v) {
  constexpr int n = angular_components<D>;
  AngularVec<D, double> result;
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column) result[row] += shape.inverse_inertia[n * row + column] * v[column];
  return result;
}

/// omega = Q I^-1 Q^T L; in the plane the rotation Q drops out.
template <int D>
AngularVec<D, double> angular_velocity(const Solid<D>& solid, const Shape<D>& shape) {
  AngularVec<D, double> momentum;
  for (int i = 0; i < angular_components<D>; ++i)
    momentum[i] = static_cast<double>(solid.angular_momentum[i]) * velocity_quantum;
  if constexpr (D == 2)
    return multiply_inverse_inertia(shape, momentum);
  else
    return rotate(solid.orientation, multiply_inverse_inertia(shape, rotate_back(solid.orientation, momentum)));
}

template <int D>
Vec<D, double> displaced(Vec<D, double> x, const Vec<D, double>& offset, const Vec<D, double>& length) {
  for (int axis = 0; axis < D; ++axis) x[axis] += static_cast<double>(to_fixed(offset[axis] / length[axis]));
  return x;
}

}  // namespace

template <int D>
RigidVelocity<D> rigid_velocity(const Solid<D>& solid, const Shape<D>& shape) {
  RigidVelocity<D> velocity;
  for (int axis = 0; axis < D; ++axis)
    velocity.linear[axis] = static_cast<double>(solid.momentum[axis]) * velocity_quantum / shape.mass;
  if (shape.rotates) velocity.angular = angular_velocity(solid, shape);
  return velocity;
}

template <int D>
PlacedFrozen<D> place(const Solid<D>& solid, const RigidVelocity<D>& velocity, const FrozenParticle<D>& frozen,
                      const Vec<D, double>& length) {
  const Vec<D, double> offset = rotate(solid.orientation, frozen.offset);
  PlacedFrozen<D> placed;
  placed.x = displaced(solid.x, offset, length);
  placed.v = velocity.linear + rotational_velocity<D>(velocity.angular, offset);
  placed.normal = rotate(solid.orientation, frozen.normal);
  placed.lever = offset + frozen.depth * placed.normal;
  return placed;
}

template <int D>
Vec<D, double> place_of(const Solid<D>& solid, const FrozenParticle<D>& frozen, const Vec<D, double>& length) {
  return displaced(solid.x, rotate(solid.orientation, frozen.offset), length);
}

template <int D>
AngularVec<D, Int128> torque_impulse(const Vec<D, double>& lever, const Vec<D, double>& impulse) {
  const AngularVec<D, double> torque = cross<D, double>(lever, impulse);
  AngularVec<D, Int128> rounded;
  for (int i = 0; i < angular_components<D>; ++i) rounded[i] = to_fixed_wide(torque[i]);
  return rounded;
}

template <int D>
AngularVec<D, Int128> stress_couple(double viscosity, const Shape<D>& shape, const AngularVec<D, double>& omega,
                                    double dt) {
  const double factor = -2.0 * viscosity * shape.volume * dt / velocity_quantum;
  AngularVec<D, Int128> couple;
  for (int i = 0; i < angular_components<D>; ++i) couple[i] = to_fixed_wide(factor * omega[i]);
  return couple;
}

template <int D>
RangeFault advance(Solid<D>& solid, const Shape<D>& shape, const SolidImpulse<D>& impulse, double dt,
                   const Vec<D, double>& length) {
  if (solid.motion == SolidMotion::fixed) return RangeFault::none;
  const auto momentum = solid.momentum;
  const auto angular_momentum = solid.angular_momentum;
  if (solid.motion == SolidMotion::free) {
    solid.momentum += impulse.linear;
    if (shape.rotates) solid.angular_momentum += impulse.angular;
  }
  const RigidVelocity<D> velocity = rigid_velocity(solid, shape);
  const double rim_speed = std::sqrt(dot(velocity.angular, velocity.angular)) * shape.reach;
  if (!((std::sqrt(dot(velocity.linear, velocity.linear)) + rim_speed) * dt <= largest_displacement)) {
    solid.momentum = momentum;
    solid.angular_momentum = angular_momentum;
    return RangeFault::displacement;
  }
  for (int axis = 0; axis < D; ++axis) {
    const double drift = static_cast<double>(to_fixed(velocity.linear[axis] * dt / length[axis]));
    solid.x[axis] = wrap_position(solid.x[axis] + drift);
  }
  if (shape.rotates) solid.orientation = turn(solid.orientation, dt * velocity.angular);
  return RangeFault::none;
}

template RigidVelocity<2> rigid_velocity(const Solid<2>&, const Shape<2>&);
template RigidVelocity<3> rigid_velocity(const Solid<3>&, const Shape<3>&);
template PlacedFrozen<2> place(const Solid<2>&, const RigidVelocity<2>&, const FrozenParticle<2>&,
                               const Vec<2, double>&);
template PlacedFrozen<3> place(const Solid<3>&, const RigidVelocity<3>&, const FrozenParticle<3>&,
                               const Vec<3, double>&);
template Vec<2, double> place_of(const Solid<2>&, const FrozenParticle<2>&, const Vec<2, double>&);
template Vec<3, double> place_of(const Solid<3>&, const FrozenParticle<3>&, const Vec<3, double>&);
template AngularVec<2, Int128> torque_impulse<2>(const Vec<2, double>&, const Vec<2, double>&);
template AngularVec<3, Int128> torque_impulse<3>(const Vec<3, double>&, const Vec<3, double>&);
template AngularVec<2, Int128> stress_couple(double, const Shape<2>&, const AngularVec<2, double>&, double);
template AngularVec<3, Int128> stress_couple(double, const Shape<3>&, const AngularVec<3, double>&, double);
template RangeFault advance(Solid<2>&, const Shape<2>&, const SolidImpulse<2>&, double, const Vec<2, double>&);
template RangeFault advance(Solid<3>&, const Shape<3>&, const SolidImpulse<3>&, double, const Vec<3, double>&);

}  // namespace mappm
