// The SIMD number type of the fast engine. The physics is written once, over `double` or `Lanes`; this is the only
// file that knows which vector library stands behind.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <experimental/simd>
#include <type_traits>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "base/numbers.hpp"

namespace mappm {

template <class T, class Abi>
using Simd = std::experimental::simd<T, Abi>;

using Lanes = std::experimental::native_simd<double>;
using IntLanes = std::experimental::rebind_simd_t<std::int64_t, Lanes>;
using UIntLanes = std::experimental::rebind_simd_t<std::uint64_t, Lanes>;
inline constexpr int lane_count = static_cast<int>(Lanes::size());
static_assert(sizeof(Lanes) == sizeof(IntLanes), "a lane of integers must be as wide as a lane of doubles");

/// Of single precision, twice as many.
using FloatLanes = std::experimental::native_simd<float>;
using Int32Lanes = std::experimental::rebind_simd_t<std::int32_t, FloatLanes>;
using UInt32Lanes = std::experimental::rebind_simd_t<std::uint32_t, FloatLanes>;
static_assert(sizeof(FloatLanes) == sizeof(Lanes) && sizeof(Int32Lanes) == sizeof(Lanes));

namespace detail {

/// The bits of one vector at the start of another.
template <class To, class From>
MAPPM_INLINE To same_bits(const From& from) {
  To to{};
  std::memcpy(static_cast<void*>(&to), static_cast<const void*>(&from), std::min(sizeof to, sizeof from));
  return to;
}

}  // namespace detail

/// Same rounding as the scalar functions, in every lane.
MAPPM_INLINE UIntLanes to_fixed_with_excess(const Lanes& x) {
  return detail::same_bits<UIntLanes>(x + Lanes(rounding_constant));
}
MAPPM_INLINE IntLanes to_fixed(const Lanes& x) {
  return detail::same_bits<IntLanes>(to_fixed_with_excess(x) - UIntLanes(rounding_excess));
}
MAPPM_INLINE Int32Lanes to_fixed(const FloatLanes& x) {
#if defined(__AVX512F__)
  return detail::same_bits<Int32Lanes>(_mm512_cvtps_epi32(detail::same_bits<__m512>(x)));
#elif defined(__AVX__)
  return detail::same_bits<Int32Lanes>(_mm256_cvtps_epi32(detail::same_bits<__m256>(x)));
#elif defined(__SSE2__)
  return detail::same_bits<Int32Lanes>(_mm_cvtps_epi32(detail::same_bits<__m128>(x)));
#else
  return Int32Lanes([&](auto lane) { return to_fixed(static_cast<float>(x[lane])); });
#endif
}

template <class T, class Abi>
struct NumberType<Simd<T, Abi>> {
  using Number = Simd<T, Abi>;
  using Scalar = T;
  MAPPM_INLINE static Number square_root(const Number& x) { return std::experimental::sqrt(x); }
  MAPPM_INLINE static Number larger(const Number& a, const Number& b) { return std::experimental::max(a, b); }
  MAPPM_INLINE static Number smaller(const Number& a, const Number& b) { return std::experimental::min(a, b); }
  MAPPM_INLINE static Number magnitude(const Number& x) { return std::experimental::abs(x); }
  MAPPM_INLINE static auto nearest_fixed(const Number& x) { return to_fixed(x); }
  template <class U>
  MAPPM_INLINE static auto converted(const Number& x) {
    return std::experimental::static_simd_cast<std::experimental::rebind_simd_t<U, Number>>(x);
  }
};

/// As many numbers as a register holds.
template <class T>
MAPPM_INLINE auto load_lanes(const T* from) {
  using Widest = std::conditional_t<sizeof(T) == sizeof(double), Lanes, FloatLanes>;
  return std::experimental::rebind_simd_t<T, Widest>(from, std::experimental::element_aligned);
}
template <class T, class Abi>
MAPPM_INLINE void store_lanes(const Simd<T, Abi>& lanes, T* to) {
  lanes.copy_to(to, std::experimental::element_aligned);
}
template <class T>
requires std::is_arithmetic_v<T> MAPPM_INLINE void store_lanes(T lane, T* to) { *to = lane; }
/// Numbers of one type, as many as there are lanes of double precision.
template <class T>
MAPPM_INLINE auto load_as_many(const T* from) {
  return std::experimental::rebind_simd_t<T, Lanes>(from, std::experimental::element_aligned);
}

/// The type in which sums of a type are modulo a power of two, as its own need not be.
template <class T>
struct WrappingOf {
  using Type = T;
};
template <std::integral T>
struct WrappingOf<T> {
  using Type = std::make_unsigned_t<T>;
};
template <class T>
using Wrapping = typename WrappingOf<T>::Type;

/// Modulo 2^32.
MAPPM_INLINE Int32Lanes wrapped_difference(const Int32Lanes& a, const Int32Lanes& b) {
  return converted<std::int32_t>(converted<std::uint32_t>(a) - converted<std::uint32_t>(b));
}

/// 0, 1, 2, ...
template <class Vector = Lanes>
MAPPM_INLINE Vector lane_numbers() {
  return Vector([](auto lane) { return static_cast<Scalar<Vector>>(lane); });
}

/// The whole parts of non-negative numbers, or of numbers above -1.
MAPPM_INLINE void whole_numbers(const Lanes& lanes, std::int32_t* to) {
  store_lanes(converted<std::int32_t>(lanes), to);
}

template <class T, class Abi>
MAPPM_INLINE bool any_below(const Simd<T, Abi>& lanes, Scalar<Simd<T, Abi>> limit) {
  return std::experimental::any_of(lanes < limit);
}

template <class T, class Abi>
MAPPM_INLINE bool any_of_lanes(const std::experimental::simd_mask<T, Abi>& mask) {
  return std::experimental::any_of(mask);
}

template <class T, class Abi>
MAPPM_INLINE T sum_of_lanes(const Simd<T, Abi>& lanes) {
  return std::experimental::reduce(lanes);
}
/// The library takes three times as long.
MAPPM_INLINE std::uint32_t sum_of_lanes(const UInt32Lanes& lanes) {
#if defined(__AVX2__)
#if defined(__AVX512F__)
  const auto whole = detail::same_bits<__m512i>(lanes);
  const __m256i all = _mm256_add_epi32(_mm512_castsi512_si256(whole), _mm512_extracti64x4_epi64(whole, 1));
#else
  const auto all = detail::same_bits<__m256i>(lanes);
#endif
  __m128i sum = _mm_add_epi32(_mm256_castsi256_si128(all), _mm256_extracti128_si256(all, 1));
  sum = _mm_add_epi32(sum, _mm_shuffle_epi32(sum, 0b01'00'11'10));
  return static_cast<std::uint32_t>(_mm_cvtsi128_si32(_mm_add_epi32(sum, _mm_shuffle_epi32(sum, 0b10'11'00'01))));
#else
  return std::experimental::reduce(lanes);
#endif
}

/// Writes those of as many numbers as there are lanes that the mask names, side by side, and returns how many these
/// are. As many as there are lanes are overwritten.
MAPPM_INLINE std::uint32_t store_chosen(const Lanes::mask_type& chosen, const std::uint32_t* numbers,
                                        std::uint32_t* to) {
#if defined(__AVX512F__) && defined(__AVX512VL__)
  static_assert(sizeof chosen == sizeof(__mmask8), "a bit a lane");
  const auto bits = detail::same_bits<__mmask8>(chosen);
  const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(numbers));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_maskz_compress_epi32(bits, all));
  return static_cast<std::uint32_t>(std::popcount(static_cast<unsigned>(bits)));
#else
  std::uint32_t count = 0;
  for (std::uint32_t lane = 0; lane < static_cast<std::uint32_t>(lane_count); ++lane) {
    to[count] = numbers[lane];
    count += chosen[lane] ? 1 : 0;
  }
  return count;
#endif
}

}  // namespace mappm
