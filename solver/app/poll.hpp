// Moments at which the processes of a run agree whether to go on: one small reduction every few steps.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "app/signals.hpp"
#include "base/error.hpp"
#include "base/group.hpp"
#include "particles/first_fault.hpp"
#include "particles/overlap.hpp"

namespace mappm {

class Poll {
 public:
  /// warn(text) is called on all processes for what is doubtful; may be empty.
  Poll(const Group& group, std::uint64_t step, std::function<void(const std::string&)> warn = {})
      : group_(group), next_(step), warn_(std::move(warn)) {}

  /// To be called after every step with what the engine of this process says.
  void note(const FirstOverlaps& overlaps) { overlaps_ = overlaps; }

  bool due(std::uint64_t step) const { return step >= next_; }

  /// Collective. Whether a signal to stop reached any process. `fault`: what left its range on this process. Throws
  /// RangeError, on all processes with the text of the first fault of all.
  bool agree_to_stop(std::uint64_t step, double seconds_per_step, const FirstFault& fault) {
    const double wished = seconds_per_step > 0.0 ? longest_wait / seconds_per_step : 1.0;
    const double fault_step = fault.any() ? static_cast<double>(fault.origin().step) : never;
    std::array<double, 5> lowest{fault_step, stop_requested() ? 0.0 : 1.0, std::clamp(wished, 1.0, most_steps),
                                 warned_ ? never : overlaps_.doubtful.step, overlaps_.last.step};
    group_.minimum(lowest);
    if (lowest[3] != never) {
      warned_ = true;
      const std::string text = text_of_first(overlaps_.doubtful);
      if (warn_) warn_(text);
    }
    if (lowest[4] != never && lowest[4] <= lowest[0]) throw RangeError(text_of_first(overlaps_.last));
    if (lowest[0] != never) throw RangeError(text_of_first(fault));
    next_ = step + static_cast<std::uint64_t>(lowest[2]);
    return lowest[1] == 0.0;
  }

 private:
  static constexpr double never = std::numeric_limits<double>::infinity();
  static constexpr double longest_wait = 0.5;  // s: a signal is seen within about this time
  static constexpr double most_steps = 20.0;

  /// The deepest overlap of the earliest step.
  std::string text_of_first(const FirstOverlap& mine) const {
    const Overlap& overlap = mine.overlap;
    return text_of_first({mine.step, -overlap.depth, static_cast<double>(overlap.solid), overlap.partner}, mine.text);
  }

  std::string text_of_first(const FirstFault& mine) const {
    std::array<double, 4> key{never, never, never, never};
    const std::array<std::uint64_t, 4> origin = mine.origin().key();
    if (mine.any()) std::copy(origin.begin(), origin.end(), key.begin());
    return text_of_first(key, mine.text());
  }

  /// The text of the process whose key is the lowest, entry by entry: the same however particles are shared out.
  std::string text_of_first(const std::array<double, 4>& key, const std::string& text) const {
    bool may_be_first = true;
    const auto lowest = [&](double mine) {
      std::array<double, 1> value{may_be_first ? mine : never};
      group_.minimum(value);
      may_be_first = may_be_first && mine == value[0];
      return value[0];
    };
    for (const double entry : key) lowest(entry);
    return group_.broadcast(text, static_cast<int>(lowest(group_.rank())));
  }

  const Group& group_;
  std::uint64_t next_;
  std::function<void(const std::string&)> warn_;
  FirstOverlaps overlaps_;
  bool warned_ = false;
};

}  // namespace mappm
