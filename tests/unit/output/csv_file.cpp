// Oracle: the text that a table should hold, written out.
#include "output/csv_file.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "unit/output/scratch_folder.hpp"

namespace mappm {
namespace {

using testing_tools::contains;
using testing_tools::refusal;
using testing_tools::ScratchFolder;
using testing_tools::text_of;
using testing_tools::write_text;

TEST(CsvFile, starts_anew_without_a_step_to_resume_from) {
  const ScratchFolder folder;
  write_text(folder / "t.csv", "old\n");
  CsvFile(folder / "t.csv", "step,a", std::nullopt).add("0,1\n");
  EXPECT_EQ(text_of(folder / "t.csv"), "step,a\n0,1\n");
}

TEST(CsvFile, drops_rows_beyond_the_checkpoint_and_a_row_cut_short) {
  const ScratchFolder folder;
  write_text(folder / "t.csv", "step,a\n0,1\n100,2\n100,3\n200,4\n1");
  CsvFile(folder / "t.csv", "step,a", 150).add("200,5\n");
  EXPECT_EQ(text_of(folder / "t.csv"), "step,a\n0,1\n100,2\n100,3\n200,5\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "t.csv.partial"));
}

TEST(CsvFile, begins_where_there_is_nothing_to_continue) {
  const ScratchFolder folder;
  CsvFile(folder / "t.csv", "step,a", 150).add("200,5\n");
  EXPECT_EQ(text_of(folder / "t.csv"), "step,a\n200,5\n");
}

TEST(CsvFile, refuses_a_table_with_other_columns_and_leaves_it) {
  const ScratchFolder folder;
  write_text(folder / "t.csv", "step,b\n0,1\n");
  const std::string message = refusal<InputError>([&] { CsvFile(folder / "t.csv", "step,a", 5); });
  EXPECT_TRUE(contains(message, "t.csv: its columns are not those of this scene")) << message;
  EXPECT_EQ(text_of(folder / "t.csv"), "step,b\n0,1\n");
}

TEST(CsvFile, names_the_file_that_cannot_be_written) {
  EXPECT_TRUE(contains(refusal<InputError>([] { CsvFile("/dev/full", "step", std::nullopt); }), "No space left"));
  EXPECT_TRUE(contains(refusal<InputError>([] { CsvFile("/nowhere/t.csv", "step", std::nullopt); }), "/nowhere/t.csv"));
}

}  // namespace
}  // namespace mappm
