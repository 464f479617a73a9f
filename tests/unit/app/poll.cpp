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

}  // namespace
}  // namespace mappm
