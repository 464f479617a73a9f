// Signals that ask a run to write a checkpoint and to end: of a person (SIGINT), of a system that goes down (SIGTERM),
// of a terminal that is gone (SIGHUP), of a batch system whose time is up (SIGUSR1, SIGUSR2, SIGXCPU).
#pragma once

#include <csignal>

namespace mappm {

inline volatile std::sig_atomic_t stop_signal = 0;

extern "C" inline void note_stop_signal(int number) { stop_signal = number; }

/// From now on these signals only raise the flag. Before, while a run is set up, they end the program: nothing has been
/// written that could be lost. A hangup that is ignored stays so: that is what nohup asks for.
inline void watch_stop_signals() {
  struct sigaction action {};
  action.sa_handler = note_stop_signal;
  action.sa_flags = SA_RESTART;  // a write in progress goes on
  for (const int number : {SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU}) {
    struct sigaction before {};
    sigaction(number, nullptr, &before);
    if (number == SIGHUP && before.sa_handler == SIG_IGN) continue;
    sigaction(number, &action, nullptr);
  }
}

/// A write that a limit or a reader that is gone cuts short does not end the program, but fails.
inline void make_write_signals_errors() {
  for (const int number : {SIGXFSZ, SIGPIPE}) std::signal(number, SIG_IGN);
}

inline bool stop_requested() { return stop_signal != 0; }

}  // namespace mappm
