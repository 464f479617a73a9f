// Moments at which the processes of a run agree whether to go on: one small reduction every few steps.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "app/signals.hpp"
#include "base/error.hpp"
#include "base/group.hpp"
#include "particles/overlap.hpp"

namespace mappm {

class Poll {
 public:
  /// warn(text) is called on all processes for what is doubtful; may be empty.
  Poll(const Group& group, std::uint64_t step, std::function<void(const std::string&)> warn = {})
      : group_(group), next_(step), warn_(std::move(warn)) {}

  /// To be called after every step with what the engine of this process says; the first error is kept.
  void note(std::uint64_t step, const std::string& range_error) {
    if (range_error.empty() || !range_error_.empty()) return;
    range_error_ = range_error;
    error_step_ = static_cast<double>(step);
  }

  void note(const FirstOverlaps& overlaps) { overlaps_ = overlaps; }

  bool due(std::uint64_t step) const { return step >= next_; }

  /// Collective. Whether a signal to stop reached any process. Throws RangeError, on all processes with the text of
  /// the one whose value left its range first (of several, the lowest rank).
  bool agree_to_stop(std::uint64_t step, double seconds_per_step) {
    const double wished = seconds_per_step > 0.0 ? longest_wait / seconds_per_step : 1.0;
    std::array<double, 5> lowest{error_step_, stop_requested() ? 0.0 : 1.0, std::clamp(wished, 1.0, most_steps),
                                 warned_ ? never : overlaps_.doubtful.step, overlaps_.last.step};
    group_.minimum(lowest);
    if (lowest[3] != never) {
      warned_ = true;
      const std::string text = text_of_first(overlaps_.doubtful);
      if (warn_) warn_(text);
    }
    if (lowest[4] != never && lowest[4] <= lowest[0]) throw RangeError(text_of_first(overlaps_.last));
    if (lowest[0] != never) throw_first(lowest[0]);
    next_ = step + static_cast<std::uint64_t>(lowest[2]);
    return lowest[1] == 0.0;
  }

 private:
  static constexpr double never = std::numeric_limits<double>::infinity();
  static constexpr double longest_wait = 0.5;  // s: a signal is seen within about this time
  static constexpr double most_steps = 20.0;

  /// The text of the process that saw the deepest overlap in the earliest step: the same however solids are shared out.
  std::string text_of_first(const FirstOverlap& mine) const {
    const std::vector<double> all =
        group_.gather({mine.step, mine.overlap.depth, static_cast<double>(mine.overlap.solid), mine.overlap.partner});
    const auto key = [&](std::size_t k) { return std::tuple(all[k], -all[k + 1], all[k + 2], all[k + 3]); };
    std::size_t first = 0;
    for (std::size_t k = 4; k < all.size(); k += 4)
      if (key(k) < key(first)) first = k;
    std::array<double, 1> rank{static_cast<double>(first / 4)};  // 0 where nothing was gathered
    group_.maximum(rank);
    return group_.broadcast(mine.text, static_cast<int>(rank[0]));
  }

  [[noreturn]] void throw_first(double step) const {
    std::array<double, 1> rank{static_cast<double>(error_step_ == step ? group_.rank() : group_.size())};
    group_.minimum(rank);
    throw RangeError(group_.broadcast(range_error_, static_cast<int>(rank[0])));
  }

  const Group& group_;
  std::uint64_t next_;
  std::function<void(const std::string&)> warn_;
  std::string range_error_;
  double error_step_ = never;
  FirstOverlaps overlaps_;
  bool warned_ = false;
};

}  // namespace mappm
