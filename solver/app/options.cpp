#include "app/options.hpp"

namespace mappm {

const CLI::Validator not_negative(
    [](std::string& text) { return text.starts_with('-') ? "must not be negative" : std::string(); }, "");

void add_run_options(CLI::App& command, RunOptions& options) {
  command.add_option("scene", options.scene, "scene to run (TOML)")->required();
  command.add_option("--steps", options.steps, "run until this step, counted from the very start of the scene")
      ->check(not_negative);
  command.add_option("--out", options.out, "output folder (default: out/<scene name>)");
  command.add_option("--resume", options.resume, "go on from a checkpoint, or from the newest sound one of a folder");
  command.add_option("--set", options.overrides, "override a key of the scene: KEY=VALUE; may be repeated")
      ->allow_extra_args(false);
  command.add_flag("--quiet", options.quiet, "print nothing but warnings, errors and the last line");
}

}  // namespace mappm
