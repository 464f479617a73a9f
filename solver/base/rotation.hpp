// Orientations and their update without any call of the mathematics library, so that the bits are the same everywhere.
#pragma once

#include "base/vec.hpp"

namespace mappm {

/// Orientation of a body: in the plane a unit complex number (cos, sin), in space a unit quaternion (w, x, y, z).
template <int D>
struct Rotation {
  Vec<D == 2 ? 2 : 4, double> component{{1.0}};
};

/// Turns a vector of the body's frame into the frame of the box.
template <int D>
Vec<D, double> rotate(const Rotation<D>& rotation, const Vec<D, double>& v);

/// Turns a vector of the frame of the box into the body's frame.
template <int D>
Vec<D, double> rotate_back(const Rotation<D>& rotation, const Vec<D, double>& v);

/// The orientation a step later: Cayley's form of the rotation by omega dt, second order and exactly of unit length up
/// to rounding, then normalised with one sqrt.  angle: omega * dt (radian).
template <int D>
Rotation<D> turn(const Rotation<D>& rotation, const AngularVec<D, double>& angle);

/// (cos, sin) of a fraction of a full turn, from + - * / alone; error below 1e-15.
Vec<2, double> unit_circle(double turns);

/// Natural logarithm of x > 0 from + - * / alone; relative error below 1e-15.
double natural_log(double x);

}  // namespace mappm
