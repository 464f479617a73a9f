// Double precision without exact sums: the pass as it would be if it added floating-point numbers, for the measurement
// of what exactness costs (bench/pair_numbers.cpp) and for nothing else.
#pragma once

#include "parallel/lane_numbers.hpp"

namespace mappm {

template <int D>
class FloatingLanes : public DoubleLanes<D> {
 public:
  struct Rounding {
    template <class Real>
    using Sum = Real;
    template <class Real>
    MAPPM_INLINE static Real of(const Real& x) {
      return x;
    }
    static constexpr std::uint64_t excess = 0;
  };
  using ListRounding = Rounding;
  using Sum = double;
  using DoubleLanes<D>::DoubleLanes;

  /// Sums of one PP, or of lanes.
  template <class Real>
  NeighbourSums<D, Fixed<Real>> sums(const PairResult<D, Real>& given) const {
    NeighbourSums<D, Fixed<Real>> sums;
    for (int axis = 0; axis < D; ++axis) {
      sums.impulse[axis] = to_fixed(given.impulse[axis]);
      sums.shift[axis] = to_fixed(given.shift[axis]);
    }
    sums.shear = to_fixed(given.shear);
    sums.agitation = to_fixed(given.agitation);
    return sums;
  }
  template <class Real>
  Fixed<Real> density(const Real& sum) const {
    return to_fixed(sum);
  }
};

}  // namespace mappm
