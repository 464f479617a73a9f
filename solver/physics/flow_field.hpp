// Steady periodic vector fields over the box: the start of the fluid's velocity, and accelerations.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/fixed_point.hpp"
#include "base/rotation.hpp"
#include "base/vec.hpp"

namespace mappm {

/// One field; k = 2 pi mode / L along each axis, A the amplitude.
///   wave      A sin(k x_gradient) along the axis `direction`
///   vortices  A (sin kx cos ky [cos kz], -cos kx sin ky [cos kz], 0)                     Taylor and Green 1937
///   abc       A (sin kz + cos ky, sin kx + cos kz, sin ky + cos kx), in space only       Arnold 1965, Childress 1970
/// All are sums of sines of one wave number along each axis. Vortices and abc need equal sides of the box.
struct FlowField {
  enum class Kind { wave, vortices, abc } kind = Kind::wave;
  double amplitude = 0.0;  // in the unit of the value
  int mode = 1;            // waves per box side
  int direction = 0;       // of a wave; equal to `gradient` for a wave of sound
  int gradient = 1;        // of a wave: the axis along which it varies
};

/// Value of the field at x (position quanta, inside the box), in the unit of the amplitude.
template <int D>
Vec<D, double> flow_at(const FlowField& field, const Vec<D, double>& x) {
  const auto phase = [&](int axis) { return unit_circle(field.mode * (x[axis] / box_quanta)); };  // cos, sin
  Vec<D, double> value;
  if (field.kind == FlowField::Kind::wave) {
    value[field.direction] = field.amplitude * phase(field.gradient)[1];
    return value;
  }
  Vec<2, double> p[D];
  for (int axis = 0; axis < D; ++axis) p[axis] = phase(axis);
  if (field.kind == FlowField::Kind::vortices) {
    const double amplitude = D == 3 ? field.amplitude * p[D - 1][0] : field.amplitude;
    value[0] = amplitude * (p[0][1] * p[1][0]);
    value[1] = -amplitude * (p[0][0] * p[1][1]);
  } else if constexpr (D == 3) {
    for (int axis = 0; axis < 3; ++axis) value[axis] = field.amplitude * (p[(axis + 2) % 3][1] + p[(axis + 1) % 3][0]);
  }
  return value;
}

/// Largest length of the value anywhere. Of abc it is sqrt(6) A: by 2 a b <= a^2 + b^2 its square is at most
/// 3 A^2 + 3 A^2, which it reaches where kx = ky = kz = pi / 4.
inline double largest_flow(const FlowField& field) {
  return std::fabs(field.amplitude) * (field.kind == FlowField::Kind::abc ? std::sqrt(6.0) : 1.0);
}

/// Impulse (iota) on a PP at x in one step, of a field of accelerations given as velocities (c) gained in a step.
template <int D>
Vec<D, std::int64_t> field_impulse(const FlowField& kick, const Vec<D, double>& x) {
  const Vec<D, double> value = flow_at(kick, x);
  Vec<D, std::int64_t> impulse;
  for (int axis = 0; axis < D; ++axis) impulse[axis] = to_fixed(value[axis] / velocity_quantum);
  return impulse;
}

}  // namespace mappm
