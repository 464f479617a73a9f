// The numbers in which pairs are worked out: how the state enters them, and how their sums return to it. In double
// precision they are those of the state. In single precision a pair is worked out in floats, from positions relative to
// a window some rcut wide, and summed in 32-bit integers of coarser quanta; the state keeps its own.
#pragma once

#include <cstdint>

#include "base/fixed_point.hpp"
#include "base/numbers.hpp"
#include "base/vec.hpp"
#include "physics/fluid_pair.hpp"
#include "physics/pseudo_particle.hpp"
#include "physics/state_equation.hpp"

namespace mappm {

/// What a pair reads of a PP or an FP, in the numbers of the state.
template <int D>
struct PairPoint {
  Vec<D, double> x, v;
  VolumeTerms<double> volume;
};

/// Double precision.
template <int D>
class DoublePairs {
 public:
  using Real = double;       // of the arithmetic
  using Sum = std::int64_t;  // of contributions
  using Rounding = Rounded;  // of each of them

  DoublePairs(const PairLaw<D>& law, double) : law_(law) {}

  const PairLaw<D>& law() const { return law_; }
  /// The position that a pair sees; quanta.
  double seen(int, double x) const { return x; }
  /// Difference of two such, in quanta of the law.
  double difference(int, double quanta) const { return quanta; }
  /// Sums of one PP, or of several where the integers are lanes, in quanta of the state.
  template <class Integer>
  MAPPM_INLINE NeighbourSums<D, Integer> sums(const PairResult<D, Integer>& given) const {
    return {given.impulse, given.shift, given.shear, given.agitation};
  }
  /// A sum of densities, in quanta of the state.
  template <class Integer>
  MAPPM_INLINE Integer density(const Integer& sum) const {
    return sum;
  }

 private:
  PairLaw<D> law_;
};

/// Single precision.
template <int D>
class SinglePairs {
 public:
  using Real = float;
  using Sum = std::int32_t;
  using Rounding = Rounded;

  SinglePairs(const PairLaw<D>& law, double rest_density) {
    for (int axis = 0; axis < D; ++axis) {
      // 2^32 quanta are a window at least 8 rcut wide: in it, whichever image is taken, neighbours lie side by
      // side.
      while (position_[axis] * 0x1p32 * law.length[axis] < 8.0) position_[axis] *= 2.0;
      law_.length[axis] = static_cast<float>(law.length[axis] * position_[axis]);
      law_.shift[axis] = static_cast<float>(law.shift[axis] * impulse_ / position_[axis]);
    }
    while (density_ * 0x1p31 * density_quantum < 4.0 * highest_density_ratio * rest_density) density_ *= 2.0;
    law_.force = static_cast<float>(law.force / impulse_);
    law_.viscosity = static_cast<float>(law.viscosity);
    law_.weight = static_cast<float>(law.weight / density_);
  }

  const PairLaw<D, float>& law() const { return law_; }
  double seen(int axis, double x) const { return static_cast<double>(to_fixed(x / position_[axis])) * position_[axis]; }
  float difference(int axis, double quanta) const { return static_cast<float>(quanta / position_[axis]); }
  /// Position quanta of the state in one of the law.
  double position_quanta(int axis) const { return position_[axis]; }
  /// Sums keep their momentum exactly: a quantum here is a whole number of those of the state.
  template <class Integer>
  MAPPM_INLINE auto sums(const PairResult<D, Integer>& given) const {
    const auto widened = [](const Integer& sum) { return converted<std::int64_t>(sum); };
    using Wide = decltype(widened(given.impulse[0]));
    NeighbourSums<D, Wide> sums;
    for (int axis = 0; axis < D; ++axis) {
      sums.impulse[axis] = widened(given.impulse[axis]) * Wide(static_cast<std::int64_t>(impulse_));
      sums.shift[axis] = widened(given.shift[axis]) * Wide(static_cast<std::int64_t>(position_[axis]));
    }
    sums.shear = widened(given.shear) * Wide(static_cast<std::int64_t>(impulse_));
    sums.agitation = widened(given.agitation) * Wide(static_cast<std::int64_t>(impulse_));
    return sums;
  }
  template <class Integer>
  MAPPM_INLINE auto density(const Integer& sum) const {
    const auto wide = converted<std::int64_t>(sum);
    return wide * std::decay_t<decltype(wide)>(static_cast<std::int64_t>(density_));
  }

 private:
  /// Quanta of the state in one of the law. Sums count modulo 2^32 of these: an impulse modulo 64 m c, a shift modulo
  /// 8 rcut or more, a density modulo 80 times that at rest or more. A particle that receives too much for a step
  /// (`advance`) but less than all of that is found as in double precision.
  static constexpr double impulse_ = 0x1p-26 / velocity_quantum;
  Vec<D, double> position_ = least_position_quanta();
  double density_ = 1.0;
  static Vec<D, double> least_position_quanta() {
    Vec<D, double> quanta;
    for (int axis = 0; axis < D; ++axis) quanta[axis] = 4.0;  // `to_fixed` of a position stays in its range
    return quanta;
  }
  PairLaw<D, float> law_;
};

/// The pair of two points. difference(a, b): of two positions on one axis, quanta; it decides on the periodic image.
template <int D, class Numbers, class Difference>
FluidPair<D, typename Numbers::Real> pair_of(const Numbers& numbers, const PairPoint<D>& i, const PairPoint<D>& j,
                                             Difference&& difference) {
  using Real = typename Numbers::Real;
  FluidPair<D, Real> pair;
  for (int axis = 0; axis < D; ++axis) {
    pair.d[axis] = numbers.difference(axis, difference(numbers.seen(axis, i.x[axis]), numbers.seen(axis, j.x[axis])));
    pair.v[axis] = static_cast<Real>(i.v[axis]) - static_cast<Real>(j.v[axis]);
  }
  pair.v2 = static_cast<Real>(i.volume.v2) + static_cast<Real>(j.volume.v2);
  pair.pv2 = static_cast<Real>(i.volume.pv2) + static_cast<Real>(j.volume.pv2);
  return pair;
}

}  // namespace mappm
