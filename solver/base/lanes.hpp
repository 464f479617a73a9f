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
MAPPM_INLINE void store_lanes(const IntLanes& lanes, std::int64_t* to) {
  lanes.copy_to(to, std::experimental::element_aligned);
}

/// All bits set, then none: read from `lane_count - count` on, it keeps the first `count` lanes.
inline constexpr auto lane_window = [] {
  std::array<std::int64_t, 2 * lane_count> window{};
  for (int lane = 0; lane < lane_count; ++lane) window[lane] = -1;
  return window;
}();

/// `x` in the first `count` lanes, `other` in the rest. By bits, since clang 14 leaves out the assignment through
/// `std::experimental::where` when it compiles for AVX-512.
MAPPM_INLINE Lanes first_lanes(int count, const Lanes& x, double other) {
  const IntLanes keep = load_lanes(&lane_window[lane_count - count]);
  const IntLanes bits = (bits_of(x) & keep) | (bits_of(Lanes(other)) & ~keep);
  Lanes result;
  std::memcpy(static_cast<void*>(&result), static_cast<const void*>(&bits), sizeof result);
  return result;
}

/// Stores only the first `count` lanes; the memory of the others is not touched.
MAPPM_INLINE void store_first_lanes(int count, const IntLanes& lanes, std::int64_t* to) {
  const IntLanes index([](auto lane) { return static_cast<std::int64_t>(lane); });
  std::experimental::where(index < IntLanes(count), lanes).copy_to(to, std::experimental::element_aligned);
}

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
