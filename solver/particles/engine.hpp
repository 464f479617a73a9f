// What an engine offers to the run loop. The serial and the parallel engine both derive from it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "particles/density_field.hpp"
#include "particles/face_impulse.hpp"
#include "particles/first_fault.hpp"
#include "particles/overlap.hpp"
#include "particles/pair_trace.hpp"
#include "particles/state.hpp"

namespace mappm {

/// Wall seconds spent so far, by phase of the step ("pairs", "integrate", ...; parallel/phase_times.hpp).
using PhaseSeconds = std::vector<std::pair<std::string, double>>;

/// What one process sent to others so far.
struct Traffic {
  std::uint64_t messages = 0, bytes = 0;
  int neighbours = 0;  // processes that it exchanges with, itself left out
};

/// How the work is shared over domains.
template <int D>
struct DomainReport {
  Traffic traffic;
  std::uint64_t orderings = 0;              // steps so far in which the PPs of this process were put in order anew
  std::array<std::vector<double>, D> cuts;  // borders of the domains, per axis, quanta
};

/// Advances the share of a scene that one process owns.
template <int D>
class Engine {
 public:
  virtual ~Engine() = default;

  /// Advances the state by one step. Never throws on a value out of range: it is recorded in first_fault().
  virtual void step() = 0;
  /// Steps made since the start of the scene. Costs nothing.
  virtual std::uint64_t present_step() const = 0;
  /// What this process owns, valid between steps. May cost some steps' saving: not to be called in each. Bookkeeping of
  /// the series (sampled_impulse) may be changed.
  virtual State<D>& state() = 0;
  /// Collective. The same, with the densities at its positions. The state is valid until the next step.
  virtual Sample<D> sample() = 0;
  /// The first value that left its range on this process, if any did.
  virtual const FirstFault& first_fault() const = 0;
  /// Contacts of this process' solids that were deep, for the first time.
  virtual const FirstOverlaps& overlaps() const = 0;
  virtual PhaseSeconds phase_seconds() const = 0;
  /// Asks for the trace of one PP in the next step; after it the owner of the PP has the trace, for one step.
  virtual void trace_next_step(std::uint64_t particle) = 0;
  virtual const MaybeTrace<D>& last_trace() const = 0;

  // What not every engine has:

  /// None from an engine without domains.
  virtual std::optional<DomainReport<D>> domain_report() const { return std::nullopt; }
  /// The ledger of the faces of this process' domain in the last step, in the order of partners, then the entry of all
  /// partners; empty where none was due, and from an engine without domains.
  virtual std::vector<FaceImpulse<D>> faces() const { return {}; }
};

}  // namespace mappm
