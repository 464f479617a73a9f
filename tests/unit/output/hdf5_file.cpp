// Oracle: what was written.
#include "output/hdf5_file.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/single_group.hpp"
#include "unit/output/scratch_folder.hpp"

namespace mappm {
namespace {

using testing_tools::contains;
using testing_tools::refusal;
using testing_tools::ScratchFolder;

class Hdf5File : public testing::Test {
 protected:
  Hdf5File() : path_((folder_ / "a.h5").string()) {
    Hdf5Writer file(path_, group_);
    file.make_group("g");
    file.text_attribute("g", "kind", "vertex");
    file.attribute("g", "numbers", std::vector<std::uint64_t>{7, 8});
    file.attribute("g", "number", std::vector<std::uint64_t>{9});
    file.rows("g/pairs", std::vector<std::int64_t>{1, -2, 3, -4, 5, -6}, 2);
    file.rows("g/line", std::vector<std::uint64_t>{4, 5, 6}, 0);
    file.rows("g/none", std::vector<std::uint64_t>{}, 3);
    file.close();
  }
  ScratchFolder folder_;
  SingleGroup group_;
  std::string path_;
};

TEST_F(Hdf5File, reads_attributes_and_slices_of_rows) {
  const Hdf5Reader file(path_);
  EXPECT_EQ(file.text_attribute("g", "kind"), "vertex");
  EXPECT_EQ(file.attribute<std::uint64_t>("g", "numbers"), (std::vector<std::uint64_t>{7, 8}));
  EXPECT_EQ(file.number_attribute("g", "number"), 9u);
  EXPECT_EQ(file.row_count("g/pairs"), 3u);
  EXPECT_EQ(file.rows<std::int64_t>("g/pairs", 1, 2, 2), (std::vector<std::int64_t>{3, -4, 5, -6}));
  EXPECT_EQ(file.rows<std::uint64_t>("g/line", 2, 1, 0), std::vector<std::uint64_t>{6});
  EXPECT_EQ(file.row_count("g/none"), 0u);
}

TEST_F(Hdf5File, refuses_what_is_not_there) {
  const Hdf5Reader file(path_);
  const auto message = [&](auto&& work) { return refusal<InputError>(work); };
  EXPECT_TRUE(contains(message([&] { file.row_count("g/x"); }), "a.h5: cannot be read: data set 'g/x' is missing"));
  EXPECT_TRUE(contains(message([&] { file.text_attribute("g", "x"); }), "attribute 'x' is missing"));
  EXPECT_TRUE(contains(message([&] { file.text_attribute("g", "number"); }), "attribute 'number' is not one text"));
  EXPECT_TRUE(contains(message([&] { file.number_attribute("g", "numbers"); }), "is not one number"));
  EXPECT_TRUE(contains(message([&] { file.rows<std::int64_t>("g/pairs", 2, 2, 2); }), "is too short"));
  EXPECT_TRUE(contains(message([&] { file.rows<std::int64_t>("g/pairs", 0, 1, 3); }), "another width"));
  EXPECT_TRUE(contains(message([&] { file.rows<std::int64_t>("g/pairs", 0, 1, 0); }), "another shape"));
}

TEST_F(Hdf5File, names_a_file_that_cannot_be_opened) {
  EXPECT_TRUE(contains(refusal<InputError>([] { Hdf5Reader("/nowhere/a.h5"); }), "No such file or directory"));
  const std::string message = refusal<InputError>([] { Hdf5Writer("/nowhere/a.h5", SingleGroup()); });
  EXPECT_TRUE(contains(message, "/nowhere/a.h5: cannot be written: No such file or directory")) << message;
}

}  // namespace
}  // namespace mappm
