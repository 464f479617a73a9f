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

TEST(SceneUnits, ReadsSignsAndSpacesAsPeopleWriteThem) {
  for (const char* text : {"+0.05 Pa s", "0.05\tPa s", "0.05\u00a0Pa\u00a0s", "0.05\u202fPa  s", "\t+0.05 Pa\ts ",
                           "0.05 Pa\u00b7s", "50 mPa s", "+5e-2 Pa s"})
    EXPECT_EQ(value_in_si(text, Quantity::viscosity), 0.05) << text;
  EXPECT_EQ(value_in_si("5 \u00b5m", Quantity::length), 5e-6);
  EXPECT_EQ(value_in_si("5 \u03bcm", Quantity::length), 5e-6);
  EXPECT_EQ(value_in_si("\u22129.81 m/s\u00b2", Quantity::acceleration), -9.81);
  EXPECT_EQ(value_in_si("1.18 kg/m\u00b3", Quantity::density), 1.18);
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
  for (const char* text : {"+-5 m", "--5 m", "+", "", "\u00a0"})
    EXPECT_EQ(reason(text, Quantity::length), "is not a number; write a number") << text;
  EXPECT_EQ(reason("0,05 Pa s", Quantity::viscosity),
            "has a comma in its number; write a decimal point, and no sign between thousands");
  EXPECT_EQ(reason("1,000.5 m", Quantity::length),
            "has a comma in its number; write a decimal point, and no sign between thousands");
  EXPECT_EQ(reason("1e999 m", Quantity::length), "is too large or too small for a number");
  EXPECT_EQ(reason("1 m", Quantity::plain), "has no unit; write the number without quotes");
}

}  // namespace
}  // namespace mappm
