// The command line, as both programs understand it.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
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

/// Numbers without sign read "-5" as a very large one; this refuses it.
extern const CLI::Validator not_negative;

/// Adds the options above to the command `run`.
void add_run_options(CLI::App& command, RunOptions& options);

}  // namespace mappm
