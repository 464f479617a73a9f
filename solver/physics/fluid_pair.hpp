// The law between two pseudo-particles. It stands here and nowhere else; both engines instantiate it.
//
//   F_ij   = G { (p_i V_i^2 + p_j V_j^2) r - beta mu (V_i^2 + V_j^2) v }        momentum that i gains per time
//   u_ij   = (dt/2) p_s (V_i^2 + V_j^2) G r                                    transport velocity of i
//   rho_ij = W - dt (-W'/r) r.v                                                density that j gives to i, one step on
//
// Every term is symmetric or antisymmetric in i and j to the last bit, and is rounded once to an integer.
#pragma once

#include "base/lanes.hpp"
#include "base/vec.hpp"
#include "physics/kernel.hpp"

namespace mappm {

/// Constants of the pair law, folded once. Internal units: rcut = 1, PP mass = 1, c = 1.
template <int D>
struct PairLaw {
  Vec<D, double> length;  // length of one position quantum, per axis
  double force;           // G scale * dt / iota: profile to impulse quanta
  double viscosity;       // mu
  Vec<D, double> shift;   // impulse quanta of p_s = 1 to displacement in position quanta, per axis
  double weight;          // W scale / density quantum
  double rate;            // -W'/r scale * dt / density quantum
};

/// What the law reads of one pair. `d` is the exact difference of positions in quanta, i minus j; `v` of velocities.
template <int D, class Real>
struct FluidPair {
  Vec<D, Real> d, v;
  Real v2;   // V_i^2 + V_j^2
  Real pv2;  // p_i V_i^2 + p_j V_j^2
};

/// What one pair gives to i. To j it gives the impulse and the shift with the other sign, and the same density.
template <int D, class Real>
struct PairResult {
  Vec<D, Fixed<Real>> impulse;
  Vec<D, Fixed<Real>> shift;
  Fixed<Real> density;
};

template <int D, class Real>
MAPPM_INLINE Vec<D, Real> separation(const PairLaw<D>& law, const Vec<D, Real>& d) {
  Vec<D, Real> r;
  for (int axis = 0; axis < D; ++axis) r[axis] = d[axis] * Real(law.length[axis]);
  return r;
}

/// Distance in units of rcut from its square, cut at 1: beyond the cutoff every profile is zero, so no branch is needed.
template <class Real>
MAPPM_INLINE Real cut_distance(const Real& square) {
  return smaller(square_root(square), Real(1.0));
}

/// `beta` is 1 between PPs and `no_slip_factor` between a PP and an FP.
template <class Kernel, bool transport, int D, class Real>
MAPPM_INLINE PairResult<D, Real> fluid_pair(const PairLaw<D>& law, const FluidPair<D, Real>& pair,
                                            const Vec<D, Real>& r, const Real& q, const Real& beta) {
  const KernelProfile<Real> kernel = Kernel::template at<Real>(q);
  const Real g = kernel.gradient * Real(law.force);
  const Real pressure = g * pair.pv2;
  const Real shifting = g * pair.v2;
  const Real friction = shifting * (beta * Real(law.viscosity));
  PairResult<D, Real> result;
  for (int axis = 0; axis < D; ++axis) {
    result.impulse[axis] = to_fixed(pressure * r[axis] - friction * pair.v[axis]);
    if constexpr (transport) result.shift[axis] = to_fixed(shifting * r[axis] * Real(law.shift[axis]));
  }
  result.density = to_fixed(kernel.weight * Real(law.weight) - kernel.rate * Real(law.rate) * dot(r, pair.v));
  return result;
}

/// The density that two FPs of different solids give each other: as between PPs, without force.
template <class Kernel, int D, class Real>
MAPPM_INLINE Fixed<Real> pair_density(const PairLaw<D>& law, const Vec<D, Real>& r, const Vec<D, Real>& v,
                                      const Real& q) {
  const KernelProfile<Real> kernel = Kernel::template at<Real>(q);
  return to_fixed(kernel.weight * Real(law.weight) - kernel.rate * Real(law.rate) * dot(r, v));
}

}  // namespace mappm
