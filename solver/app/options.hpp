// The command line, as both programs understand it.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace mappm {

/// --trace ID@STEP: what each partner gives to PP `particle` in the step from `step` to `step + 1`.
struct TraceRequest {
  std::uint64_t particle = 0, step = 0;
};

struct RunOptions {
  std::string scene;                   // path of the scene
  std::vector<std::string> overrides;  // KEY=VALUE
  std::optional<std::uint64_t> steps;  // total number of steps, relaxation included; by default what the scene says
  std::string out;                     // output folder; by default out/<scene name>
  std::string resume;                  // checkpoint, or folder; empty: from the start
  bool overwrite = false;              // what an earlier run left in the folder
  bool quiet = false;
  std::optional<TraceRequest> trace;

  /// What a resumed run must be given again, to be pasted into a shell.
  std::string repeated() const;

  std::filesystem::path output_folder(const std::string& scene_name) const {
    return out.empty() ? std::filesystem::path("out") / scene_name : std::filesystem::path(out);
  }
};

/// A word as a shell reads it back: in quotes where it needs them.
std::string shell_word(const std::string& word);

/// Adds an option whose value is a text, and never an empty one: a variable of the shell that is not set is no value.
CLI::Option* add_text(CLI::App& command, const std::string& name, std::string& to, const std::string& description);

/// A whole number of at least `lowest` and at most `highest`, in decimal digits and nothing else. Throws InputError.
std::uint64_t whole_number(const std::string& option, const std::string& text, std::uint64_t lowest,
                           std::uint64_t highest);

/// Adds an option whose value is such a number; `to` may be an optional.
template <class Number>
CLI::Option* add_whole_number(CLI::App& command, const std::string& name, Number& to, std::uint64_t lowest,
                              std::uint64_t highest, const std::string& description) {
  const auto take = [=, &to](const std::string& text) {
    const std::uint64_t number = whole_number(name, text, lowest, highest);
    if constexpr (std::is_integral_v<Number>)
      to = static_cast<Number>(number);
    else
      to = number;
  };
  return command.add_option_function<std::string>(name, take, description)->type_name("N");
}

/// Adds the options above to the command `run`.
void add_run_options(CLI::App& command, RunOptions& options);

}  // namespace mappm
