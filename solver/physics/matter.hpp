// The matter of a body as a region of space, given by the depth of a point below its surface: how much of a kernel's
// support it fills, and, for a union of balls, its volume, centre and inertia.
#pragma once

#include <array>
#include <vector>

#include "base/rotation.hpp"
#include "physics/rigid_body.hpp"

namespace mappm {

/// Fraction of a grid cell of side `cell` that lies inside, its centre at `depth` (negative outside): second order.
inline double coverage(double depth, double cell) {
  const double fraction = 0.5 + depth / cell;
  return fraction < 0.0 ? 0.0 : (fraction > 1.0 ? 1.0 : fraction);
}

/// Depth of a point below the surface of one ball; negative outside.
template <int D>
double depth_in_ball(const Vec<D, double>& point, const Ball<D>& ball);

/// Depth in the union of balls, taken in the ball in which the point lies deepest.
template <int D>
double depth_in_union(const Vec<D, double>& point, const std::vector<Ball<D>>& balls);

/// Volume, centre and second moments  integral x_a x_b dV about the centre  of a union of balls.
template <int D>
struct Moments {
  double volume = 0.0;
  Vec<D, double> centre;
  std::array<Vec<D, double>, D> second{};
};

/// By Gauss' rule over slices and lines of the union, which knows no grid. Against closed forms and finer rules it errs
/// by less than 1e-8 of the volume for two balls, 1e-6 for some and 1e-4 for a hundred; its cost is bounded.
template <int D>
Moments<D> integrate_union(std::vector<Ball<D>> balls);

/// Row-major inverse of the inertia tensor  density integral (x.x 1 - x x) dV ; one entry in the plane.
template <int D>
Vec<D == 2 ? 1 : 9, double> inverse_inertia(const Moments<D>& moments, double density);

/// The index-th of n directions, evenly over the circle or on a golden-angle spiral over the sphere, turned on by
/// `shift` steps in azimuth.
template <int D>
Vec<D, double> direction(int index, int n, double shift = 0.0);

/// Quadrature of a kernel over its support, by radius and direction. Directions come in opposite pairs, so that a point
/// on a flat surface sees exactly half. Made once per kernel.
template <int D>
class SupportQuadrature {
 public:
  /// profile[k]: the kernel's weight at q = (k + 1/2) / radii.
  template <class Kernel>
  static SupportQuadrature of(Kernel) {
    std::array<double, radii> profile;
    for (int k = 0; k < radii; ++k) profile[k] = Kernel::weight(radius(k));
    return SupportQuadrature(profile);
  }

  /// Share in [0, 1] of the integral of W about `point` that falls on matter. depth_at(x): depth below the surface.
  /// A singular weight (MPS) is integrable, and its self term is none: the share is that of the integral.
  template <class DepthAt>
  double inside_share(const Vec<D, double>& point, DepthAt&& depth_at) const {
    double inside = 0.0;
    double whole = 0.0;
    for (int k = 0; k < radii; ++k) {
      double covered = 0.0;
      for (const Vec<D, double>& unit : directions_) {
        const Vec<D, double> step = radius(k) * unit;
        covered += coverage(depth_at(point + step), cell) + coverage(depth_at(point - step), cell);
      }
      inside += shell_weight_[k] * covered;
      whole += shell_weight_[k] * (2.0 * static_cast<double>(directions_.size()));
    }
    return inside / whole;
  }

 private:
  static constexpr int radii = 32;
  static constexpr int pairs = D == 2 ? 48 : 96;
  static constexpr double cell = 1.0 / radii;
  static double radius(int k) { return (k + 0.5) * cell; }
  explicit SupportQuadrature(const std::array<double, radii>& profile);

  std::vector<Vec<D, double>> directions_;
  std::array<double, radii> shell_weight_{};  // W r^(D-1)
};

}  // namespace mappm
