#include "output/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace mappm {

namespace {

constexpr double bar_interval = 0.25;   // s
constexpr double line_interval = 60.0;  // s
constexpr int bar_width = 30;

std::string clock_text(double seconds) {
  const std::int64_t whole = std::llround(seconds);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace

ProgressStyle progress_style(bool quiet) {
  if (quiet) return ProgressStyle::silent;
  return ::isatty(STDERR_FILENO) == 1 ? ProgressStyle::bar : ProgressStyle::lines;
}

Progress::Progress(std::ostream& out, ProgressStyle style, std::uint64_t first_step, std::uint64_t last_step,
                   std::uint64_t particles)
    : out_(out),
      style_(style),
      first_step_(first_step),
      last_step_(last_step),
      particles_(particles),
      interval_(style == ProgressStyle::bar ? bar_interval : line_interval),
      next_(interval_) {}

std::string Progress::line(std::uint64_t step, double seconds) const {
  const double done = static_cast<double>(step - first_step_);
  const double left = static_cast<double>(last_step_ - step);
  return fmt::format("step {}/{}  {:.3g} particle-steps/s  remaining {}", step, last_step_,
                     done * static_cast<double>(particles_) / seconds, clock_text(left * seconds / done));
}

void Progress::update(std::uint64_t step, double seconds) {
  if (style_ == ProgressStyle::silent || seconds < next_ || step == first_step_) return;
  next_ = seconds + interval_;
  if (style_ == ProgressStyle::lines) {
    out_ << line(step, seconds) << std::endl;
    return;
  }
  const double fraction = static_cast<double>(step) / static_cast<double>(std::max<std::uint64_t>(last_step_, 1));
  const int filled = std::clamp(static_cast<int>(fraction * bar_width), 0, bar_width);
  out_ << fmt::format("\r[{:=<{}}>{: <{}}] {:3.0f} %  {}\033[K", "", filled, "", bar_width - filled, 100.0 * fraction,
                      line(step, seconds))
       << std::flush;
  bar_open_ = true;
}

void Progress::finish() {
  if (bar_open_) out_ << "\r\033[K" << std::flush;
  bar_open_ = false;
}

}  // namespace mappm
