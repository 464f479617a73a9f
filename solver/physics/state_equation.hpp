// State equation of the weakly compressible fluid.
#pragma once

#include <cmath>

#include "base/fixed_point.hpp"
#include "base/numbers.hpp"
#include "physics/range_fault.hpp"

namespace mappm {

/// p = c^2 (rho - rho0) + p_b
template <class Real>
Real pressure(const Real& rho, double rho0, double c, double background) {
  return Real(c * c) * (rho - Real(rho0)) + Real(background);
}

/// Energy of compression per mass, the integral of p / rho^2 from rho0 on:
///   e = c^2 (ln(rho / rho0) + rho0 / rho - 1) + p_b (1 / rho0 - 1 / rho)
/// For output only: it calls the mathematics library.
inline double internal_energy(double rho, double rho0, double c, double background) {
  return c * c * (std::log(rho / rho0) + rho0 / rho - 1.0) + background * (1.0 / rho0 - 1.0 / rho);
}

/// What the pair law reads of a particle's density: V^2 = 1/rho^2 and p V^2 (PP mass 1).
template <class Real>
struct VolumeTerms {
  Real v2, pv2;
};

/// Density of a particle (PPs per rcut^D) from the sum over its neighbours (density quanta) and what it has of itself:
/// W(0) of a PP, the share of its own solid of an FP.
template <class Integer>
MAPPM_INLINE auto summed_density(const Integer& sum, double own) {
  return real_of(sum) * density_quantum + own;
}

/// Whether a density can be told from a fluid that tears or collapses.
inline bool is_in_range(double rho, double rho0) {
  return rho >= lowest_density_ratio * rho0 && rho <= highest_density_ratio * rho0;
}

template <class Real>
VolumeTerms<Real> volume_terms(const Real& rho, double rho0, double c, double background) {
  const Real volume = Real(1.0) / rho;
  const Real v2 = volume * volume;
  return {v2, pressure(rho, rho0, c, background) * v2};
}

}  // namespace mappm
