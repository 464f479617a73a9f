// Oracle: which key differs, by hand.
#include "output/scene_identity.hpp"

#include <gtest/gtest.h>

namespace mappm {
namespace {

TEST(FirstDifference, names_the_key_and_both_values) {
  EXPECT_EQ(first_difference("a = 0\nb = 1\n", "a = 0\nb = 2\n"), "b = 1 here and 2 in the checkpoint");
  EXPECT_EQ(first_difference("a = x = y\n", "a = x = z\n"), "a = x = y here and x = z in the checkpoint");
  EXPECT_EQ(first_difference("a = 1\n", "a = 1\n"), "");
}

TEST(FirstDifference, compares_like_keys_only) {
  EXPECT_EQ(first_difference("a = 1\nb = 2\n", "b = 2\n"), "a = 1 here and not given in the checkpoint");
  EXPECT_EQ(first_difference("b = 2\n", "a = 1\nb = 2\n"), "a = not given here and 1 in the checkpoint");
  // A value that differs says more than a key that comes with it.
  EXPECT_EQ(first_difference("a = 1\nb = 2\n", "b = 3\n"), "b = 2 here and 3 in the checkpoint");
}

TEST(FirstDifference, shows_of_a_long_value_the_part_that_differs) {
  const std::string zeros(200, '0');
  const std::string text = first_difference("a = " + zeros + "1" + zeros + "\n", "a = " + zeros + "2" + zeros + "\n");
  EXPECT_EQ(text, "a = ..." + zeros.substr(0, 30) + "1" + zeros.substr(0, 29) + "... here and ..." +
                      zeros.substr(0, 30) + "2" + zeros.substr(0, 29) + "... in the checkpoint");
}

TEST(TextHash, sees_every_letter) {
  EXPECT_EQ(text_hash("abc"), text_hash("abc"));
  EXPECT_NE(text_hash("abc"), text_hash("abd"));
  EXPECT_NE(text_hash("abc"), text_hash("ab"));
}

}  // namespace
}  // namespace mappm
