// Oracle: the rule that a number on the command line is in decimal digits, whole and in range, or refused.
#include "app/options.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "scene/scene.hpp"
#include "unit/output/scratch_folder.hpp"

namespace mappm {
namespace {

using testing_tools::contains;
using testing_tools::refusal;

RunOptions parsed(const std::vector<std::string>& words) {
  CLI::App app;
  RunOptions options;
  add_run_options(*app.add_subcommand("run"), options);
  std::vector<std::string> reversed{words.rbegin(), words.rend()};
  reversed.push_back("run");
  app.parse(std::move(reversed));
  return options;
}

std::string refused(const std::vector<std::string>& words) {
  return refusal<InputError>([&] { parsed(words); });
}

TEST(RunOptions, read_numbers_as_decimal_digits) {
  EXPECT_EQ(parsed({"a.toml", "--steps", "010"}).steps, 10u);
  EXPECT_EQ(parsed({"a.toml", "--steps", "0"}).steps, 0u);
  EXPECT_EQ(parsed({"a.toml", "--steps", "9007199254740992"}).steps, last_countable_step);
  EXPECT_EQ(parsed({"a.toml", "--trace", "0012@034"}).trace->particle, 12u);
}

TEST(RunOptions, refuse_what_is_no_number_in_range) {
  for (const char* text : {"", "0x10", "1e3", "5.0", "-5", "+5", " 5", "5 ", "9007199254740993", "18446744073709551616",
                           "99999999999999999999", "five"}) {
    const std::string message = refused({"a.toml", "--steps", text});
    EXPECT_TRUE(contains(message, "--steps = ") && contains(message, "from 0 to 9007199254740992")) << message;
  }
  for (const char* text : {"", "7", "@", "7@", "@7", "0x7@1", "7@-1", "7@1@2", "18446744073709551616@1"})
    EXPECT_TRUE(contains(refused({"a.toml", "--trace", text}), "--trace")) << text;
}

TEST(RunOptions, refuse_a_text_that_is_empty) {
  EXPECT_TRUE(contains(refused({""}), "scene = \"\": is empty"));
  for (const char* option : {"--out", "--resume"})
    EXPECT_TRUE(contains(refused({"a.toml", option, ""}), std::string(option) + " = \"\": is empty")) << option;
}

}  // namespace
}  // namespace mappm
