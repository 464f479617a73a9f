// A pair law with its constants folded as a model folds them, and pairs to try it on.
#pragma once

#include <array>
#include <cmath>
#include <random>

#include "base/fixed_point.hpp"
#include "physics/fluid_pair.hpp"
#include "physics/kernel.hpp"

namespace mappm::testing {

/// What the law's constants are made of: internal units.
template <int D>
struct Fluid {
  std::array<double, D> spacing;
  std::array<double, D> box;
  double mu, dt, shift_rate;

  /// Volume of a PP at rest.
  double volume() const {
    double volume = 1.0;
    for (const double side : spacing) volume *= side;
    return volume;
  }
};

template <int D, class Kernel>
KernelScale scale_of(const Fluid<D>& fluid) {
  double spacing[D];
  for (int axis = 0; axis < D; ++axis) spacing[axis] = fluid.spacing[axis];
  return normalise<D, Kernel>(spacing);
}

template <int D, class Kernel>
PairLaw<D> make_law(const Fluid<D>& fluid) {
  const KernelScale scale = scale_of<D, Kernel>(fluid);
  PairLaw<D> law;
  for (int axis = 0; axis < D; ++axis) {
    law.length[axis] = fluid.box[axis] / box_quanta;
    // displacement u dt of an impulse G (V_i^2 + V_j^2) r dt: times kappa c h / (2 V_0), h = 1/2
    law.shift[axis] = velocity_quantum * fluid.shift_rate * 0.5 / (2.0 * fluid.volume()) / law.length[axis];
  }
  law.force = scale.gradient * fluid.dt / velocity_quantum;
  law.viscosity = fluid.mu;
  law.weight = scale.weight / density_quantum;
  return law;
}

inline Fluid<2> plane_fluid() { return {{0.3125, 0.3125}, {4.0, 5.0}, 0.02, 0.0078125, 0.5}; }
inline Fluid<3> space_fluid() { return {{0.375, 0.34375, 0.40625}, {6.0, 5.5, 6.5}, 0.02, 0.0078125, 0.5}; }

/// Separations up to 1.5 cutoffs, so that about half of the pairs lie beyond it; densities about rho0.
template <int D>
FluidPair<D, double> random_pair(std::mt19937_64& random, const PairLaw<D>& law, double rho0) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  FluidPair<D, double> pair;
  for (int axis = 0; axis < D; ++axis) {
    pair.d[axis] = std::nearbyint(1.5 / std::sqrt(static_cast<double>(D)) * unit(random) / law.length[axis]);
    pair.v[axis] = std::nearbyint(0.1 * unit(random) / velocity_quantum) * velocity_quantum;
  }
  const double rho_i = rho0 * (1.0 + 0.02 * unit(random)), rho_j = rho0 * (1.0 + 0.02 * unit(random));
  pair.v2 = 1.0 / (rho_i * rho_i) + 1.0 / (rho_j * rho_j);
  pair.pv2 = (rho_i - rho0) / (rho_i * rho_i) + (rho_j - rho0) / (rho_j * rho_j);
  return pair;
}

template <class Kernel, bool transport, int D, class Real>
auto interact(const PairLaw<D, Scalar<Real>>& law, const FluidPair<D, Real>& pair, const Real& beta) {
  const Vec<D, Real> r = separation(law, pair.d);
  return fluid_pair<Kernel, transport>(law, pair, r, cut_distance(dot(r, r)), beta);
}

/// The density that the two give each other.
template <class Kernel, int D, class Real>
Fixed<Real> shared_density(const PairLaw<D, Scalar<Real>>& law, const FluidPair<D, Real>& pair) {
  const Vec<D, Real> r = separation(law, pair.d);
  return pair_density<Kernel>(law, cut_distance(dot(r, r)));
}

}  // namespace mappm::testing
