// Oracle: a table written by hand.
#include "output/trace_file.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "unit/output/scratch_folder.hpp"
#include "unit/output/thread_group.hpp"

namespace mappm {
namespace {

StepTrace<2> hand_trace() {
  StepTrace<2> trace{36, 1042, {}};
  trace.partners.push_back({true, 3, 17, {{{5, -6}}, {{1, 2}}, 11}, 7});
  trace.partners.push_back({false, 2077, 0, {{{124, 0}}, {{3, 4}}, 12}, 9});
  trace.partners.push_back({false, 90, 0, {{{-1, -2}}, {{-3, -4}}, 13}, 8});
  return trace;
}

TEST(TraceFile, has_a_row_a_partner_in_the_order_of_their_numbers) {
  EXPECT_EQ(trace_text(hand_trace(), true),
            "step,particle,kind,partner,impulse_x,impulse_y,shift_x,shift_y,density\n"
            "36,1042,PP,90,-1,-2,-3,-4,8\n"
            "36,1042,PP,2077,124,0,3,4,9\n"
            "36,1042,FP,3:17,5,-6,1,2,7\n");
  EXPECT_EQ(trace_text(StepTrace<2>{36, 1042, {}}, false), "step,particle,kind,partner,impulse_x,impulse_y,density\n");
}

TEST(TraceFile, is_written_by_the_process_that_has_the_trace) {
  const testing_tools::ScratchFolder folder;
  testing_tools::ThreadGroup(3).run([&](const Group& group) {
    const MaybeTrace<2> mine = group.rank() == 1 ? MaybeTrace<2>(hand_trace()) : std::nullopt;
    write_trace(folder.path(), mine, true, group);
  });
  EXPECT_EQ(testing_tools::text_of(folder / "trace.csv"), trace_text(hand_trace(), true));
}

TEST(TraceFile, of_an_unknown_particle_is_refused_by_all) {
  testing_tools::ThreadGroup(2).run([&](const Group& group) {
    FluidParticles<2> fluid;
    fluid.id.push_back(10 + static_cast<std::uint64_t>(group.rank()));
    EXPECT_NO_THROW(check_traced(fluid, 11, group));
    EXPECT_THROW(check_traced(fluid, 12, group), InputError);
  });
}

}  // namespace
}  // namespace mappm
