#include "app/options.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <string_view>

namespace mappm {

const CLI::Validator not_negative(
    [](std::string& text) { return text.starts_with('-') ? "must not be negative" : std::string(); }, "");

namespace {

/// Throws CLI::ValidationError.
TraceRequest read_trace(const std::string& text) {
  TraceRequest request;
  const auto number = [](const char* first, const char* last, std::uint64_t& value) {
    const auto [end, failed] = std::from_chars(first, last, value);
    return failed == std::errc{} && end == last;
  };
  const std::size_t at = text.find('@');
  const char *first = text.data(), *last = text.data() + text.size();
  if (at == std::string::npos || !number(first, first + at, request.particle) ||
      !number(first + at + 1, last, request.step))
    throw CLI::ValidationError("--trace", text + ": expected ID@STEP, the id of a PP and a step, as in 1042@36");
  return request;
}

}  // namespace

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
  command.add_option("scene", options.scene, "scene to run (TOML)")->required();
  command.add_option("--steps", options.steps, "run until this step, counted from the very start of the scene")
      ->check(not_negative);
  command.add_option("--out", options.out, "output folder (default: out/<scene name>)");
  command.add_option("--resume", options.resume, "go on from a checkpoint, or from the newest sound one of a folder");
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
