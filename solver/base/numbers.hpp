// What the laws need of a number type beside + - * / and comparisons. They are written once, over `double`, `float` or
// lanes of these, and know no lanes: each number type says here how it does the rest (lanes: base/lanes.hpp).
#pragma once

#include <cmath>
#include <type_traits>
#include <utility>

#include "base/fixed_point.hpp"

/// The pair law runs a billion times a minute: its small functions must not be called, and compilers do not always see.
#define MAPPM_INLINE [[gnu::always_inline]] inline

namespace mappm {

/// Of a single number; other number types specialise it.
template <class Number>
struct NumberType {
  static_assert(std::is_arithmetic_v<Number>, "a number type specialises NumberType");
  using Scalar = Number;
  MAPPM_INLINE static Number square_root(Number x) { return std::sqrt(x); }
  MAPPM_INLINE static Number larger(Number a, Number b) { return a < b ? b : a; }
  MAPPM_INLINE static Number smaller(Number a, Number b) { return b < a ? b : a; }
  MAPPM_INLINE static Number magnitude(Number x) { return std::fabs(x); }
  MAPPM_INLINE static auto nearest_fixed(Number x) { return to_fixed(x); }
  template <class T>
  MAPPM_INLINE static T converted(Number x) {
    return static_cast<T>(x);
  }
};

/// The single number of which a number type holds one or several.
template <class Number>
using Scalar = typename NumberType<Number>::Scalar;

/// A constant of a law in a number type.
template <class Real>
MAPPM_INLINE Real constant(double value) {
  return Real(static_cast<Scalar<Real>>(value));
}

template <class Real>
MAPPM_INLINE Real square_root(const Real& x) {
  return NumberType<Real>::square_root(x);
}

template <class Real>
MAPPM_INLINE Real larger(const Real& a, const Real& b) {
  return NumberType<Real>::larger(a, b);
}

template <class Real>
MAPPM_INLINE Real smaller(const Real& a, const Real& b) {
  return NumberType<Real>::smaller(a, b);
}

template <class Real>
MAPPM_INLINE Real magnitude(const Real& x) {
  return NumberType<Real>::magnitude(x);
}

/// Each number in another type: rounded to nearest, cut to its whole part, or to its low bits.
template <class T, class Number>
MAPPM_INLINE auto converted(const Number& x) {
  return NumberType<Number>::template converted<T>(x);
}

/// An integer as a real number: exact below 2^53, else rounded to nearest.
template <class Integer>
MAPPM_INLINE auto real_of(const Integer& x) {
  return converted<double>(x);
}

/// The nearest integer, ties to even (`to_fixed`): of a double in 64 bits, of a float in 32.
template <class Real>
MAPPM_INLINE auto nearest_fixed(const Real& x) {
  return NumberType<Real>::nearest_fixed(x);
}
template <class Real>
using Fixed = decltype(nearest_fixed(std::declval<Real>()));

}  // namespace mappm
