// Oracle: a bit changed anywhere, or bytes taken away or added, is refused; on any number of processes alike.
#include "output/file_seal.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/single_group.hpp"
#include "unit/output/scratch_folder.hpp"
#include "unit/output/thread_group.hpp"

namespace mappm {
namespace {

using testing_tools::contains;
using testing_tools::refusal;
using testing_tools::ScratchFolder;
using testing_tools::text_of;
using testing_tools::write_text;

class FileSeal : public testing::Test {
 protected:
  std::string refused() const {
    return refusal<InputError>([&] { check_seal(path_, SingleGroup()); });
  }
  ScratchFolder folder_;
  std::filesystem::path path_ = folder_ / "sealed";
};

TEST_F(FileSeal, finds_every_bit) {
  write_text(path_, "seventeen letters");
  seal_file(path_, SingleGroup());
  EXPECT_EQ(refused(), "");
  const std::string sealed = text_of(path_);
  ASSERT_EQ(sealed.size(), 17u + 24u);
  for (std::size_t bit = 0; bit < 8 * sealed.size(); ++bit) {
    std::string altered = sealed;
    altered[bit / 8] = static_cast<char>(altered[bit / 8] ^ (1 << (bit % 8)));
    write_text(path_, altered);
    EXPECT_NE(refused(), "") << bit;
  }
}

TEST_F(FileSeal, finds_what_is_missing_or_too_much) {
  write_text(path_, std::string(100, 'x'));
  EXPECT_TRUE(contains(refused(), "sealed: cannot be read: it is cut short, damaged"));
  seal_file(path_, SingleGroup());
  const std::string sealed = text_of(path_);
  for (std::size_t length = 0; length < sealed.size(); ++length) {
    write_text(path_, sealed.substr(0, length));
    EXPECT_NE(refused(), "") << length;
  }
  write_text(path_, sealed + "y");
  EXPECT_NE(refused(), "");
  std::filesystem::remove(path_);
  EXPECT_TRUE(contains(refused(), "sealed: cannot be read: No such file"));
}

TEST_F(FileSeal, is_the_same_on_any_number_of_processes) {
  write_text(path_, std::string(5'000'001, 'x'));  // several blocks
  seal_file(path_, SingleGroup());
  const std::string sealed = text_of(path_);
  write_text(path_, sealed.substr(0, 5'000'001));
  testing_tools::ThreadGroup(3).run([&](const Group& group) { seal_file(path_, group); });
  EXPECT_EQ(text_of(path_), sealed);
  std::string altered = sealed;
  altered.front() = 'y';
  write_text(path_, altered);
  testing_tools::ThreadGroup(3).run([&](const Group& group) {
    EXPECT_TRUE(contains(refusal<InputError>([&] { check_seal(path_, group); }), "sealed: is damaged: its bytes"));
  });
}

}  // namespace
}  // namespace mappm
