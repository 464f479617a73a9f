// Moments at which the processes of a run agree whether to go on: one small reduction every few steps.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "app/signals.hpp"
#include "base/error.hpp"
#include "base/group.hpp"

namespace mappm {

class Poll {
 public:
  Poll(const Group& group, std::uint64_t step) : group_(group), next_(step) {}

  /// To be called after every step with what the engine of this process says; the first error is kept.
  void note(std::uint64_t step, const std::string& range_error) {
    if (range_error.empty() || !range_error_.empty()) return;
    range_error_ = range_error;
    error_step_ = static_cast<double>(step);
  }

  bool due(std::uint64_t step) const { return step >= next_; }

  /// Collective. Whether a signal to stop reached any process. Throws RangeError, on all processes with the text of
  /// the one whose value left its range first (of several, the lowest rank).
  bool agree_to_stop(std::uint64_t step, double seconds_per_step) {
    const double wished = seconds_per_step > 0.0 ? longest_wait / seconds_per_step : 1.0;
    std::array<double, 3> lowest{error_step_, stop_requested() ? 0.0 : 1.0, std::clamp(wished, 1.0, most_steps)};
    group_.minimum(lowest);
    if (lowest[0] != never) throw_first(lowest[0]);
    next_ = step + static_cast<std::uint64_t>(lowest[2]);
    return lowest[1] == 0.0;
  }

 private:
  static constexpr double never = std::numeric_limits<double>::infinity();
  static constexpr double longest_wait = 0.5;  // s: a signal is seen within about this time
  static constexpr double most_steps = 20.0;

  [[noreturn]] void throw_first(double step) const {
    std::array<double, 1> rank{static_cast<double>(error_step_ == step ? group_.rank() : group_.size())};
    group_.minimum(rank);
    throw RangeError(group_.broadcast(range_error_, static_cast<int>(rank[0])));
  }

  const Group& group_;
  std::uint64_t next_;
  std::string range_error_;
  double error_step_ = never;
};

}  // namespace mappm
