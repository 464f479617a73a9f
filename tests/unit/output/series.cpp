// Oracle: the row of hand_state.hpp worked by hand, in the units that it gives.
#include "output/series.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/single_group.hpp"
#include "unit/output/hand_state.hpp"
#include "unit/output/scratch_folder.hpp"

namespace mappm {
namespace {

using testing_tools::ScratchFolder;
using testing_tools::text_of;

constexpr const char* si_header =
    "step,time [s],fluid_velocity_x [m/s],fluid_velocity_y [m/s],superficial_velocity_x [m/s],"
    "superficial_velocity_y [m/s],solid_velocity_x [m/s],solid_velocity_y [m/s],slip_x [m/s],slip_y [m/s],"
    "drag_x [N/m],drag_y [N/m],wall_force_x [N/m],wall_force_y [N/m],fluid_energy [J/m],internal_energy [J/m],"
    "solid_energy [J/m],spin_energy [J/m],angular_momentum [kg "
    "m/s],fluid_particles,lowest_density_ratio,highest_density_ratio,"
    "momentum_x,momentum_y,impulse_x,impulse_y,momentum_defect_x,momentum_defect_y,digest";

Columns hand_columns(const UnitNames& units) {
  State<2> state = hand::state();
  state.outside_impulse = hand::iota(0.25, 0.5);  // leaves a defect of a quarter: 2^46 iota
  return series_columns(hand::model(), units, measure(hand::model(), hand::sample(state), SingleGroup()),
                        state.start_momentum, 4);
}

TEST(Series, row_is_the_one_worked_by_hand) {
  // time 6 x 0.5 x 0.125; PPs (1/8, 1/8) x 4; superficial: x 4 PPs / (8 per area x area 8); SPs (3/8, -1/8) x 4;
  // drag (6, -3) / 3 SPs / (2 steps of 0.5) x 256; energies x 128;
  // momentum 4 PPs (1/8, 1/8) + 2 SPs of 16 (3/8, -1/8) = (12.5, -3.5), impulse (1/4, 1/2), in iota of 2^-48
  // energy of compression, as in the test of the totals, x 128; angular momentum 4.25 x 16
  const std::string before = "6,0.375,0.5,0.5,0.03125,0.03125,1.5,-0.5,1,-1,512,-256,256,256,40,";
  const std::string after =
      ",384,512,68,4,0.875,1.125,"
      "3518437208883200,-985162418487296,70368744177664,140737488355328,70368744177664,0,";
  const std::string row = hand_columns({}).row();
  ASSERT_EQ(row.substr(0, before.size()), before);
  std::size_t used = 0;
  EXPECT_NEAR(std::stod(row.substr(before.size()), &used), 128.0 * (std::log(63.0 / 64.0) + 2.0 / 63.0), 1e-12);
  EXPECT_EQ(row.substr(before.size() + used), after + digest_text(digest_share(hand::state())));
}

TEST(Series, header_names_units_of_the_scene) {
  EXPECT_EQ(hand_columns(si_unit_names(2)).header(), si_header);
  EXPECT_EQ(hand_columns({}).header().find('['), std::string::npos) << "dimensionless scenes have no units";
}

TEST(Series, of_a_scene_without_solids_has_no_column_of_theirs) {
  Model<3> model;
  model.box = {{1.0, 1.0, 1.0}};
  model.rest_density = 1.0;
  EXPECT_EQ(series_columns(model, si_unit_names(3), Totals<3>{}, {}, 0).header(),
            "step,time [s],fluid_velocity_x [m/s],fluid_velocity_y [m/s],fluid_velocity_z [m/s],"
            "superficial_velocity_x [m/s],superficial_velocity_y [m/s],superficial_velocity_z [m/s],fluid_energy [J],"
            "internal_energy [J],angular_momentum_x [kg m2/s],angular_momentum_y [kg m2/s],"
            "angular_momentum_z [kg "
            "m2/"
            "s],fluid_particles,lowest_density_ratio,highest_density_ratio,momentum_x,momentum_y,momentum_z,impulse_x,"
            "impulse_y,impulse_z,"
            "momentum_defect_x,momentum_defect_y,momentum_defect_z,digest");
}

TEST(Series, drag_is_the_mean_over_sps_fixed_or_not) {
  State<2> state = hand::state();
  state.solids.resize(2);  // one free, one fixed; impulses (4, 1) and (0, -3)
  const Totals<2> totals = measure(hand::model(), hand::sample(state), SingleGroup());
  const std::string row = series_columns(hand::model(), {}, totals, state.start_momentum, 4).row();
  EXPECT_NE(row.find(",512,-256,0,0,"), std::string::npos) << row;
}

TEST(Series, goes_on_after_a_restart_as_if_there_had_been_none) {
  const ScratchFolder folder;
  const Model<2> model = hand::model();
  const SingleGroup group;
  State<2> state = hand::state();
  Totals<2> totals = measure(model, hand::sample(state), group);
  const auto write = [&](std::optional<std::uint64_t> resumed, std::initializer_list<std::uint64_t> steps) {
    Series<2> series(folder.path(), model, si_unit_names(2), group, resumed);
    for (const std::uint64_t step : steps) {
      totals.step = step;
      series.add(totals, {}, step < 10 ? 0 : step - 10);
    }
  };
  write(std::nullopt, {0, 10, 20, 30});
  const std::string uninterrupted = text_of(folder / "series.csv");
  write(15, {20, 30});
  EXPECT_EQ(text_of(folder / "series.csv"), uninterrupted);
  EXPECT_EQ(uninterrupted.substr(0, uninterrupted.find('\n')), si_header);
}

}  // namespace
}  // namespace mappm
