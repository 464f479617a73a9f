// Units: values worked by hand.
#include "scene/units.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace mappm {
namespace {

TEST(SceneUnits, ValueIsTheDoubleNearestToTheDecimal) {
  EXPECT_EQ(value_in_si("5 um", Quantity::length), 5e-6);
  EXPECT_EQ(value_in_si("12.5mm", Quantity::length), 0.0125);
  EXPECT_EQ(value_in_si(" 1.18 kg/m3 ", Quantity::density), 1.18);
  EXPECT_EQ(value_in_si("1.2 g/cm3", Quantity::density), 1200.0);
  EXPECT_EQ(value_in_si("1.89e-5 Pa s", Quantity::viscosity), 1.89e-5);
  EXPECT_EQ(value_in_si("1 cP", Quantity::viscosity), 1e-3);
  EXPECT_EQ(value_in_si("-9.81 m/s2", Quantity::acceleration), -9.81);
  EXPECT_EQ(value_in_si("48 GPa", Quantity::pressure), 48e9);
  EXPECT_EQ(value_in_si("2 min", Quantity::time), 120.0);
}

std::string reason(std::string_view text, Quantity quantity) {
  try {
    value_in_si(text, quantity);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(SceneUnits, RefusesWhatDoesNotFitAndNamesWhatDoes) {
  EXPECT_EQ(reason("5 kg", Quantity::time),
            "\"kg\" is not a unit of this key; units of this key: s, ms, us, ns, ps, min");
  EXPECT_EQ(reason("5", Quantity::stiffness), "lacks a unit; units of this key: N/m, kN/m");
  EXPECT_EQ(reason("fast", Quantity::velocity), "is not a number; write a number");
  EXPECT_EQ(reason("1 m", Quantity::plain), "has no unit; write the number without quotes");
}

}  // namespace
}  // namespace mappm
