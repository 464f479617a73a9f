// Oracle: which lines of a declaration describe the scene, listed by hand.
#include "output/scene_identity.hpp"

#include <gtest/gtest.h>

namespace mappm {
namespace {

constexpr const char* scene = R"(name = 'a'

[fluid]
spacing = 0.5

[output]
sample = 100

[run]
    relax = 10
    steps = 500

[[body]]
positions = [
    [ 0.1, 0.2 ],
    [ 0.3, 0.4 ]
]
)";

TEST(SceneIdentity, leaves_out_output_and_length_of_the_run_only) {
  EXPECT_EQ(
      scene_identity(scene),
      "name = 'a'\n[fluid]\nspacing = 0.5\nrun.relax = 10\n[[body]]\npositions = [\n[ 0.1, 0.2 ],\n[ 0.3, 0.4 ]\n]\n");
}

TEST(SceneIdentity, is_the_same_for_a_longer_run_with_other_output) {
  std::string longer = scene;
  longer.replace(longer.find("steps = 500"), 11, "duration = 7.5");
  longer.replace(longer.find("sample = 100"), 12, "sample = 1\nsolids = true");
  EXPECT_EQ(scene_identity(longer), scene_identity(scene));
  std::string without = scene;
  without.erase(without.find("[output]"), without.find("[run]") - without.find("[output]"));
  EXPECT_EQ(scene_identity(without), scene_identity(scene));
}

TEST(SceneIdentity, knows_tables_written_in_one_line) {
  EXPECT_EQ(scene_identity("output = { sample = 3 }\nrun = { relax = 10, steps = 5 }\nunits = 'si'\n"),
            "run.relax = 10\nunits = 'si'\n");
}

TEST(SceneIdentity, sees_any_other_change) {
  for (const auto& [from, to] :
       {std::pair{"0.5", "0.6"}, {"relax = 10", "relax = 11"}, {"0.3", "0.35"}, {"'a'", "'b'"}}) {
    std::string other = scene;
    other.replace(other.find(from), std::string(from).size(), to);
    EXPECT_NE(scene_identity(other), scene_identity(scene)) << to;
  }
}

TEST(FirstDifference, names_both_lines) {
  EXPECT_EQ(first_difference("a\nb = 1\n", "a\nb = 2\n"), "'b = 1' instead of 'b = 2'");
  EXPECT_EQ(first_difference("a\n", "a\nb\n"), "nothing instead of 'b'");
  EXPECT_EQ(first_difference("a\n", "a\n"), "");
}

TEST(TextHash, sees_every_letter) {
  EXPECT_EQ(text_hash("abc"), text_hash("abc"));
  EXPECT_NE(text_hash("abc"), text_hash("abd"));
  EXPECT_NE(text_hash("abc"), text_hash("ab"));
}

}  // namespace
}  // namespace mappm
