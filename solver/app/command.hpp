// What the two mains share: parse the command line, run, report an error once, return the exit code.
#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <new>
#include <string>

#include "app/instruction_set.hpp"
#include "app/options.hpp"
#include "base/error.hpp"
#include "base/group.hpp"
#include "base/numerics_version.hpp"
#include "build_info.hpp"
#include "output/together.hpp"

namespace mappm {

inline constexpr int exit_defect = 1;

/// Reports an error that all processes know of, by the first of them.
inline int report_once(const Group& group, const std::string& message, int code) {
  if (group.is_first()) fmt::print(stderr, "error: {}\n", message);
  return code;
}

/// Reports an error that no other process knows of. The others may be waiting for this one: leaving without a farewell
/// makes the launcher end them all.
inline int report_alone(const Group& group, const std::string& message, int code) {
  fmt::print(stderr, "error: {}\n", message);
  std::fflush(nullptr);
  if (group.size() > 1) std::_Exit(code);
  return code;
}

/// A standard stream that was closed would lend its number to the next file that is opened, and its text to that file.
inline void open_standard_streams() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(number, F_GETFD) < 0) ::open("/dev/null", O_RDWR);  // takes the lowest number that is free
}

/// Throws InputError where something that was printed did not reach standard output.
inline void check_standard_output() {
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout) return;
  throw InputError("standard output: cannot be written; free space, or send it elsewhere");
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
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      if (group.is_first()) app.exit(error, std::cout, std::cerr);
      if (error.get_exit_code() != 0) return exit_input_error;
      on_first(group, check_standard_output);  // help was asked for
      return EXIT_SUCCESS;
    }
    run(options);
    on_first(group, check_standard_output);
    return EXIT_SUCCESS;
  } catch (const InputError& error) {
    return report_once(group, error.what(), exit_input_error);
  } catch (const RangeError& error) {
    return report_once(group, error.what(), exit_range_error);
  } catch (const AgreedError& error) {
    return report_once(group, std::string("defect: ") + error.what(), exit_defect);
  } catch (const std::bad_alloc&) {
    return report_alone(group, memory_ran_out, exit_input_error);
  } catch (const std::exception& error) {
    return report_alone(group, fmt::format("defect on process {}: {}", group.rank(), error.what()), exit_defect);
  }
}

}  // namespace mappm
