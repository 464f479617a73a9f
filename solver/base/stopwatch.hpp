// Wall time.
#pragma once

#include <chrono>

namespace mappm {

/// Measures laps, in seconds; the first begins when it is made.
class Stopwatch {
 public:
  void start() { begin_ = std::chrono::steady_clock::now(); }
  /// Seconds since the lap began. The next one begins.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - begin_).count();
    begin_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Seconds that work() takes.
template <class Work>
double seconds_of(Work&& work) {
  Stopwatch watch;
  work();
  return watch.lap();
}

}  // namespace mappm
