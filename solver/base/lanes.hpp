// The SIMD number type of the fast engine. The physics is written once, over `double` or `Lanes`; this is the only
// file that knows which vector library stands behind.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <experimental/simd>

#include "base/fixed_point.hpp"

/// The pair law runs a billion times a minute: its small functions must not be called, and compilers do not always see.
#define MAPPM_INLINE [[gnu::always_inline]] inline

namespace mappm {

using Lanes = std::experimental::native_simd<double>;
using IntLanes = std::experimental::rebind_simd_t<std::int64_t, Lanes>;
inline constexpr int lane_count = static_cast<int>(Lanes::size());
static_assert(sizeof(Lanes) == sizeof(IntLanes), "a lane of integers must be as wide as a lane of doubles");

MAPPM_INLINE IntLanes bits_of(const Lanes& x) {
  IntLanes bits;
  std::memcpy(static_cast<void*>(&bits), static_cast<const void*>(&x), sizeof bits);
  return bits;
}

/// Same rounding as the scalar `to_fixed`, in every lane.
MAPPM_INLINE IntLanes to_fixed(const Lanes& x) {
  return bits_of(x + Lanes(rounding_constant)) - IntLanes(std::bit_cast<std::int64_t>(rounding_constant));
}

MAPPM_INLINE double square_root(double x) { return std::sqrt(x); }
MAPPM_INLINE Lanes square_root(const Lanes& x) { return std::experimental::sqrt(x); }

MAPPM_INLINE double larger(double a, double b) { return a < b ? b : a; }
MAPPM_INLINE Lanes larger(const Lanes& a, const Lanes& b) { return std::experimental::max(a, b); }

MAPPM_INLINE double smaller(double a, double b) { return b < a ? b : a; }
MAPPM_INLINE Lanes smaller(const Lanes& a, const Lanes& b) { return std::experimental::min(a, b); }

MAPPM_INLINE Lanes load_lanes(const double* from) { return Lanes(from, std::experimental::element_aligned); }
MAPPM_INLINE IntLanes load_lanes(const std::int64_t* from) {
  return IntLanes(from, std::experimental::element_aligned);
}
MAPPM_INLINE void store_lanes(const Lanes& lanes, double* to) { lanes.copy_to(to, std::experimental::element_aligned); }
MAPPM_INLINE void store_lanes(const IntLanes& lanes, std::int64_t* to) {
  lanes.copy_to(to, std::experimental::element_aligned);
}

/// 0, 1, 2, ...
MAPPM_INLINE Lanes lane_numbers() {
  return Lanes([](auto lane) { return static_cast<double>(lane); });
}

/// The whole parts of non-negative numbers, or of numbers above -1.
MAPPM_INLINE void whole_numbers(const Lanes& lanes, std::int32_t* to) {
  using Int32Lanes = std::experimental::rebind_simd_t<std::int32_t, Lanes>;
  std::experimental::static_simd_cast<Int32Lanes>(lanes).copy_to(to, std::experimental::element_aligned);
}

MAPPM_INLINE bool any_below(const Lanes& lanes, double limit) { return std::experimental::any_of(lanes < limit); }

MAPPM_INLINE std::int64_t sum_of_lanes(const IntLanes& lanes) { return std::experimental::reduce(lanes); }

/// The integer type that belongs to a number type.
template <class Real>
struct FixedOf;
template <>
struct FixedOf<double> {
  using Type = std::int64_t;
};
template <>
struct FixedOf<Lanes> {
  using Type = IntLanes;
};
template <class Real>
using Fixed = typename FixedOf<Real>::Type;

}  // namespace mappm
