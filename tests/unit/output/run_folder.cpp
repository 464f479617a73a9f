// Oracle: the rule that a folder belongs to one run.
#include "output/run_folder.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <optional>

#include "base/error.hpp"
#include "base/single_group.hpp"
#include "unit/output/scratch_folder.hpp"
#include "unit/output/thread_group.hpp"

namespace mappm {
namespace {

namespace fs = std::filesystem;
using testing_tools::contains;
using testing_tools::refusal;
using testing_tools::ThreadGroup;
using testing_tools::write_text;
using Entry = RunFolder::Entry;

class AFolder : public testing::Test {
 protected:
  fs::path path() const { return scratch_.path() / "out" / "run"; }
  void write(const std::string& name, const std::string& text = "x") {
    fs::create_directories((path() / name).parent_path());
    write_text(path() / name, text);
  }
  std::string refused(Entry entry) {
    return refusal<InputError>([&] { RunFolder(path(), entry, group_); });
  }

  testing_tools::ScratchFolder scratch_;
  SingleGroup group_;
};

TEST_F(AFolder, is_made_and_goes_if_nothing_was_written) {
  std::optional<RunFolder> folder(std::in_place, path(), Entry::refuse, group_);
  EXPECT_TRUE(fs::exists(path()));
  folder.reset();
  EXPECT_TRUE(fs::is_empty(scratch_.path()));
}

TEST_F(AFolder, that_was_there_stays) {
  fs::create_directories(path());
  RunFolder(path(), Entry::refuse, group_);
  EXPECT_TRUE(fs::is_empty(path()));
}

TEST_F(AFolder, with_anything_of_a_run_is_refused) {
  for (const char* name : {"run.json", "series.csv", "solids.csv", "faces.csv", "trace.csv", "run.json.partial",
                           "snapshots/fluid_000000100.vtkhdf", "snapshots/solids_0.vtkhdf.partial",
                           "checkpoints/checkpoint_000000050.h5"}) {
    write(name);
    const std::string message = refused(Entry::refuse);
    EXPECT_TRUE(contains(message, fs::path(name).filename().string() + " of an earlier run")) << message;
    EXPECT_TRUE(contains(message, "--out = " + path().string()) && contains(message, "--overwrite")) << message;
    fs::remove_all(path());
  }
}

TEST_F(AFolder, with_files_of_others_is_not) {
  for (const char* name : {"scene.toml", "log", "series.csv.old", "my_run.json", "snapshots/fluid.png"}) write(name);
  EXPECT_EQ(refused(Entry::refuse), "");
}

TEST_F(AFolder, is_cleared_of_what_a_run_wrote_and_of_nothing_else) {
  for (const char* name : {"run.json", "series.csv", "snapshots/fluid_1.vtkhdf", "snapshots/fluid.png", "notes",
                           "checkpoints/checkpoint_1.h5", "checkpoints/checkpoint_2.h5.partial"})
    write(name);
  const RunFolder folder(path(), Entry::overwrite, group_);
  EXPECT_TRUE(fs::exists(path() / "run.json")) << "nothing goes before the run is sure to begin";
  folder.open("", group_);
  for (const char* gone : {"run.json", "series.csv", "snapshots/fluid_1.vtkhdf", "checkpoints"})
    EXPECT_FALSE(fs::exists(path() / gone)) << gone;
  EXPECT_TRUE(fs::exists(path() / "notes"));
  EXPECT_TRUE(fs::exists(path() / "snapshots/fluid.png"));
}

TEST_F(AFolder, is_resumed_by_a_run_of_the_same_scene) {
  write("run.json", R"({"scene": {"identity": "fluid.spacing = 1\n"}})");
  write("series.csv");
  write("checkpoints/checkpoint_2.h5.partial");
  const RunFolder folder(path(), Entry::resume, group_);
  folder.open("fluid.spacing = 1\n", group_);
  EXPECT_TRUE(fs::exists(path() / "series.csv"));
  EXPECT_FALSE(fs::exists(path() / "checkpoints/checkpoint_2.h5.partial")) << "what a kill left half written";
  const std::string message = refusal<InputError>([&] { folder.open("fluid.spacing = 2\n", group_); });
  EXPECT_TRUE(contains(message, "run.json: is of another scene: fluid.spacing = 2 here and 1 in run.json")) << message;
}

TEST_F(AFolder, whose_record_is_damaged_is_not_resumed) {
  write("run.json", "{");
  const RunFolder folder(path(), Entry::resume, group_);
  EXPECT_TRUE(contains(refusal<InputError>([&] { folder.open("a = 1\n", group_); }), "is of another scene"));
}

TEST_F(AFolder, in_which_a_run_is_at_work_is_refused_to_all_others) {
  std::optional<RunFolder> folder(std::in_place, path(), Entry::refuse, group_);
  for (const Entry entry : {Entry::refuse, Entry::resume, Entry::overwrite})
    EXPECT_TRUE(contains(refused(entry), "another run is at work")) << refused(entry);
  write("series.csv");
  folder.reset();
  EXPECT_EQ(refused(Entry::overwrite), "");
}

TEST_F(AFolder, is_not_kept_by_a_lock_that_nobody_holds) {
  write("run.lock");  // as a killed run leaves it
  EXPECT_EQ(refused(Entry::refuse), "");
}

TEST_F(AFolder, is_refused_to_all_members_of_a_group) {
  write("series.csv");
  std::atomic<int> seen = 0;
  ThreadGroup(3).run([&](const Group& group) {
    seen += contains(refusal<InputError>([&] { RunFolder(path(), Entry::refuse, group); }), "series.csv");
  });
  EXPECT_EQ(seen, 3);
}

}  // namespace
}  // namespace mappm
