// Fixed-point numbers: why results do not depend on the order of sums (see solver/README.md).
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace mappm {

__extension__ using Int128 = __int128;

/// Positions per axis are integers in [0, box_quanta), kept in doubles, which hold them exactly; a ghost may lie one
/// box side outside. Every difference of two positions is then an exact double.
inline constexpr double box_quanta = 4503599627370496.0;  // 2^52

/// Velocity quantum in units of the sound speed; with the PP mass as unit of mass, also the quantum iota of momentum.
inline constexpr double velocity_quantum = 0x1p-48;

/// Density quantum in units of PP mass / rcut^D.
inline constexpr double density_quantum = 0x1p-44;

/// A velocity, a density and an impulse stay exact doubles below 2^53 quanta.
inline constexpr double exact_quanta = 0x1p53;

/// Range of `to_fixed`: a single contribution must stay below 2^51 quanta.
inline constexpr double fixed_range = 0x1p51;

inline constexpr double rounding_constant = 0x1.8p52;

inline constexpr std::uint64_t rounding_excess = std::bit_cast<std::uint64_t>(rounding_constant);
/// `to_fixed` plus `rounding_excess`, modulo 2^64: a sum of many can shed it all at once.
inline std::uint64_t to_fixed_with_excess(double x) { return std::bit_cast<std::uint64_t>(x + rounding_constant); }

/// Rounds x (|x| < 2^51) to the nearest integer, ties to even, by the bits of x + 1.5 2^52. Lanes have the same
/// function with the same result (base/lanes.hpp). Outside the range the result is at least 2^51 in magnitude.
inline std::int64_t to_fixed(double x) { return static_cast<std::int64_t>(to_fixed_with_excess(x) - rounding_excess); }

/// Rounds x (|x| < 2^31) to the nearest integer, ties to even. Outside the range, and for NaN, the result is -2^31.
inline std::int32_t to_fixed(float x) {
  constexpr std::int32_t lowest = std::numeric_limits<std::int32_t>::min();
  if (!(x >= -0x1p31f && x < 0x1p31f)) return lowest;
  return static_cast<std::int32_t>(std::lrint(x));
}

/// Rounds x to the nearest integer, for |x| < 2^126: sums over a solid are longer than one word.
inline Int128 to_fixed_wide(double x) {
  const double magnitude = std::fabs(x);
  if (magnitude >= box_quanta) return static_cast<Int128>(x);
  const double rounded = (magnitude + box_quanta) - box_quanta;
  return static_cast<std::int64_t>(std::copysign(rounded, x));
}

/// The nearest multiple of a quantum (a power of two): how a value enters the integer state.
inline double round_to_quantum(double value, double quantum) {
  return static_cast<double>(to_fixed_wide(value / quantum)) * quantum;
}

/// Moves an integer position by at most one box side into [0, box_quanta).
inline double wrap_position(double x) {
  if (x < 0.0) return x + box_quanta;
  if (x >= box_quanta) return x - box_quanta;
  return x;
}

/// Difference of two positions by the nearest periodic image, in [-2^51, 2^51): exact.
inline double nearest_difference(double a, double b) {
  const double difference = a - b;
  if (difference < -0.5 * box_quanta) return difference + box_quanta;
  if (difference >= 0.5 * box_quanta) return difference - box_quanta;
  return difference;
}

}  // namespace mappm
