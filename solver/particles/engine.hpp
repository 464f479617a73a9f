// What an engine offers to the run loop. The serial and the parallel engine both model this concept.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "particles/density_field.hpp"
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

template <class E, int D>
concept Engine = requires(E engine, const E constant) {
  /// Advances the state by one step. Never throws on a value out of range: it is recorded in first_fault().
  engine.step();
  /// Steps made since the start of the scene. Costs nothing.
  { constant.present_step() } -> std::same_as<std::uint64_t>;
  /// What this process owns, valid between steps. May cost some steps' saving: not to be called in each. Bookkeeping of
  /// the series (sampled_impulse) may be changed.
  { engine.state() } -> std::same_as<State<D>&>;
  /// Collective. The same, with the densities at its positions. The state is valid until the next step.
  { engine.sample() } -> std::same_as<Sample<D>>;
  /// The first value that left its range on this process, if any did.
  { constant.first_fault() } -> std::same_as<const FirstFault&>;
  /// Contacts of this process' solids that were deep, for the first time.
  { constant.overlaps() } -> std::same_as<const FirstOverlaps&>;
  { constant.phase_seconds() } -> std::convertible_to<PhaseSeconds>;
  /// Asks for the trace of one PP in the next step; after it the owner of the PP has the trace, for one step.
  engine.trace_next_step(std::uint64_t{});
  { constant.last_trace() } -> std::same_as<const MaybeTrace<D>&>;
};

}  // namespace mappm
