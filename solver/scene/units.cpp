#include "scene/units.hpp"

#include <fmt/format.h>

#include <charconv>
#include <stdexcept>
#include <utility>

namespace mappm {

namespace {

/// A unit as a ratio of two exact numbers, so that "5 um" is the double nearest to 5e-6.
struct Unit {
  Quantity quantity;
  std::string_view name;
  double times, over;
};

constexpr Unit units[] = {
    {Quantity::length, "m", 1.0, 1.0},
    {Quantity::length, "cm", 1.0, 1e2},
    {Quantity::length, "mm", 1.0, 1e3},
    {Quantity::length, "um", 1.0, 1e6},
    {Quantity::length, "nm", 1.0, 1e9},
    {Quantity::time, "s", 1.0, 1.0},
    {Quantity::time, "ms", 1.0, 1e3},
    {Quantity::time, "us", 1.0, 1e6},
    {Quantity::time, "ns", 1.0, 1e9},
    {Quantity::time, "ps", 1.0, 1e12},
    {Quantity::time, "min", 60.0, 1.0},
    {Quantity::velocity, "m/s", 1.0, 1.0},
    {Quantity::velocity, "cm/s", 1.0, 1e2},
    {Quantity::velocity, "mm/s", 1.0, 1e3},
    {Quantity::velocity, "um/s", 1.0, 1e6},
    {Quantity::angular_velocity, "rad/s", 1.0, 1.0},
    {Quantity::angular_velocity, "1/s", 1.0, 1.0},
    {Quantity::acceleration, "m/s2", 1.0, 1.0},
    {Quantity::acceleration, "cm/s2", 1.0, 1e2},
    {Quantity::acceleration, "mm/s2", 1.0, 1e3},
    {Quantity::density, "kg/m3", 1.0, 1.0},
    {Quantity::density, "g/cm3", 1e3, 1.0},
    {Quantity::density, "g/l", 1.0, 1.0},
    {Quantity::viscosity, "Pa s", 1.0, 1.0},
    {Quantity::viscosity, "mPa s", 1.0, 1e3},
    {Quantity::viscosity, "kg/(m s)", 1.0, 1.0},
    {Quantity::viscosity, "cP", 1.0, 1e3},
    {Quantity::stiffness, "N/m", 1.0, 1.0},
    {Quantity::stiffness, "kN/m", 1e3, 1.0},
    {Quantity::pressure, "Pa", 1.0, 1.0},
    {Quantity::pressure, "kPa", 1e3, 1.0},
    {Quantity::pressure, "MPa", 1e6, 1.0},
    {Quantity::pressure, "GPa", 1e9, 1.0},
};

std::string known_units(Quantity quantity) {
  std::string names;
  for (const Unit& unit : units)
    if (unit.quantity == quantity) names += fmt::format("{}{}", names.empty() ? "" : ", ", unit.name);
  return names;
}

/// Letters that look like others or like nothing, as keyboards and texts have them, and what is meant.
constexpr std::pair<std::string_view, std::string_view> spellings[] = {
    {"\t", " "},      // tab
    {"\u00a0", " "},  // no-break space
    {"\u2007", " "},  // figure space
    {"\u2009", " "},  // thin space
    {"\u202f", " "},  // narrow no-break space
    {"\u00b7", " "},  // middle dot, as in Pa s
    {"\u2212", "-"},  // minus sign
    {"\u00b5", "u"},  // micro sign
    {"\u03bc", "u"},  // Greek mu
    {"\u00b2", "2"},  // superscripts
    {"\u00b3", "3"},  //
};

/// In plain letters, with single spaces and none at the ends.
std::string plain(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    std::string_view letter = text.substr(0, 1), meant = letter;
    for (const auto& [written, sign] : spellings)
      if (text.starts_with(written)) {
        letter = written;
        meant = sign;
      }
    text.remove_prefix(letter.size());
    if (meant != " " || !(result.empty() || result.back() == ' ')) result += meant;
  }
  if (result.ends_with(' ')) result.pop_back();
  return result;
}

bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }

}  // namespace

double value_in_si(std::string_view text, Quantity quantity) {
  const std::string whole = plain(text);
  const char* const begin = whole.data() + (whole.starts_with('+') && !whole.starts_with("+-") ? 1 : 0);
  const char* const last = whole.data() + whole.size();
  double value = 0.0;
  const auto [end, error] = std::from_chars(begin, last, value);
  if (error == std::errc::result_out_of_range) throw std::invalid_argument("is too large or too small for a number");
  if (error != std::errc{}) throw std::invalid_argument("is not a number; write a number");
  if (last - end > 1 && *end == ',' && is_digit(end[1]))
    throw std::invalid_argument("has a comma in its number; write a decimal point, and no sign between thousands");
  const std::string name(end + (end != last && *end == ' ' ? 1 : 0), last);
  if (quantity == Quantity::plain) throw std::invalid_argument("has no unit; write the number without quotes");
  for (const Unit& unit : units)
    if (unit.quantity == quantity && unit.name == name) return value * unit.times / unit.over;
  throw std::invalid_argument(fmt::format(
      "{}; units of this key: {}",
      name.empty() ? "lacks a unit" : fmt::format("\"{}\" is not a unit of this key", name), known_units(quantity)));
}

}  // namespace mappm
