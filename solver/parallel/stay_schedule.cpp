#include "parallel/stay_schedule.hpp"

#include <algorithm>

namespace mappm {

void StaySchedule::begin(StayLength length) {
  staying_ = true;
  length_ = length;
  steps_ = 1;
  travelled_ = farthest_ = 0.0;
  end_ = never;
  ending_ = false;
}

void StaySchedule::end() {
  staying_ = false;
  short_stays_ = steps_ < worthwhile ? short_stays_ + 1 : 0;
}

std::uint64_t StaySchedule::plan(std::uint64_t step) {
  // Those who make lists in every step would have all do so.
  if (!staying_ || length_ == StayLength::single_step) return never;
  constexpr double doubt = 0.1;  // steps by which the others should not be surprised
  const double left = (allowance - used()) * steps_ / used();
  if (left < 0.0)
    end_ = step;
  else if (2.0 * used() > allowance)
    end_ = std::min(end_, step + 1 + static_cast<std::uint64_t>(std::max(0.0, left - doubt)));
  ending_ = end_ <= step;
  return end_;
}

void StaySchedule::adopt_plan(std::uint64_t step, std::uint64_t plan) {
  if (!lasts() || plan >= end_) return;
  const double steps = steps_ + static_cast<double>(plan - step);  // of the stay by then
  if (steps < worthwhile || 2.0 * used() * steps < allowance * steps_) return;
  end_ = plan;
  ending_ = end_ <= step;
}

}  // namespace mappm
