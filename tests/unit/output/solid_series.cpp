// Oracle: the rows of hand_state.hpp worked by hand.
#include "output/solid_series.hpp"

#include <gtest/gtest.h>

#include "base/single_group.hpp"
#include "unit/output/hand_state.hpp"
#include "unit/output/scratch_folder.hpp"
#include "unit/output/thread_group.hpp"

namespace mappm {
namespace {

using testing_tools::ScratchFolder;
using testing_tools::text_of;

// position x 0.5, velocity x 4, omega 2 / 0.125, drag x 256 over one unit of time; the wall (id 2) is left out
constexpr const char* rows =
    "6,0.375,0,1,0.5,2,-1,0,1,16,1024,256\n"
    "6,0.375,1,0.5,0,0,0,1,0,0,0,-768\n"
    "6,0.375,3,1.5,0.5,1,0,1,0,0,512,-256\n";
constexpr const char* header =
    "step,time [s],id,position_x [m],position_y [m],velocity_x [m/s],velocity_y [m/s],orientation_cos,"
    "orientation_sin,angular_velocity [rad/s],drag_x [N/m],drag_y [N/m]\n";

TEST(SolidSeries, has_a_row_per_sp_as_worked_by_hand) {
  const ScratchFolder folder;
  const Model<2> model = hand::model();
  const SingleGroup group;
  SolidSeries<2>(folder.path(), model, si_unit_names(2), group, std::nullopt).add(hand::state(), 4);
  EXPECT_EQ(text_of(folder / "solids.csv"), std::string(header) + rows);
}

TEST(SolidSeries, is_gathered_and_sorted_by_id) {
  const ScratchFolder folder;
  const Model<2> model = hand::model();
  testing_tools::ThreadGroup(2).run([&](const Group& group) {
    State<2> half = hand::state();
    const auto middle = half.solids.begin() + 1;
    if (group.is_first())
      half.solids.erase(half.solids.begin(), middle);  // the first process holds the larger ids
    else
      half.solids.erase(middle, half.solids.end());
    SolidSeries<2>(folder.path(), model, si_unit_names(2), group, std::nullopt).add(half, 4);
  });
  EXPECT_EQ(text_of(folder / "solids.csv"), std::string(header) + rows);
}

}  // namespace
}  // namespace mappm
