// Oracle: rates and times worked by hand.
#include "output/progress.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace mappm {
namespace {

TEST(Progress, prints_a_plain_line_a_minute) {
  std::ostringstream out;
  Progress progress(out, ProgressStyle::lines, 0, 1000, 5000);
  progress.update(50, 30.0);
  EXPECT_EQ(out.str(), "");
  progress.update(100, 61.0);  // 100 x 5000 / 61 s; 900 steps at 0.61 s are 549 s
  EXPECT_EQ(out.str(), "step 100/1000  8.2e+03 particle-steps/s  remaining 0:09:09\n");
  progress.update(150, 100.0);
  progress.update(200, 122.0);
  progress.finish();
  EXPECT_EQ(out.str().substr(out.str().find('\n') + 1), "step 200/1000  8.2e+03 particle-steps/s  remaining 0:08:08\n");
}

TEST(Progress, counts_from_the_step_at_which_a_run_was_resumed) {
  std::ostringstream out;
  Progress progress(out, ProgressStyle::lines, 9000, 18000, 10);
  progress.update(9100, 100.0);  // 10 particles a second; 8900 steps of 1 s
  EXPECT_EQ(out.str(), "step 9100/18000  10 particle-steps/s  remaining 2:28:20\n");
}

TEST(Progress, draws_a_bar_and_clears_it) {
  std::ostringstream out;
  Progress progress(out, ProgressStyle::bar, 0, 1000, 5000);
  progress.update(500, 10.0);
  EXPECT_EQ(out.str(),
            "\r[===============>               ]  50 %  step 500/1000  2.5e+05 particle-steps/s  "
            "remaining 0:00:10\033[K");
  progress.update(501, 10.1);
  progress.finish();
  EXPECT_EQ(out.str().substr(out.str().size() - 4), "\r\033[K");
}

TEST(Progress, says_nothing_when_asked_to_be_silent) {
  std::ostringstream out;
  Progress progress(out, ProgressStyle::silent, 0, 1000, 5000);
  progress.update(500, 1000.0);
  progress.finish();
  EXPECT_EQ(out.str(), "");
  EXPECT_EQ(progress_style(true), ProgressStyle::silent);
}

}  // namespace
}  // namespace mappm
