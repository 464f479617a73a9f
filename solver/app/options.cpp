#include "app/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <string_view>

#include "base/error.hpp"
#include "scene/scene.hpp"

namespace mappm {

namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& fix) {
  throw InputError("command line", option, text, fix);
}

/// In decimal digits; none for any other text and for what 64 bits do not hold.
std::optional<std::uint64_t> digits(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failed != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

TraceRequest read_trace(const std::string& text) {
  const std::size_t at = std::min(text.find('@'), text.size());
  const auto particle = digits(std::string_view(text).substr(0, at));
  const auto step = at == text.size() ? std::nullopt : digits(std::string_view(text).substr(at + 1));
  if (!particle || !step) refuse("--trace", text, "write ID@STEP, the id of a PP and a step, as in 1042@36");
  return {*particle, *step};
}

}  // namespace

CLI::Option* add_text(CLI::App& command, const std::string& name, std::string& to, const std::string& description) {
  const auto take = [name, &to](const std::string& text) {
    if (text.empty()) refuse(name, "\"\"", "is empty; give a value, or leave the option out");
    to = text;
  };
  return command.add_option_function<std::string>(name, take, description);
}

std::uint64_t whole_number(const std::string& option, const std::string& text, std::uint64_t lowest,
                           std::uint64_t highest) {
  const std::optional<std::uint64_t> value = digits(text);
  if (!value || *value < lowest || *value > highest)
    refuse(option, text.empty() ? "\"\"" : text,
           fmt::format("write a whole number from {} to {}, in decimal digits", lowest, highest));
  return *value;
}

std::string shell_word(const std::string& word) {
  const auto is_plain = [](unsigned char letter) {
    return std::isalnum(letter) != 0 ||
           std::string_view("_-./=:,+@%").find(static_cast<char>(letter)) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string quoted = "'";
  for (const char letter : word) quoted += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  return quoted + "'";
}

std::string RunOptions::repeated() const {
  std::string text = shell_word(scene);
  for (const std::string& change : overrides) text += " --set " + shell_word(change);
  if (steps.has_value()) text += " --steps " + std::to_string(*steps);
  if (quiet) text += " --quiet";
  return out.empty() ? text : text + " --out " + shell_word(out);
}

void add_run_options(CLI::App& command, RunOptions& options) {
  add_text(command, "scene", options.scene, "scene to run (TOML)")->required();
  add_whole_number(command, "--steps", options.steps, 0, last_countable_step,
                   "run until this step, counted from the very start of the scene");
  add_text(command, "--out", options.out, "output folder (default: out/<scene name>)");
  CLI::Option* const resume = add_text(command, "--resume", options.resume,
                                       "go on from a checkpoint, or from the newest sound one of a folder");
  command
      .add_flag("--overwrite", options.overwrite,
                "remove what an earlier run left in the output folder (default: a folder that holds a run is refused)")
      ->excludes(resume);
  command.add_option("--set", options.overrides, "override a key of the scene: KEY=VALUE; may be repeated")
      ->allow_extra_args(false);
  command
      .add_option_function<std::string>(
          "--trace", [&options](const std::string& text) { options.trace = read_trace(text); },
          "write to trace.csv what each partner gives to one PP in one step: ID@STEP")
      ->type_name("ID@STEP");
  command.add_flag("--quiet", options.quiet, "print nothing but warnings, errors and the last line");
}

}  // namespace mappm
