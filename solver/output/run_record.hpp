// run.json: what was run, with what, where and how fast. Written as a whole at the start and at the end of a run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/fixed_point.hpp"
#include "particles/model.hpp"
#include "physics/step_limit.hpp"

namespace mappm {

/// Names of the active terms, as printed at start.
std::vector<std::string> term_names(const Terms& terms);

struct RunRecord {
  std::string program, instruction_set;
  std::string scene_file, scene_name, scene_text, scene_identity;
  Terms terms;
  std::vector<std::string> warnings;
  std::uint64_t first_step = 0, step = 0;                    // of this program run: begun at, reached
  double time_step = 0.0;                                    // in scene units
  StepLimits limits;                                         // of it
  std::vector<std::pair<std::string, double>> wall_seconds;  // by phase
  double messages_per_step = 0.0, bytes_per_step = 0.0;      // sent by the process that sends most
  int neighbours = 0;                                        // most of a process
  std::uint64_t orderings = 0;  // steps in which the PPs of a process were put in order anew, most of a process
  std::string digest;           // of the state at `step`
  std::vector<Int128> start_momentum, end_momentum, outside_impulse;  // iota, an entry an axis
  double iota = 0.0;                                                  // in scene units
  int ranks = 1, threads = 1;
  std::vector<int> domains;
  std::vector<std::vector<double>> borders;  // of the domains at the end, per axis, from 0 to the side; scene units
  std::uint64_t particles = 0, frozen_particles = 0, solids = 0;  // PPs and FPs; FPs; SPs
  double rate = 0.0;                                              // particle-steps/s
  std::string state;    // running, finished, stopped, input error, range error
  std::string message;  // of the error, or how to resume
};

/// The record as JSON text; commit, compiler, flags, host and date are added.
std::string run_record_text(const RunRecord& record);

inline constexpr const char* run_record_name = "run.json";

/// The identity of the scene in a record; empty where the file is none.
std::string recorded_identity(const std::filesystem::path& path);

/// Writes it as a whole or not at all. Throws InputError.
void write_run_record(const std::filesystem::path& path, const RunRecord& record);

}  // namespace mappm
