// Units in which a quantity of a scene may be written ("1.89e-5 Pa s"), and their value in SI.
#pragma once

#include <string>
#include <string_view>

namespace mappm {

/// What a number of the scene measures.
enum class Quantity {
  plain,
  length,
  time,
  velocity,
  angular_velocity,
  acceleration,
  density,
  viscosity,
  stiffness,
  pressure
};

/// Value in SI of a text such as "5 um". Throws std::invalid_argument with the reason, which names the units known for
/// the quantity.
double value_in_si(std::string_view text, Quantity quantity);

}  // namespace mappm
