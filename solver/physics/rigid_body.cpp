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

/// m = Q^T L, the angular momentum in the body's frame; in the plane the rotation Q drops out.
template <int D>
AngularVec<D, double> momentum_in_body(const Solid<D>& solid) {
  AngularVec<D, double> momentum;
  for (int i = 0; i < angular_components<D>; ++i)
    momentum[i] = static_cast<double>(solid.angular_momentum[i]) * velocity_quantum;
  if constexpr (D == 2)
    return momentum;
  else
    return rotate_back(solid.orientation, momentum);
}

/// m at the middle of a step of free rotation: the midpoint rule for Euler's equation m' = m cross I^-1 m. The turn by
/// its omega = I^-1 m takes m from `start` to `end` with m their mean, since Cayley's form says
/// end - start = dt m cross omega. So the energy changes by (end - start) . omega = 0 whatever the step, as far as m is
/// solved for. Each iteration divides its error by about 2 / (omega dt).
Vec<3, double> momentum_at_middle(const Shape<3>& shape, const Vec<3, double>& start, double dt) {
  constexpr int iterations = 7;
  Vec<3, double> m = start;
  for (int k = 0; k < iterations; ++k) {
    // A multiple of m adds nothing to the product. One is taken off that leaves exactly zero for a ball.
    const Vec<3, double> omega = multiply_inverse_inertia(shape, m) - shape.inverse_inertia[0] * m;
    m = start + 0.5 * dt * cross<3, double>(m, omega);
  }
  return m;
}

/// With omega = Q I^-1 m for the angular momentum m in the body's frame; in the plane Q drops out.
template <int D>
RigidVelocity<D> velocity_with(const AngularVec<D, double>& m, const Solid<D>& solid, const Shape<D>& shape) {
  RigidVelocity<D> velocity;
  for (int axis = 0; axis < D; ++axis)
    velocity.linear[axis] = static_cast<double>(solid.momentum[axis]) * velocity_quantum / shape.mass;
  if (!shape.rotates) return velocity;
  velocity.angular = multiply_inverse_inertia(shape, m);
  if constexpr (D == 3) velocity.angular = rotate(solid.orientation, velocity.angular);
  return velocity;
}

/// The velocity by which a solid moves in a step: its own, with omega at the middle. In the plane omega is constant.
template <int D>
RigidVelocity<D> velocity_of_step(const Solid<D>& solid, const Shape<D>& shape, double dt) {
  AngularVec<D, double> m = momentum_in_body(solid);
  if constexpr (D == 3) m = momentum_at_middle(shape, m, dt);
  return velocity_with(m, solid, shape);
}

template <int D>
Vec<D, double> displaced(Vec<D, double> x, const Vec<D, double>& offset, const Vec<D, double>& length) {
  for (int axis = 0; axis < D; ++axis) x[axis] += static_cast<double>(to_fixed(offset[axis] / length[axis]));
  return x;
}

}  // namespace

template <int D>
RigidVelocity<D> rigid_velocity(const Solid<D>& solid, const Shape<D>& shape) {
  return velocity_with(momentum_in_body(solid), solid, shape);
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
  const RigidVelocity<D> velocity = velocity_of_step(solid, shape, dt);
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
template AngularVec<2, Int128> torque_impulse<2>(const Vec<2, double>&, const Vec<2, double>&);
template AngularVec<3, Int128> torque_impulse<3>(const Vec<3, double>&, const Vec<3, double>&);
template AngularVec<2, Int128> stress_couple(double, const Shape<2>&, const AngularVec<2, double>&, double);
template AngularVec<3, Int128> stress_couple(double, const Shape<3>&, const AngularVec<3, double>&, double);
template RangeFault advance(Solid<2>&, const Shape<2>&, const SolidImpulse<2>&, double, const Vec<2, double>&);
template RangeFault advance(Solid<3>&, const Shape<3>&, const SolidImpulse<3>&, double, const Vec<3, double>&);

}  // namespace mappm
