// Extrapolated no-slip at the surface of a solid.
#pragma once

#include "base/lanes.hpp"
#include "base/vec.hpp"

namespace mappm {

/// Factor beta of the viscous term of a PP-FP pair (Morris, Fox and Zhu 1997): the velocity is continued linearly
/// from the PP through the surface, where it is that of the solid, to the depth of the FP.
///   beta = 1 + min(d_w / d_f, 10),   d_f = max(distance of the PP to the tangent plane at the FP, dx / 4)
/// r: PP minus FP; normal: outward at the FP; depth: d_w; nearest: dx / 4. All lengths in one unit.
template <int D, class Real>
MAPPM_INLINE Real no_slip_factor(const Vec<D, Real>& r, const Vec<D, Real>& normal, const Real& depth,
                                 Scalar<Real> nearest) {
  const Real distance = larger(dot(r, normal) - depth, Real(nearest));
  return constant<Real>(1.0) + smaller(depth / distance, constant<Real>(10.0));
}

}  // namespace mappm
