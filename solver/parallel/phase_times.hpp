// Where the time of a step goes.
#pragma once

#include "base/stopwatch.hpp"
#include "particles/engine.hpp"

namespace mappm {

/// Of a step: messages of PPs; where it is found anew, their order by cells, and the lists of their pairs;
/// densities, and forces, of pairs of PPs; both of PPs and FPs; FPs, contacts and motion of solids; copies of solids
/// and reports on them, their messages included; motion of PPs.
enum class Phase { exchange, sort, lists, densities, pairs, frozen_pairs, solids, copies, integrate };

class PhaseTimes {
 public:
  void start() { watch_.start(); }
  /// Adds the seconds since `start`, or since the last call, to a phase.
  void end(Phase phase) { seconds_[static_cast<int>(phase)] += watch_.lap(); }
  PhaseSeconds seconds() const {
    constexpr const char* names[] = {"exchange",     "sort",   "lists",  "densities", "pairs",
                                     "frozen_pairs", "solids", "copies", "integrate"};
    PhaseSeconds named;
    for (const char* name : names) named.emplace_back(name, seconds_[named.size()]);
    return named;
  }

 private:
  double seconds_[9] = {};
  Stopwatch watch_;
};

}  // namespace mappm
