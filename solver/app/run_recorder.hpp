// Keeps run.json: what the run is, at its start, and how far and how fast it came.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "app/run_setup.hpp"
#include "output/run_record.hpp"
#include "output/totals.hpp"
#include "particles/engine.hpp"

namespace mappm {

template <int D>
class RunRecorder {
 public:
  /// `first_step`: at which this run of the program begins.
  RunRecorder(const RunSetup<D>& setup, std::uint64_t first_step);

  void warn(const std::string& text) { record_.warnings.push_back(text); }
  /// Keeps what the totals of a sample say.
  void remember(const Totals<D>& totals, const Vec<D, Int128>& start_momentum);
  /// Collective. Writes the record: `state` is running, finished, stopped or an error; wall seconds are those of the
  /// slowest process. Throws InputError.
  void write(const std::string& state, const std::string& message, const Engine<D>& engine, double stepping_seconds,
             double output_seconds);

  const RunRecord& record() const { return record_; }

 private:
  void set_times(const Engine<D>& engine, double stepping_seconds, double output_seconds);
  void set_domains(const DomainReport<D>& report);

  const RunSetup<D>& setup_;
  std::filesystem::path path_;
  RunRecord record_;
};

}  // namespace mappm
