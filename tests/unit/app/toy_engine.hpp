// An engine that can be followed by hand: every PP gains a kick along x in every step, and nothing else happens.
#pragma once

#include <csignal>
#include <optional>
#include <vector>

#include "particles/engine.hpp"
#include "particles/model.hpp"
#include "unit/output/small_disk.hpp"

namespace mappm::testing_tools {

inline constexpr double kick = 0.125;  // c

class ToyEngine final : public Engine<2> {
 public:
  explicit ToyEngine(State<2>&& state) : state_(std::move(state)) {}

  void step() override {
    for (double& v : state_.fluid.v(0)) v += kick;
    state_.outside_impulse[0] +=
        static_cast<Int128>(state_.fluid.size()) * static_cast<Int128>(kick / velocity_quantum);
    ++state_.step;
    if (state_.step == bad_step)
      fault_.note({bad_step - 1, FaultOrigin::What::fluid_motion, 1}, "step 7: particle 1: v = 99: too fast");
    if (state_.step == signal_step) std::raise(SIGTERM);
    if (state_.step == full_step) disk_.emplace(2500);  // enough for the series and the record, not for a snapshot
  }
  std::uint64_t present_step() const override { return state_.step; }
  State<2>& state() override { return state_; }
  Sample<2> sample() override { return {state_, {std::vector<double>(state_.fluid.size(), 8.0), {}}}; }
  const FirstFault& first_fault() const override { return fault_; }
  const FirstOverlaps& overlaps() const override { return overlaps_; }
  PhaseSeconds phase_seconds() const override { return {{"toy", 0.5}}; }
  void trace_next_step(std::uint64_t particle) override { trace_ = StepTrace<2>{state_.step, particle, {}}; }
  const MaybeTrace<2>& last_trace() const override { return trace_; }

  std::uint64_t bad_step = 0, signal_step = 0, full_step = 0;  // 0: never

 private:
  State<2> state_;
  FirstFault fault_;
  FirstOverlaps overlaps_;
  MaybeTrace<2> trace_;
  std::optional<SmallDisk> disk_;
};

}  // namespace mappm::testing_tools
