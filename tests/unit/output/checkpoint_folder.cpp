// Oracle: the files in the folder, and the digest of what is read back from them.
#include "output/checkpoint_folder.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/single_group.hpp"
#include "output/durable_file.hpp"
#include "unit/output/hand_state.hpp"
#include "unit/output/scratch_folder.hpp"
#include "unit/output/small_disk.hpp"

namespace mappm {
namespace {

namespace fs = std::filesystem;
using testing_tools::contains;
using testing_tools::refusal;
using testing_tools::ScratchFolder;
using testing_tools::SmallDisk;

constexpr const char* scene = "fluid.spacing = 0.5\n";

class CheckpointFolder : public testing::Test {
 protected:
  fs::path save(std::uint64_t step) {
    State<2> state = hand::state();
    state.step = step;
    return save_checkpoint(folder_.path() / checkpoint_folder_name, scene, state, step, group_);
  }
  FoundCheckpoint<2> find(const fs::path& from, const std::string& text = scene) const {
    return find_checkpoint<2>(from, text, hand::model(), Region<2>::whole_box(), group_);
  }
  std::string refused(const fs::path& from, const std::string& text = scene) const {
    return refusal<InputError>([&] { find(from, text); });
  }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path() / checkpoint_folder_name))
      names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

  ScratchFolder folder_;
  SingleGroup group_;
};

TEST_F(CheckpointFolder, keeps_the_newest_two) {
  for (const std::uint64_t step : {10, 20, 30}) save(step);
  EXPECT_EQ(names(), (std::vector<std::string>{"checkpoint_000000020.h5", "checkpoint_000000030.h5"}));
  EXPECT_EQ(find(folder_.path()).checkpoint.state.step, 30u);
  EXPECT_EQ(find(folder_.path() / checkpoint_folder_name).checkpoint.state.step, 30u);
}

TEST_F(CheckpointFolder, goes_by_age_so_that_a_run_begun_anew_does_not_lose_its_own) {
  save(1000);
  save(2000);
  save(10);
  EXPECT_EQ(find(folder_.path()).checkpoint.state.step, 10u);
  EXPECT_EQ(names(), (std::vector<std::string>{"checkpoint_000000010.h5", "checkpoint_000002000.h5"}));
}

TEST_F(CheckpointFolder, offers_the_older_one_for_a_file_that_is_cut_short) {
  const fs::path older = save(10);
  const fs::path newer = save(20);
  fs::resize_file(newer, 3000);
  const std::string message = refused(newer);
  EXPECT_TRUE(contains(message, "checkpoint_000000020.h5: cannot be read")) << message;
  EXPECT_TRUE(contains(message, "an older checkpoint is sound, of step 10: --resume " + older.string())) << message;
}

TEST_F(CheckpointFolder, offers_nothing_that_is_not_sound) {
  const fs::path older = save(10);
  const fs::path newer = save(20);
  fs::resize_file(newer, 3000);
  fs::resize_file(older, 3000);
  EXPECT_FALSE(contains(refused(newer), "is sound"));
  EXPECT_FALSE(contains(refused(newer, "fluid.spacing = 0.7\n"), "is sound"));
}

TEST_F(CheckpointFolder, passes_over_a_damaged_one_and_says_so) {
  save(10);
  const fs::path newer = save(20);
  fs::resize_file(newer, 3000);
  const FoundCheckpoint<2> found = find(folder_.path());
  EXPECT_EQ(found.checkpoint.state.step, 10u);
  EXPECT_TRUE(contains(found.warning, "checkpoint_000000020.h5")) << found.warning;
  EXPECT_EQ(digest_share(found.checkpoint.state), digest_share(hand::state()));
}

TEST_F(CheckpointFolder, refuses_a_folder_without_any) {
  EXPECT_TRUE(contains(refused(folder_.path()), "holds no checkpoint"));
  EXPECT_TRUE(contains(refused(folder_.path() / "none"), "none: cannot be read"));
}

TEST_F(CheckpointFolder, keeps_the_old_one_wherever_a_disk_becomes_full) {
  const fs::path older = save(10);
  const auto length = fs::file_size(older);
  int failures = 0;
  for (rlim_t limit = 0; limit < length; limit += length / 37) {
    const std::string message = [&] {
      const SmallDisk disk(limit);
      return refusal<InputError>([&] { save(20); });
    }();
    ++failures;
    EXPECT_TRUE(contains(message, "checkpoint_000000020.h5.partial: cannot be written: File too large")) << message;
    EXPECT_TRUE(contains(message, "the last checkpoint is kept: --resume " + older.string())) << message;
    ASSERT_EQ(names(), std::vector<std::string>{"checkpoint_000000010.h5"}) << "nothing stays of the attempt";
    ASSERT_EQ(find(folder_.path()).checkpoint.state.step, 10u);
  }
  EXPECT_GE(failures, 37);
  save(20);  // with room again
  EXPECT_EQ(find(folder_.path()).checkpoint.state.step, 20u);
}

}  // namespace
}  // namespace mappm
