// A word to the person who waits while a run is set up: most scenes take no time, some take long.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>

#include "app/options.hpp"
#include "base/group.hpp"

namespace mappm {

/// From its construction to `end` or its destruction it says every few seconds what is being done.
class SetupNotice {
 public:
  SetupNotice(const Group& group, const RunOptions& options) {
    if (group.is_first() && !options.quiet) speaker_ = std::jthread([this] { speak(); });
  }
  ~SetupNotice() { end(); }
  SetupNotice(const SetupNotice&) = delete;
  SetupNotice& operator=(const SetupNotice&) = delete;

  void doing(const char* what) {
    const std::lock_guard lock(mutex_);
    what_ = what;
  }
  void end() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
    if (speaker_.joinable()) speaker_.join();
  }

 private:
  static constexpr std::chrono::seconds interval{5};

  void speak() {
    std::unique_lock lock(mutex_);
    for (auto waited = interval; !changed_.wait_for(lock, interval, [this] { return ended_; }); waited += interval)
      fmt::print(stderr, "setting up: {} ({} s)\n", what_, waited.count());
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  const char* what_ = "reading the scene";
  bool ended_ = false;
  std::jthread speaker_;
};

}  // namespace mappm
