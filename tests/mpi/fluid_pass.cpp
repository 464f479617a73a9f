// Oracle: the same pass over memory that holds nothing else.
#include "parallel/fluid_pass.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "unit/serial/scenes.hpp"

namespace mappm {
namespace {

constexpr const char* swirl = R"(
name = "swirl"
units = "dimensionless"
[box]
size = [4.0, 5.0]
[fluid]
density = 12.25
viscosity = 1.0
spacing = 0.285714
rcut = 1.0
sound_speed = 1.0
wave = { amplitude = 0.05, direction = "x", gradient = "y", mode = 1 }
[run]
steps = 1
)";

std::vector<NeighbourSums<2>> sums_over(const Model<2>& model, FluidParticles<2> fluid, double behind) {
  for (auto& values : fluid.field) {  // what lies in memory behind the last particle
    const std::size_t count = values.size();
    values.resize(count + 64, behind);
    values.resize(count);
  }
  CellGrid<2> grid;
  grid.fit(Region<2>::whole_box(), model.pair.length, 3);
  grid.sort(fluid);
  for (auto& values : fluid.field) {  // sorting swapped the arrays
    const std::size_t count = values.size();
    values.resize(count + 64, behind);
    values.resize(count);
  }
  FluidPass<2> pass(model, 1);
  std::vector<NeighbourSums<2>> frozen_sums, result;
  pass.sum(fluid, grid, {}, frozen_sums);
  for (std::size_t i = 0; i < fluid.size(); ++i) result.push_back(pass.sums(i));
  return result;
}

TEST(FluidPass, does_not_see_what_lies_behind_the_last_particle) {
  const testing::Built<2> built(swirl);
  const State<2> state = built.state();
  const auto clean = sums_over(built.model, state.fluid, 0.0);
  const auto dirty = sums_over(built.model, state.fluid, std::numeric_limits<double>::quiet_NaN());
  ASSERT_EQ(clean.size(), dirty.size());
  for (std::size_t i = 0; i < clean.size(); ++i) {
    EXPECT_EQ(clean[i].impulse, dirty[i].impulse) << "particle " << i;
    EXPECT_EQ(clean[i].shift, dirty[i].shift) << "particle " << i;
    EXPECT_EQ(clean[i].density, dirty[i].density) << "particle " << i;
  }
}

}  // namespace
}  // namespace mappm
