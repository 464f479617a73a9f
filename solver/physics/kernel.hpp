// Smoothing kernels. A kernel of support 1 (the cutoff) is given by two profiles of q = r / rcut:
//   weight(q)    the profile of W, which sums to the density
//   gradient(q)  the profile of G = -W'(r) / r, which carries every force
// They take the pair distance already limited to q <= 1, so that a pair beyond the cutoff contributes exactly zero.
#pragma once

#include "base/numbers.hpp"

namespace mappm {

enum class KernelKind { wendland_c2, lucy, mps };

/// Wendland C2 (Wendland 1995): W ~ (1-q)^4 (1+4q), G ~ (1-q)^3.
struct WendlandC2 {
  static constexpr const char* name = "wendland-c2";
  static constexpr double self_weight = 1.0;
  template <class Real>
  MAPPM_INLINE static Real weight(const Real& q) {
    const Real t = constant<Real>(1.0) - q;
    const Real square = t * t;
    return square * square * (constant<Real>(1.0) + constant<Real>(4.0) * q);
  }
  template <class Real>
  MAPPM_INLINE static Real gradient(const Real& q) {
    const Real t = constant<Real>(1.0) - q;
    return t * t * t;
  }
};

/// Lucy (1977): W ~ (1-q)^3 (1+3q), G ~ (1-q)^2.
struct Lucy {
  static constexpr const char* name = "lucy";
  static constexpr double self_weight = 1.0;
  template <class Real>
  MAPPM_INLINE static Real weight(const Real& q) {
    const Real t = constant<Real>(1.0) - q;
    return t * t * t * (constant<Real>(1.0) + constant<Real>(3.0) * q);
  }
  template <class Real>
  MAPPM_INLINE static Real gradient(const Real& q) {
    const Real t = constant<Real>(1.0) - q;
    return t * t;
  }
};

/// The weight of the moving-particle semi-implicit method (Koshizuka and Oka 1996): w = 1/q - 1, which MaPPM's
/// weighted difference uses as W' ~ -w/q, so G ~ w/q^2. A particle does not see itself.
struct MpsWeight {
  static constexpr const char* name = "mps";
  static constexpr double self_weight = 0.0;
  template <class Real>
  MAPPM_INLINE static Real weight(const Real& q) {
    return inverse(q) - constant<Real>(1.0);
  }
  template <class Real>
  MAPPM_INLINE static Real gradient(const Real& q) {
    const Real of_q = inverse(q);
    return (of_q - constant<Real>(1.0)) * of_q * of_q;
  }

 private:
  template <class Real>
  MAPPM_INLINE static Real inverse(const Real& q) {
    return constant<Real>(1.0) / larger(q, constant<Real>(1e-3));
  }
};

/// Factors that turn the profiles into W and G, normalised on the initial lattice (see `normalise`).
struct KernelScale {
  double weight = 0.0;    // 1 / rcut^D
  double gradient = 0.0;  // 1 / rcut^(D+2)
  /// (1/D) sum V G q^4 r^2 on the lattice, rcut^0: the share of the outer neighbours in what is 1 of all.
  double outer_moment = 0.0;
};

/// Factors with which sums over a lattice of the given spacings (in units of rcut, mass 1 per node) are exact:
/// sum W = number density, and (1/D) sum V r^2 G = 1: consistent in orders 0 and 1.
template <int D, class Kernel>
KernelScale normalise(const double (&spacing)[D]) {
  double volume = 1.0;
  int reach[3] = {0, 0, 0};
  for (int axis = 0; axis < D; ++axis) {
    volume *= spacing[axis];
    reach[axis] = static_cast<int>(1.0 / spacing[axis]) + 1;
  }
  double weight_sum = Kernel::self_weight;
  double gradient_sum = 0.0, outer_sum = 0.0;
  for (int k = -reach[2]; k <= reach[2]; ++k)
    for (int j = -reach[1]; j <= reach[1]; ++j)
      for (int i = -reach[0]; i <= reach[0]; ++i) {
        if (i == 0 && j == 0 && k == 0) continue;
        const int node[3] = {i, j, k};
        double square = 0.0;
        for (int axis = 0; axis < D; ++axis) {
          const double offset = node[axis] * spacing[axis];
          square += offset * offset;
        }
        if (square >= 1.0) continue;
        const double q = square_root(square);
        weight_sum += Kernel::weight(q);
        gradient_sum += square * Kernel::gradient(q);
        outer_sum += square * square * square * Kernel::gradient(q);
      }
  const double number_density = 1.0 / volume;
  KernelScale scale;
  scale.weight = number_density / weight_sum;
  scale.gradient = D * number_density / gradient_sum;
  scale.outer_moment = outer_sum / gradient_sum;
  return scale;
}

}  // namespace mappm
