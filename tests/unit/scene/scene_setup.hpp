// Scenes and partitions shared by the tests of the scene layer.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "scene/build.hpp"
#include "scene/reader.hpp"

namespace mappm::test {

using Overrides = std::vector<std::string>;

/// One disc in a box of 2 x 4 whose numbers are worked out by hand in the tests of the model.
inline const std::string one_disc = R"(
name = "one disc"
units = "dimensionless"
[box]
size = [2.0, 4.0]
[fluid]
density = 3.0
viscosity = 0.6
spacing = 0.125
rcut = 0.5
sound_speed = 10.0
[[body]]
shape = "disc"
radius = 0.5
density = 6.0
position = [1.0, 1.0]
velocity = [0.3, -0.4]
angular_velocity = 3.0
[force]
fluid = [0.0, 2.0]
[run]
steps = 10
)";

/// A fluid without solids: free of all that a body brings.
inline const std::string plain_fluid = R"(
name = "plain fluid"
units = "dimensionless"
[box]
size = [1.0, 1.0]
[fluid]
density = 1.0
viscosity = 0.01
spacing = 0.0625
sound_speed = 1.0
[run]
steps = 10
)";

inline Scene read(const std::string& text, const Overrides& overrides = {}) {
  return read_scene_text(text, "scene.toml", overrides);
}

/// The message of the InputError that `f` throws; empty if it throws none.
template <class F>
std::string input_error(F&& f) {
  try {
    f();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Expects one InputError whose message holds all of `parts`.
template <class F>
void expect_input_error(F&& f, const std::vector<std::string>& parts) {
  const std::string message = input_error(f);
  ASSERT_NE(message, "") << "no error; expected one with: " << parts.front();
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks " << part;
}

}  // namespace mappm::test
