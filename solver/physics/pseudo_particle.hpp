// Motion of one pseudo-particle: the paper's Verlet scheme as kick and drift.
#pragma once

#include <cstdint>

#include "base/fixed_point.hpp"
#include "base/numbers.hpp"
#include "base/vec.hpp"
#include "physics/range_fault.hpp"

namespace mappm {

/// Sums over the neighbours of one PP in the force pass, as integers: impulse (iota), shift (position quanta), shear
/// and agitation (iota c). Of several PPs where the integers are lanes.
template <int D, class Integer = std::int64_t>
struct NeighbourSums {
  Vec<D, Integer> impulse, shift;
  Integer shear{}, agitation{};
};

/// Constants of a step, the same for every PP.
template <int D>
struct ParticleStep {
  Vec<D, double> drift;          // dt / length of a position quantum: velocity (c) to displacement (quanta)
  Vec<D, double> kick;           // impulse of the body force (c, PP mass 1)
  Vec<D, double> largest_drift;  // `largest_displacement`, in quanta
  double shear;                  // a sum of it (iota c) to the share of the shift that it allows
  double outer;                  // 1 / m, m the share of outer neighbours on the even lattice (KernelScale)
};

/// A step of one PP, or of as many as there are lanes, and where it leaves its range (bool, or a mask of lanes).
template <int D, class Real, class Mask>
struct ParticleMotion {
  Vec<D, Real> x, v;
  struct Beyond {
    Mask impulse{false}, velocity{false}, displacement{false};
    Mask any() const { return impulse || velocity || displacement; }
  } beyond;
};

/// Share of the shift that the flow about a PP allows: C min(1, (a h S / c)^2), where D S^2 is the sum of the squares
/// of the gradients of its velocity, and C tells flow from the motion of single PPs to and fro:
///   S^2 = sum (V_i^2 + V_j^2) / (2 V_0) G q^4 v^2 / (D m),  S_0^2 = sum (V_i^2 + V_j^2) / (2 V_0) G v^2 / D,
///   m = (1 / D) sum V_0 G q^4 r^2 of the even lattice,      C = (S^2 / S_0^2 - 0.7) / 0.2, at least 0 and at most 1
/// In a flow velocities differ in proportion to the distance, and S = S_0; where they differ by chance S^2 is a third
/// of it. The shift moves PPs where their lattice is even, the pressure where the density is at rest. At a wall these
/// are two places, and a fluid that shifts all the time never comes to rest there. In proportion to S the shift would
/// keep alive the motion that allows it; by its square it dies out.
template <int D, class Real>
MAPPM_INLINE Real shift_share(const Real& shear, const Real& agitation, const ParticleStep<D>& step) {
  constexpr double chance = 0.7, flow = 0.9;
  const Real zero = constant<Real>(0.0), one = constant<Real>(1.0);
  const Real coherence = shear * Real(step.outer) / larger(agitation, one);
  return smaller(larger((coherence - Real(chance)) * Real(1.0 / (flow - chance)), zero), one) *
         smaller(larger(shear * Real(step.shear), zero), one);
}

/// v + impulse + kick, x + v dt + shift: exact but for the rounding of v dt and of the limited shift to quanta. Where
/// the fluid is at rest there is no shift (`shift_share`). The position is not wrapped.
template <int D, class Real>
MAPPM_INLINE auto motion_of(const Vec<D, Real>& x, const Vec<D, Real>& v, const NeighbourSums<D, Fixed<Real>>& sums,
                            const ParticleStep<D>& step) {
  constexpr double largest_impulse = 0x1p50, largest_velocity = exact_quanta * velocity_quantum;
  ParticleMotion<D, Real, decltype(x[0] < x[0])> motion;
  auto& beyond = motion.beyond;
  const Real share = shift_share(real_of(sums.shear), real_of(sums.agitation), step);
  for (int axis = 0; axis < D; ++axis) {
    const Real impulse = real_of(sums.impulse[axis]);
    const Real new_v = v[axis] + (impulse * velocity_quantum + step.kick[axis]);
    const Real moved =
        real_of(nearest_fixed(new_v * step.drift[axis])) + real_of(nearest_fixed(share * real_of(sums.shift[axis])));
    beyond.impulse = beyond.impulse || !(magnitude(impulse) < largest_impulse);
    beyond.velocity = beyond.velocity || !(magnitude(new_v) < largest_velocity);
    beyond.displacement = beyond.displacement || !(magnitude(moved) <= step.largest_drift[axis]);
    motion.v[axis] = new_v;
    motion.x[axis] = x[axis] + moved;
  }
  return motion;
}

/// Moves one PP. On a fault nothing is changed.
template <int D>
MAPPM_INLINE RangeFault advance(Vec<D, double>& x, Vec<D, double>& v, const NeighbourSums<D>& sums,
                                const ParticleStep<D>& step) {
  const auto motion = motion_of(x, v, sums, step);
  if (motion.beyond.any()) [[unlikely]] {
    if (motion.beyond.impulse) return RangeFault::impulse;
    if (motion.beyond.velocity) return RangeFault::velocity;
    return RangeFault::displacement;
  }
  x = motion.x;
  v = motion.v;
  return RangeFault::none;
}

}  // namespace mappm
