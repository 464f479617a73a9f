// Oracle: rows written by hand; 2^100 in Python's integers.
#include "output/face_series.hpp"

#include <gtest/gtest.h>

#include "unit/output/scratch_folder.hpp"
#include "unit/output/thread_group.hpp"

namespace mappm {
namespace {

TEST(FaceSeries, gathers_integers_of_128_bits_in_the_order_of_ranks) {
  const testing_tools::ScratchFolder folder;
  constexpr Int128 one = 1;
  testing_tools::ThreadGroup(2).run([&](const Group& group) {
    FaceSeries<2> series(folder.path(), group, std::nullopt);
    series.add(0, {});  // before the first step there is none
    if (group.rank() == 0)
      series.add(5, {{1, {{(one << 100) + 1, -(one << 100) - 1}}}, {all_partners, {{-1, (one << 48) - 1}}}});
    else
      series.add(5, {{0, {{-(one << 48), 0}}}});
  });
  EXPECT_EQ(testing_tools::text_of(folder / "faces.csv"),
            "step,rank,partner,impulse_x,impulse_y\n"
            "5,0,1,1267650600228229401496703205377,-1267650600228229401496703205377\n"
            "5,0,-1,-1,281474976710655\n"
            "5,1,0,-281474976710656,0\n");
}

}  // namespace
}  // namespace mappm
