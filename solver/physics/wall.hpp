// Extrapolated no-slip at the surface of a solid.
#pragma once

#include "base/numbers.hpp"
#include "base/vec.hpp"

namespace mappm {

/// Factor beta of the viscous term of a PP-FP pair (Morris, Fox and Zhu 1997): the velocity is continued linearly
/// from the PP through the surface, where it is that of the solid, to the depth of the FP.
///   beta = min(1 + d_w / d_f, b),   d_f = max(distance of the PP to the tangent plane at the FP, dx / 4)
/// r: PP minus FP; normal: outward at the FP; depth: d_w; nearest: dx / 4; largest: b. All lengths in one unit.
template <int D, class Real>
MAPPM_INLINE Real no_slip_factor(const Vec<D, Real>& r, const Vec<D, Real>& normal, const Real& depth,
                                 Scalar<Real> nearest, Scalar<Real> largest) {
  const Real distance = larger(dot(r, normal) - depth, Real(nearest));
  return smaller(constant<Real>(1.0) + depth / distance, Real(largest));
}

}  // namespace mappm
