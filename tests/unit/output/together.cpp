// Oracle: what every process must see, by definition: the error of the lowest rank that failed, with its type.
#include "output/together.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "base/single_group.hpp"
#include "unit/output/scratch_folder.hpp"
#include "unit/output/thread_group.hpp"

namespace mappm {
namespace {

using testing_tools::refusal;
using testing_tools::ThreadGroup;

TEST(Together, returns_what_each_process_worked_out) {
  std::atomic<int> sum = 0;
  ThreadGroup(3).run([&](const Group& group) { sum += together(group, [&] { return 10 * group.rank(); }); });
  EXPECT_EQ(sum, 30);
}

TEST(Together, gives_the_error_of_one_process_to_all) {
  std::atomic<int> seen = 0;
  ThreadGroup(3).run([&](const Group& group) {
    const std::string message = refusal<InputError>([&] {
      together(group, [&] {
        if (group.rank() == 2) throw InputError("file: key: fix");
      });
    });
    seen += message == "file: key: fix";
  });
  EXPECT_EQ(seen, 3);
}

TEST(Together, prefers_the_lowest_rank_and_keeps_the_type) {
  std::atomic<int> seen = 0;
  ThreadGroup(3).run([&](const Group& group) {
    const std::string message = refusal<RangeError>([&] {
      together(group, [&]() -> int {
        if (group.rank() == 2) throw InputError("later");
        if (group.rank() == 1) throw RangeError("step 7");
        return 0;
      });
    });
    seen += message == "step 7";
  });
  EXPECT_EQ(seen, 3);
}

TEST(Together, passes_a_defect_on_as_one) {
  EXPECT_EQ(
      refusal<std::runtime_error>([] { together(SingleGroup(), [] { throw std::logic_error("broken promise"); }); }),
      "broken promise");
}

TEST(OnFirst, works_on_the_first_process_alone_and_tells_all_of_its_error) {
  std::atomic<int> worked = 0, seen = 0;
  ThreadGroup(3).run([&](const Group& group) {
    on_first(group, [&] { ++worked; });
    seen += !refusal<InputError>([&] { on_first(group, [] { throw InputError("full"); }); }).empty();
  });
  EXPECT_EQ(worked, 1);
  EXPECT_EQ(seen, 3);
}

}  // namespace
}  // namespace mappm
