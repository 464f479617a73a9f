// What the two mains share: parse the command line, run, report an error once, return the exit code.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>

#include "app/instruction_set.hpp"
#include "app/options.hpp"
#include "base/error.hpp"
#include "base/group.hpp"
#include "base/numerics_version.hpp"
#include "build_info.hpp"

namespace mappm {

inline constexpr int exit_defect = 1;

/// Reports an error that all processes know of, by the first of them.
inline int report_once(const Group& group, const std::string& message, int code) {
  if (group.is_first()) fmt::print(stderr, "error: {}\n", message);
  return code;
}

/// add_options(command) adds what only this program understands; run(options) runs.
template <class AddOptions, class Run>
int run_command(int argc, char** argv, const Group& group, const std::string& program, AddOptions&& add_options,
                Run&& run) {
  CLI::App app("Macro-scale pseudo-particle modelling of particle-fluid systems", program);
  app.set_version_flag("--version", fmt::format("{} {} ({}), numerics {}, {}", program, build_info::version,
                                                build_info::commit, numerics_version, instruction_set));
  app.require_subcommand(1);
  CLI::App& command = *app.add_subcommand("run", "run a scene");
  RunOptions options;
  add_run_options(command, options);
  add_options(command);
  try {
    app.parse(argc, argv);
    run(options);
    return EXIT_SUCCESS;
  } catch (const CLI::ParseError& error) {
    const bool asked_for_help = error.get_exit_code() == 0;
    if (group.is_first()) app.exit(error, std::cout, std::cerr);
    return asked_for_help ? EXIT_SUCCESS : exit_input_error;
  } catch (const InputError& error) {
    return report_once(group, error.what(), exit_input_error);
  } catch (const RangeError& error) {
    return report_once(group, error.what(), exit_range_error);
  } catch (const AgreedError& error) {
    return report_once(group, std::string("defect: ") + error.what(), exit_defect);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: defect on process {}: {}\n", group.rank(), error.what());
    std::fflush(nullptr);
    // The others may be waiting for this process: leaving without a farewell makes the launcher end them all.
    if (group.size() > 1) std::_Exit(exit_defect);
    return exit_defect;
  }
}

}  // namespace mappm
