// Oracle: the file system.
#include "output/durable_file.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "unit/output/scratch_folder.hpp"
#include "unit/output/small_disk.hpp"

namespace mappm {
namespace {

using testing_tools::contains;
using testing_tools::refusal;
using testing_tools::ScratchFolder;
using testing_tools::SmallDisk;
using testing_tools::text_of;

TEST(WriteDurably, replaces_the_file_and_leaves_nothing_beside_it) {
  const ScratchFolder folder;
  write_durably(folder / "a", "one");
  write_durably(folder / "a", "two");
  EXPECT_EQ(text_of(folder / "a"), "two");
  EXPECT_FALSE(std::filesystem::exists(partial_name(folder / "a")));
}

TEST(WriteDurably, keeps_the_old_file_on_a_full_disk) {
  const ScratchFolder folder;
  write_durably(folder / "a", "one");
  {
    const SmallDisk disk(100);
    const std::string message = refusal<InputError>([&] { write_durably(folder / "a", std::string(1000, 'x')); });
    EXPECT_TRUE(contains(message, "File too large")) << message;
  }
  EXPECT_EQ(text_of(folder / "a"), "one");
  EXPECT_FALSE(std::filesystem::exists(partial_name(folder / "a")));
}

TEST(MakeFolder, names_a_folder_that_cannot_be_made) {
  const ScratchFolder folder;
  write_durably(folder / "a", "a file in the way");
  const std::string message = refusal<InputError>([&] { make_folder(folder / "a/b"); });
  EXPECT_TRUE(contains(message, "a/b: folder cannot be made: Not a directory")) << message;
  make_folder(folder / "b/c");
  EXPECT_TRUE(std::filesystem::is_directory(folder / "b/c"));
}

}  // namespace
}  // namespace mappm
