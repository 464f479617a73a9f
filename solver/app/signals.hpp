// SIGTERM and SIGINT ask a run to write a checkpoint and to end.
#pragma once

#include <csignal>

namespace mappm {

inline volatile std::sig_atomic_t stop_signal = 0;

extern "C" inline void note_stop_signal(int number) { stop_signal = number; }

/// From now on the two signals only raise the flag. Before, while a run is set up, they end the program: nothing has
/// been written that could be lost.
inline void watch_stop_signals() {
  struct sigaction action {};
  action.sa_handler = note_stop_signal;
  action.sa_flags = SA_RESTART;  // a write in progress goes on
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
}

inline bool stop_requested() { return stop_signal != 0; }

}  // namespace mappm
