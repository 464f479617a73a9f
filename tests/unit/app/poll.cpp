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

TEST(StopSignal, raises_a_flag_and_nothing_else) {
  for (const int number : {SIGTERM, SIGINT}) {
    stop_signal = 0;
    watch_stop_signals();
    EXPECT_FALSE(stop_requested());
    std::raise(number);
    EXPECT_TRUE(stop_requested());
    std::signal(number, SIG_DFL);
  }
  stop_signal = 0;
}

TEST(Poll, tells_of_a_signal_once_it_has_come) {
  const SingleGroup group;
  Poll poll(group, 0);
  EXPECT_FALSE(poll.agree_to_stop(1, 0.0));
  stop_signal = SIGTERM;
  EXPECT_TRUE(poll.agree_to_stop(2, 0.0));
  stop_signal = 0;
}

TEST(Poll, waits_half_a_second_but_at_most_twenty_steps) {
  const SingleGroup group;
  Poll poll(group, 0);
  poll.agree_to_stop(100, 0.1);
  EXPECT_FALSE(poll.due(104));
  EXPECT_TRUE(poll.due(105));
  poll.agree_to_stop(200, 1e-6);
  EXPECT_FALSE(poll.due(219));
  EXPECT_TRUE(poll.due(220));
  poll.agree_to_stop(300, 60.0);
  EXPECT_TRUE(poll.due(301));
}

TEST(Poll, agrees_on_the_shortest_wait) {
  ThreadGroup(2).run([](const Group& group) {
    Poll poll(group, 0);
    poll.agree_to_stop(10, group.is_first() ? 1e-6 : 0.25);
    EXPECT_FALSE(poll.due(11));
    EXPECT_TRUE(poll.due(12));
  });
}

TEST(Poll, gives_the_earliest_range_error_to_all) {
  std::atomic<int> seen = 0;
  ThreadGroup(3).run([&](const Group& group) {
    Poll poll(group, 0);
    if (group.rank() == 0) poll.note(9, "followed");
    if (group.rank() == 2) {
      poll.note(7, "");
      poll.note(8, "first");
      poll.note(9, "first and more");
    }
    seen += refusal<RangeError>([&] { poll.agree_to_stop(10, 0.0); }) == "first";
  });
  EXPECT_EQ(seen, 3);
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
    poll.agree_to_stop(5, 0.0);
    poll.note(FirstOverlaps{seen[group.rank()], {}});
    poll.agree_to_stop(10, 0.0);
    poll.agree_to_stop(20, 0.0);
  });
  EXPECT_EQ(warnings, 4);
  EXPECT_EQ(right, 4);
}

TEST(Poll, an_overlap_beyond_the_last_ends_the_run_for_all_unless_another_value_left_its_range_before) {
  std::atomic<int> seen = 0;
  ThreadGroup(2).run([&](const Group& group) {
    Poll poll(group, 0);
    if (group.rank() == 1) poll.note(FirstOverlaps{{}, overlap(8, 0.6, 1, "too deep")});
    poll.note(9, group.is_first() ? "followed" : "");
    seen += refusal<RangeError>([&] { poll.agree_to_stop(10, 0.0); }) == "too deep";
    Poll other(group, 0);
    if (group.rank() == 1) other.note(FirstOverlaps{{}, overlap(8, 0.6, 1, "followed")});
    other.note(7, group.is_first() ? "fluid" : "");
    seen += refusal<RangeError>([&] { other.agree_to_stop(10, 0.0); }) == "fluid";
  });
  EXPECT_EQ(seen, 4);
}

}  // namespace
}  // namespace mappm
