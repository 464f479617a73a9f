// How far a run is, for the person who waits: a bar on a terminal, a plain line a minute elsewhere.
#pragma once

#include <cstdint>
#include <ostream>
#include <string>

namespace mappm {

enum class ProgressStyle { bar, lines, silent };

/// The style that fits standard error.
ProgressStyle progress_style(bool quiet);

class Progress {
 public:
  Progress(std::ostream& out, ProgressStyle style, std::uint64_t first_step, std::uint64_t last_step,
           std::uint64_t particles);

  /// `seconds`: wall time since the first step. Prints only where it is time to.
  void update(std::uint64_t step, double seconds);
  /// Leaves the line of the bar, so that other text may follow.
  void finish();

 private:
  std::string line(std::uint64_t step, double seconds) const;

  std::ostream& out_;
  ProgressStyle style_;
  std::uint64_t first_step_, last_step_, particles_;
  double interval_, next_;  // s
  bool bar_open_ = false;
};

}  // namespace mappm
