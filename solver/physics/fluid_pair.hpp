// The law between two pseudo-particles. It stands here and nowhere else; both engines instantiate it.
//
//   rho_ij = W                                                                 density that each gives to the other
//   F_ij   = G { (p_i V_i^2 + p_j V_j^2) r - beta mu (V_i^2 + V_j^2) v }        momentum that i gains per time
//   u_ij   = kappa c h (V_i^2 + V_j^2) / (2 V_0) G r                           transport velocity of i
//   s_ij   = (V_i^2 + V_j^2) / (2 V_0) G v^2, and q^4 times it                agitation and shear, which limit the
//   transport
//
// The densities of both are summed first, at the same positions: pressure is a function of positions alone. Every term
// is symmetric or antisymmetric in i and j to the last bit, and is rounded once to an integer.
#pragma once

#include "base/numbers.hpp"
#include "base/vec.hpp"
#include "physics/kernel.hpp"

namespace mappm {

/// Constants of the pair law, folded once. Internal units: rcut = 1, PP mass = 1, c = 1. The quanta are those of the
/// state, in single precision the multiples of them that `SinglePairs` counts in.
template <int D, class Real = double>
struct PairLaw {
  Vec<D, Real> length;  // length of one position quantum, per axis
  Real force;           // G scale * dt / iota: profile to impulse quanta
  Real viscosity;       // mu
  Vec<D, Real> shift;   // impulse quanta of a pressure of 1 to displacement in position quanta, per axis
  Real weight;          // W scale / density quantum
};

/// What the law reads of one pair. `d` is the exact difference of positions in quanta, i minus j; `v` of velocities.
template <int D, class Real>
struct FluidPair {
  Vec<D, Real> d, v;
  Real v2;   // V_i^2 + V_j^2
  Real pv2;  // p_i V_i^2 + p_j V_j^2
};

/// What one pair gives to i. To j it gives the impulse and the shift with the other sign, and the same of the others.
template <int D, class Sum>
struct PairResult {
  Vec<D, Sum> impulse, shift;
  Sum shear{}, agitation{};
};

/// How a pair's contributions become what is summed.
struct Rounded {
  template <class Real>
  using Sum = Fixed<Real>;
  template <class Real>
  MAPPM_INLINE static Fixed<Real> of(const Real& x) {
    return nearest_fixed(x);
  }
  static constexpr std::uint64_t excess = 0;
};

template <int D, class Real>
MAPPM_INLINE Vec<D, Real> separation(const PairLaw<D, Scalar<Real>>& law, const Vec<D, Real>& d) {
  Vec<D, Real> r;
  for (int axis = 0; axis < D; ++axis) r[axis] = d[axis] * Real(law.length[axis]);
  return r;
}

/// Distance in units of rcut from its square, cut at 1: beyond the cutoff every profile is zero, so no branch is
/// needed.
template <class Real>
MAPPM_INLINE Real cut_distance(const Real& square) {
  return smaller(square_root(square), constant<Real>(1.0));
}

/// The density that two particles at the distance q give each other: two PPs, a PP and an FP, FPs of two solids.
template <class Kernel, class Rounding = Rounded, int D, class Real>
MAPPM_INLINE auto pair_density(const PairLaw<D, Scalar<Real>>& law, const Real& q) {
  return Rounding::of(Kernel::weight(q) * Real(law.weight));
}

/// `beta` is 1 between PPs and `no_slip_factor` between a PP and an FP.
template <class Kernel, bool transport, class Rounding = Rounded, int D, class Real>
MAPPM_INLINE auto fluid_pair(const PairLaw<D, Scalar<Real>>& law, const FluidPair<D, Real>& pair, const Vec<D, Real>& r,
                             const Real& q, const Real& beta) {
  const Real g = Kernel::gradient(q) * Real(law.force);
  const Real pressure = g * pair.pv2;
  const Real shifting = g * pair.v2;
  const Real friction = shifting * (beta * Real(law.viscosity));
  PairResult<D, typename Rounding::template Sum<Real>> result;
  for (int axis = 0; axis < D; ++axis) {
    result.impulse[axis] = Rounding::of(pressure * r[axis] - friction * pair.v[axis]);
    if constexpr (transport) result.shift[axis] = Rounding::of(shifting * r[axis] * Real(law.shift[axis]));
  }
  if constexpr (transport) {
    const Real square = shifting * dot(pair.v, pair.v);
    result.shear = Rounding::of(square * ((q * q) * (q * q)));
    result.agitation = Rounding::of(square);
  }
  return result;
}

}  // namespace mappm
