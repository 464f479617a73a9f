// Oracle: what all processes must come to know, by definition.
#include "app/poll.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "base/single_group.hpp"
#include "unit/output/scratch_folder.hpp"
#include "unit/output/thread_group.hpp"

namespace mappm {
namespace {

using testing_tools::refusal;
using testing_tools::ThreadGroup;

using What = FaultOrigin::What;

const FirstFault none;

FirstFault fault_of(const FaultOrigin& origin, const std::string& text) {
  FirstFault fault;
  fault.note(origin, text);
  return fault;
}

TEST(StopSignal, raises_a_flag_and_nothing_else) {
  for (const int number : {SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU}) {
    stop_signal = 0;
    watch_stop_signals();
    EXPECT_FALSE(stop_requested());
    std::raise(number);
    EXPECT_TRUE(stop_requested());
    std::signal(number, SIG_DFL);
  }
  stop_signal = 0;
}

TEST(StopSignal, leaves_a_hangup_alone_that_is_ignored) {
  stop_signal = 0;
  std::signal(SIGHUP, SIG_IGN);  // as nohup does
  watch_stop_signals();
  std::raise(SIGHUP);
  EXPECT_FALSE(stop_requested());
  for (const int number : {SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU}) std::signal(number, SIG_DFL);
}

TEST(Poll, tells_of_a_signal_once_it_has_come) {
  const SingleGroup group;
  Poll poll(group, 0);
  EXPECT_FALSE(poll.agree_to_stop(1, 0.0, none));
  stop_signal = SIGTERM;
  EXPECT_TRUE(poll.agree_to_stop(2, 0.0, none));
  stop_signal = 0;
}

TEST(Poll, waits_half_a_second_but_at_most_twenty_steps) {
  const SingleGroup group;
  Poll poll(group, 0);
  poll.agree_to_stop(100, 0.1, none);
  EXPECT_FALSE(poll.due(104));
  EXPECT_TRUE(poll.due(105));
  poll.agree_to_stop(200, 1e-6, none);
  EXPECT_FALSE(poll.due(219));
  EXPECT_TRUE(poll.due(220));
  poll.agree_to_stop(300, 60.0, none);
  EXPECT_TRUE(poll.due(301));
}

TEST(Poll, agrees_on_the_shortest_wait) {
  ThreadGroup(2).run([](const Group& group) {
    Poll poll(group, 0);
    poll.agree_to_stop(10, group.is_first() ? 1e-6 : 0.25, none);
    EXPECT_FALSE(poll.due(11));
    EXPECT_TRUE(poll.due(12));
  });
}

TEST(Poll, gives_the_first_fault_of_all_to_all) {
  // The lowest step; then what a step looks at first; then the lowest id; then the lowest FP.
  const FaultOrigin origins[][3] = {
      {{9, What::fluid_motion, 0, 0}, {}, {8, What::fluid_motion, 5, 0}},
      {{8, What::solid_motion, 0, 0}, {8, What::fluid_motion, 3, 0}, {8, What::frozen_density, 5, 7}},
      {{8, What::solid_motion, 2, 0}, {8, What::solid_motion, 1, 0}, {8, What::solid_motion, 0, 0}},
      {{8, What::frozen_density, 2, 4}, {}, {8, What::frozen_density, 2, 3}},
  };
  for (const auto& origin : origins) {
    std::atomic<int> seen = 0;
    ThreadGroup(3).run([&](const Group& group) {
      const FaultOrigin& mine = origin[group.rank()];
      const FirstFault fault = mine.step == 0 ? none : fault_of(mine, group.rank() == 2 ? "first" : "later");
      seen += refusal<RangeError>([&] { Poll(group, 0).agree_to_stop(10, 0.0, fault); }) == "first";
    });
    EXPECT_EQ(seen, 3);
  }
}

TEST(FirstFault, keeps_the_first_whatever_the_order_of_their_coming) {
  FirstFault fault;
  EXPECT_FALSE(fault.any());
  fault.note({7, What::fluid_density, 1, 0}, "");
  EXPECT_FALSE(fault.any()) << "an empty text is none";
  fault.note({7, What::solid_motion, 4, 0}, "solid 4");
  fault.note({7, What::solid_motion, 2, 0}, "solid 2");
  fault.note({7, What::solid_motion, 3, 0}, "solid 3");
  fault.note({8, What::fluid_density, 0, 0}, "a step later");
  EXPECT_EQ(fault.text(), "solid 2");
}

FirstOverlap overlap(double step, double depth, std::uint64_t solid, const char* text) {
  return {step, {depth, solid, 9.0}, text};
}

TEST(Poll, warns_all_once_of_the_deepest_overlap_of_the_first_step) {
  std::atomic<int> right = 0, warnings = 0;
  ThreadGroup(4).run([&](const Group& group) {
    Poll poll(group, 0, [&](const std::string& text) {
      ++warnings;
      right += text == "deepest";
    });
    const FirstOverlap seen[] = {overlap(8, 0.4, 1, "later"), overlap(7, 0.2, 1, "shallow"),
                                 overlap(7, 0.3, 3, "of a larger id"), overlap(7, 0.3, 2, "deepest")};
    poll.agree_to_stop(5, 0.0, none);
    poll.note(FirstOverlaps{seen[group.rank()], {}});
    poll.agree_to_stop(10, 0.0, none);
    poll.agree_to_stop(20, 0.0, none);
  });
  EXPECT_EQ(warnings, 4);
  EXPECT_EQ(right, 4);
}

TEST(Poll, an_overlap_beyond_the_last_ends_the_run_for_all_unless_another_value_left_its_range_before) {
  std::atomic<int> seen = 0;
  ThreadGroup(2).run([&](const Group& group) {
    Poll poll(group, 0);
    if (group.rank() == 1) poll.note(FirstOverlaps{{}, overlap(8, 0.6, 1, "too deep")});
    const FirstFault later = fault_of({9, What::fluid_motion, 0, 0}, group.is_first() ? "followed" : "");
    seen += refusal<RangeError>([&] { poll.agree_to_stop(10, 0.0, later); }) == "too deep";
    Poll other(group, 0);
    if (group.rank() == 1) other.note(FirstOverlaps{{}, overlap(8, 0.6, 1, "followed")});
    const FirstFault before = fault_of({7, What::fluid_motion, 0, 0}, group.is_first() ? "fluid" : "");
    seen += refusal<RangeError>([&] { other.agree_to_stop(10, 0.0, before); }) == "fluid";
  });
  EXPECT_EQ(seen, 4);
}

}  // namespace
}  // namespace mappm
