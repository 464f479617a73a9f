// Oracle: what a disk refuses at the start it would refuse at the end.
#include "output/output_trial.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/single_group.hpp"
#include "unit/output/scratch_folder.hpp"
#include "unit/output/small_disk.hpp"

namespace mappm {
namespace {

namespace fs = std::filesystem;
using testing_tools::contains;
using testing_tools::refusal;

class Trial : public testing::Test {
 protected:
  std::string refused(const std::vector<ExpectedFile>& files) {
    return refusal<InputError>([&] { try_output(files, group_); });
  }

  testing_tools::ScratchFolder folder_;
  SingleGroup group_;
};

TEST_F(Trial, leaves_nothing_and_touches_nothing) {
  testing_tools::write_text(folder_ / "one.h5", "before");
  EXPECT_EQ(refused({{folder_ / "one.h5", 1000}, {folder_ / "new/two.h5", 1000}}), "");
  EXPECT_EQ(testing_tools::text_of(folder_ / "one.h5"), "before");
  EXPECT_FALSE(fs::exists(folder_ / "new"));
  EXPECT_FALSE(fs::exists(folder_ / "one.h5.partial"));
}

TEST_F(Trial, removes_only_folders_that_it_made) {
  testing_tools::write_text(folder_ / "file", "before");
  EXPECT_TRUE(contains(refused({{folder_ / "file/one.h5", 1000}}), "file: folder cannot be made"));
  EXPECT_EQ(testing_tools::text_of(folder_ / "file"), "before");
  fs::create_directory(folder_ / "empty");
  fs::create_directory_symlink(folder_ / "empty", folder_ / "link");
  EXPECT_EQ(refused({{folder_ / "empty/one.h5", 1000}, {folder_ / "link/two.h5", 1000}}), "");
  EXPECT_TRUE(fs::is_directory(fs::symlink_status(folder_ / "empty")));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
}

TEST_F(Trial, refuses_a_file_that_is_too_long_for_its_limit) {
  const testing_tools::SmallDisk disk(1'000'000);
  EXPECT_EQ(refused({{folder_ / "new/one.h5", 900'000}}), "");
  const std::string message = refused({{folder_ / "one.h5", 1000}, {folder_ / "new/two.h5", 1'000'000}});
  EXPECT_TRUE(contains(message, "two.h5.partial: cannot be written: File too large")) << message;
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(Trial, refuses_a_name_that_is_too_long) {
  const std::string message = refused({{folder_ / std::string(250, 'n'), 0}});
  EXPECT_TRUE(contains(message, "cannot be written: File name too long")) << message;
}

TEST_F(Trial, refuses_more_than_the_disk_has) {
  const std::uint64_t most = fs::space(folder_.path()).capacity;
  const std::string message = refused({{folder_ / "one.h5", most + 1'000'000}});
  EXPECT_TRUE(contains(message, "one.h5.partial: cannot be written: No space left on device")) << message;
}

}  // namespace
}  // namespace mappm
