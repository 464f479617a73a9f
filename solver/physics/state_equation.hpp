// State equation of the weakly compressible fluid.
#pragma once

namespace mappm {

/// p = c^2 (rho - rho0) + p_b
template <class Real>
Real pressure(const Real& rho, double rho0, double c, double background) {
  return Real(c * c) * (rho - Real(rho0)) + Real(background);
}

/// What the pair law reads of a particle's density: V^2 = 1/rho^2 and p V^2 (PP mass 1).
template <class Real>
struct VolumeTerms {
  Real v2, pv2;
};

template <class Real>
VolumeTerms<Real> volume_terms(const Real& rho, double rho0, double c, double background) {
  const Real volume = Real(1.0) / rho;
  const Real v2 = volume * volume;
  return {v2, pressure(rho, rho0, c, background) * v2};
}

}  // namespace mappm
