// Moments at which the processes of a run agree whether to go on: one small reduction every few steps.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "app/signals.hpp"
#include "base/error.hpp"
#include "base/group.hpp"
#include "particles/first_fault.hpp"

namespace mappm {

class Poll {
 public:
  Poll(const Group& group, std::uint64_t step) : group_(group), next_(step) {}

  bool due(std::uint64_t step) const { return step >= next_; }

  /// Collective. Whether a signal to stop reached any process. `fault`: what left its range on this process. Throws
  /// RangeError, on all processes with the text of the first fault of all.
  bool agree_to_stop(std::uint64_t step, double seconds_per_step, const FirstFault& fault) {
    const double wished = seconds_per_step > 0.0 ? longest_wait / seconds_per_step : 1.0;
    std::array<double, 3> lowest{fault.any() ? 0.0 : 1.0, stop_requested() ? 0.0 : 1.0,
                                 std::clamp(wished, 1.0, most_steps)};
    group_.minimum(lowest);
    if (lowest[0] == 0.0) throw_first(fault);
    next_ = step + static_cast<std::uint64_t>(lowest[2]);
    return lowest[1] == 0.0;
  }

 private:
  static constexpr double longest_wait = 0.5;  // s: a signal is seen within about this time
  static constexpr double most_steps = 20.0;

  [[noreturn]] void throw_first(const FirstFault& fault) const {
    bool may_be_first = fault.any();
    const auto lowest = [&](double mine) {
      std::array<double, 1> value{may_be_first ? mine : std::numeric_limits<double>::infinity()};
      group_.minimum(value);
      may_be_first = may_be_first && mine == value[0];
      return value[0];
    };
    for (const std::uint64_t entry : fault.place().key()) lowest(static_cast<double>(entry));
    throw RangeError(group_.broadcast(fault.text(), static_cast<int>(lowest(group_.rank()))));
  }

  const Group& group_;
  std::uint64_t next_;
};

}  // namespace mappm
