// Time and medians of benchmarks.
#pragma once

#include <algorithm>
#include <ctime>
#include <vector>

namespace mappm::bench {

/// Seconds that this thread has computed: what else the machine does is left out.
inline double computing_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace mappm::bench
