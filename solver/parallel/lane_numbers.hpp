// The numbers of a pair as the fast engine holds them: positions and sums in lanes, in lists that are kept.
#pragma once

#include <cstdint>
#include <limits>

#include "base/lanes.hpp"
#include "physics/pair_numbers.hpp"

namespace mappm {

/// As `Rounded`, but each contribution has an excess, that of its sum being as many times as much.
struct RoundedWithExcess {
  template <class Real>
  using Sum = decltype(to_fixed_with_excess(Real()));
  template <class Real>
  MAPPM_INLINE static Sum<Real> of(const Real& x) {
    return to_fixed_with_excess(x);
  }
  static constexpr std::uint64_t excess = rounding_excess;
};

/// Double precision.
template <int D>
class DoubleLanes : public DoublePairs<D> {
 public:
  using RealLanes = Lanes;
  using Coordinate = double;               // a position as the lanes hold it
  using ListRounding = RoundedWithExcess;  // of contributions, in lists that are kept
  /// Extent of a block beyond which not all of its particles are told apart from those of a block nearby; rcut.
  static constexpr double largest_extent = std::numeric_limits<double>::infinity();
  using DoublePairs<D>::DoublePairs;

  /// A position (quanta) for lanes.
  template <class Wide>
  MAPPM_INLINE Wide coordinate(int, const Wide& x) const {
    return x;
  }
  /// Difference of two such, in quanta of the law.
  MAPPM_INLINE static Lanes apart(const Lanes& a, const Lanes& b) { return a - b; }
  /// A coordinate more than rcut away from all that lie within a few rcut of another.
  static double far_from(double coordinate) { return coordinate + 4.0 * box_quanta; }
};

/// Single precision.
template <int D>
class SingleLanes : public SinglePairs<D> {
 public:
  using RealLanes = FloatLanes;
  using Coordinate = std::int32_t;
  using ListRounding = Rounded;
  // Along x a window of 8 holds two such blocks, between them the reach of lists and a narrow cell, and that reach once
  // more. Across, blocks lie in rows, which are not far wider than the reach.
  static constexpr double largest_extent = 2.5;
  using SinglePairs<D>::SinglePairs;

  /// The low 32 bits of a position in quanta of the law: differences wrap, and are right within half a window.
  template <class Wide>
  MAPPM_INLINE auto coordinate(int axis, const Wide& x) const {
    return converted<std::int32_t>(to_fixed(x * Wide(1.0 / this->position_quanta(axis))));
  }
  MAPPM_INLINE static FloatLanes apart(const Int32Lanes& a, const Int32Lanes& b) {
    return converted<float>(wrapped_difference(a, b));
  }
  static std::int32_t far_from(std::int32_t coordinate) {  // half a window, at least 4 rcut
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(coordinate) + (std::uint32_t{1} << 31));
  }
};

/// PPs in a block of lanes.
template <class Numbers>
inline constexpr int block_lanes = static_cast<int>(Numbers::RealLanes::size());

}  // namespace mappm
