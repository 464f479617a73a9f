// The run itself, the same for both engines: steps, and between them samples, snapshots, checkpoints and signals.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "app/instruction_set.hpp"
#include "app/options.hpp"
#include "app/poll.hpp"
#include "app/signals.hpp"
#include "app/start.hpp"
#include "base/stopwatch.hpp"
#include "output/checkpoint_folder.hpp"
#include "output/durable_file.hpp"
#include "output/face_series.hpp"
#include "output/fastest.hpp"
#include "output/output_trial.hpp"
#include "output/progress.hpp"
#include "output/run_record.hpp"
#include "output/series.hpp"
#include "output/snapshot.hpp"
#include "output/solid_series.hpp"
#include "output/trace_file.hpp"
#include "particles/engine.hpp"

namespace mappm {

/// What a run needs beside its engine. `start.state` has gone to the engine.
template <int D>
struct RunSetup {
  const Scene& scene;
  const Model<D>& model;
  const Group& group;
  const RunOptions& options;
  const Start<D>& start;
  const StepLimits& limits;  // of the step, in scene units
  std::string program;
  std::vector<std::string> warnings;
  std::string memory = {};           // that is needed, as text
  std::string program_options = {};  // those that only this program has, as given: " --threads 2"
  std::vector<int> domains = {};     // an entry an axis; empty for the reference
  int threads = 1;
  bool faces = false;  // write faces.csv; for engines that keep a ledger of faces
};

template <int D, class E>
requires Engine<E, D>
class RunLoop {
 public:
  RunLoop(const RunSetup<D>& setup, E& engine)
      : setup_(setup),
        engine_(engine),
        folder_(setup.start.folder.path()),
        first_step_(engine.state().step),
        last_step_(std::max(first_step_, last_step(setup.scene, setup.model, setup.options))),
        sampled_step_(setup.start.sampled_step),
        poll_(setup.group, first_step_, [this](const std::string& text) { warn(text); }) {}

  /// Collective. Runs to the end or to a signal; both leave the output complete and print the last line. Throws
  /// InputError where output cannot be written and RangeError; run.json then says so.
  void run() {
    watch_stop_signals();
    begin();
    std::string state = "finished", message;
    try {
      if (!advance()) {
        state = "stopped";
        const int ranks = setup_.group.size();
        message =
            fmt::format("resume with: {}{} run {}{} --resume {}", ranks > 1 ? fmt::format("mpirun -np {} ", ranks) : "",
                        setup_.program, setup_.options.repeated(), setup_.program_options, shell_word(saved_.string()));
      }
      if (sampled_step_ != step()) sample(engine_.sample());  // the last row
      write_record(state, message);
    } catch (const InputError& error) {
      write_record_of_failure("input error", error.what());
      throw;
    } catch (const RangeError& error) {
      write_record_of_failure("range error", error.what());
      throw;
    }
    say_on_first([&] { say_end(message); });
  }

 private:
  std::uint64_t step() const { return engine_.present_step(); }
  bool falls_on(std::uint64_t interval) const { return interval != 0 && step() % interval == 0; }

  template <class Say>
  void say_on_first(Say&& say) {
    if (setup_.group.is_first()) say();
  }

  void begin();
  void check_trace() const;
  void try_last_files();
  void make_step();
  bool advance();
  bool outputs_due() const;
  void write_outputs();
  void sample(const Sample<D>& now);
  void check_mach(const Totals<D>& totals, const FluidParticles<D>& fluid);
  void warn(const std::string& text);
  std::string step_text() const;
  void save();
  void remember(const Totals<D>& totals);
  void write_record(const std::string& state, const std::string& message);
  void write_record_of_failure(const std::string& state, const std::string& message);
  std::vector<std::vector<double>> borders_in_scene_units() const;
  void say_end(const std::string& message);

  const RunSetup<D>& setup_;
  E& engine_;
  std::filesystem::path folder_;
  std::uint64_t first_step_, last_step_, sampled_step_;
  Poll poll_;
  std::optional<Series<D>> series_;
  std::optional<SolidSeries<D>> solid_series_;
  std::optional<FaceSeries<D>> face_series_;
  std::optional<Progress> progress_;
  RunRecord record_;
  double stepping_seconds_ = 0.0, output_seconds_ = 0.0;
  std::filesystem::path saved_;  // the last checkpoint of this run
  std::uint64_t saved_step_ = 0;
  bool too_fast_ = false;  // and warned about it
};

template <int D, class E>
requires Engine<E, D>
void RunLoop<D, E>::begin() {
  const auto& [scene, model, group, options, start, limits, program, warnings, memory, program_options, domains,
               threads, faces] = setup_;
  check_trace();
  remember(measure(model, engine_.sample(), group));
  try_last_files();
  start.folder.open(scene.identity, group);  // from here on what was there before is replaced
  record_.program = program;
  record_.instruction_set = instruction_set;
  record_.scene_file = scene.file;
  record_.scene_name = scene.name;
  record_.scene_text = scene.text;
  record_.scene_identity = scene.identity;
  record_.terms = model.terms;
  record_.warnings = warnings;
  record_.first_step = first_step_;
  record_.time_step = model.dt * model.units.time();
  record_.limits = limits;
  record_.iota = velocity_quantum * model.units.mass * model.units.velocity;
  record_.ranks = group.size();
  record_.threads = threads;
  record_.domains = domains;

  const UnitNames units = scene.units == Units::si ? si_unit_names(D) : UnitNames{};
  // The last row of the run before may stand beyond its last sample: it is no row of the run that goes on.
  const auto kept = start.resumed_step.has_value() ? std::optional(start.sampled_step) : std::nullopt;
  series_.emplace(folder_, model, units, group, kept);
  if (scene.output.solids) solid_series_.emplace(folder_, model, units, group, kept);
  if (faces) face_series_.emplace(folder_, group, kept);
  write_record("running", "");
  say_on_first([&] {
    for (const std::string& warning : setup_.warnings) fmt::print(stderr, "warning: {}\n", warning);
    if (!setup_.options.quiet)
      fmt::print("{}: steps {} to {} {}, {} particles, about {} of memory, terms: {}; output in {}\n",
                 record_.scene_name, first_step_, last_step_, step_text(), record_.particles, setup_.memory,
                 fmt::join(term_names(record_.terms), ", "), folder_.string());
    std::fflush(stdout);
  });
  const ProgressStyle style = group.is_first() ? progress_style(options.quiet) : ProgressStyle::silent;
  progress_.emplace(std::cerr, style, first_step_, last_step_, record_.particles);
}

/// Steps to the end, with all output; false if a signal ended it before.
template <int D, class E>
requires Engine<E, D>
bool RunLoop<D, E>::advance() {
  if (!setup_.start.resumed_step.has_value()) write_outputs();
  while (step() < last_step_) {
    make_step();
    poll_.note(engine_.overlaps());
    if (!poll_.due(step()) && !outputs_due()) continue;
    const double steps_done = static_cast<double>(step() - first_step_);
    const bool stop = poll_.agree_to_stop(step(), stepping_seconds_ / steps_done, engine_.first_fault());
    write_outputs();
    progress_->update(step(), stepping_seconds_ + output_seconds_);
    if (stop && step() < last_step_) {
      if (saved_step_ != step()) save();
      return false;
    }
  }
  return true;
}

template <int D, class E>
requires Engine<E, D>
void RunLoop<D, E>::make_step() {
  const auto& trace = setup_.options.trace;
  const bool traced = trace.has_value() && trace->step == step();
  if (traced) engine_.trace_next_step(trace->particle);
  stepping_seconds_ += seconds_of([&] { engine_.step(); });
  if (traced) write_trace(folder_, engine_.last_trace(), setup_.model.terms.transport, trace->particle, setup_.group);
}

/// A trace of a step that the run does not make would be a file that never comes.
template <int D, class E>
requires Engine<E, D>
void RunLoop<D, E>::check_trace() const {
  const auto& trace = setup_.options.trace;
  if (!trace.has_value() || (trace->step >= first_step_ && trace->step < last_step_)) return;
  throw InputError("command line", "--trace", fmt::format("{}@{}", trace->particle, trace->step),
                   fmt::format("this run goes from step {} to {}; choose a step from {} to {}, or change --steps",
                               first_step_, last_step_, first_step_, std::max(first_step_ + 1, last_step_) - 1));
}

/// The snapshot and the checkpoint with which a run ends.
template <int D, class E>
requires Engine<E, D>
void RunLoop<D, E>::try_last_files() {
  const std::uint64_t fluid = record_.particles - record_.frozen_particles;
  const SnapshotPaths snapshot(folder_ / snapshot_folder_name, last_step_);
  const std::filesystem::path checkpoint = checkpoint_path(folder_ / checkpoint_folder_name, last_step_);
  try_output({{snapshot.solids, record_.particles * snapshot_point_bytes},
              {checkpoint, checkpoint_bytes<D>(fluid, record_.solids)}},
             setup_.group);
}

template <int D, class E>
requires Engine<E, D>
bool RunLoop<D, E>::outputs_due() const {
  const OutputScene& output = setup_.scene.output;
  return step() == last_step_ || falls_on(output.sample) || falls_on(output.snapshot) || falls_on(output.checkpoint);
}

template <int D, class E>
requires Engine<E, D>
void RunLoop<D, E>::write_outputs() {
  const OutputScene& output = setup_.scene.output;
  output_seconds_ += seconds_of([&] {
    const bool snapshot_due = falls_on(output.snapshot) || step() == last_step_;
    if (!snapshot_due && !falls_on(output.sample)) return;
    const Sample<D> now = engine_.sample();
    // The snapshot stands first: it shows forces since the sample before.
    if (snapshot_due) write_snapshot(folder_ / snapshot_folder_name, setup_.model, now, sampled_step_, setup_.group);
    if (falls_on(output.sample)) sample(now);
  });
  const bool checkpoint_due = falls_on(output.checkpoint) || (output.checkpoint != 0 && step() == last_step_);
  if (checkpoint_due && step() != first_step_) save();
}

template <int D, class E>
requires Engine<E, D>
void RunLoop<D, E>::sample(const Sample<D>& now) {
  State<D>& state = now.state;
  const Totals<D> totals = measure(setup_.model, now, setup_.group);
  series_->add(totals, state.start_momentum, sampled_step_);
  if (solid_series_.has_value()) solid_series_->add(state, sampled_step_);
  if constexpr (requires { engine_.faces(); })
    if (face_series_.has_value()) face_series_->add(state.step, engine_.faces());
  check_mach(totals, state.fluid);
  for (Solid<D>& solid : state.solids) solid.sampled_impulse = solid.fluid_impulse;
  sampled_step_ = state.step;
  remember(totals);
}

/// Length of a step, and what limits it.
template <int D, class E>
requires Engine<E, D> std::string RunLoop<D, E>::step_text()
const {
  const StepLimit ruling = setup_.limits.ruling(), last = setup_.limits.first(&StepLimit::last);
  if (!std::isfinite(ruling.usual)) return fmt::format("of {:.4g}", record_.time_step);
  return fmt::format("of {:.4g} ({} rules: {:.4g}; last stable: {:.4g})", record_.time_step, ruling.of, ruling.usual,
                     last.last);
}

/// Warns once of a fluid that has become fast beside its sound.
template <int D, class E>
requires Engine<E, D>
void RunLoop<D, E>::check_mach(const Totals<D>& totals, const FluidParticles<D>& fluid) {
  if (too_fast_ || totals.fluid_count == 0) return;
  Vec<D, double> mean;
  for (int axis = 0; axis < D; ++axis)
    mean[axis] =
        static_cast<double>(totals.fluid_momentum[axis]) * velocity_quantum / static_cast<double>(totals.fluid_count);
  const Fastest<D> fastest = find_fastest(fluid, mean, setup_.group);
  if (fastest.mach <= largest_local_mach) return;
  too_fast_ = true;
  const Model<D>& model = setup_.model;
  std::vector<double> position;
  for (int axis = 0; axis < D; ++axis)
    position.push_back(fastest.position[axis] * model.pair.length[axis] * model.units.length);
  warn(fmt::format(
      "step {}: local Mach number {:.3g} at ({:.6g}), beyond {}: the fluid is compressed there and may tear; a "
      "sound speed of {:.3g} would keep it at a tenth",
      step(), fastest.mach, fmt::join(position, ", "), largest_local_mach, 10.0 * fastest.mach * model.units.velocity));
}

template <int D, class E>
requires Engine<E, D>
void RunLoop<D, E>::warn(const std::string& text) {
  record_.warnings.push_back(text);
  say_on_first([&] { fmt::print(stderr, "warning: {}\n", text); });
}

template <int D, class E>
requires Engine<E, D>
void RunLoop<D, E>::save() {
  output_seconds_ += seconds_of([&] {
    saved_ = save_checkpoint(folder_ / checkpoint_folder_name, setup_.scene.identity, engine_.state(), sampled_step_,
                             setup_.group);
  });
  saved_step_ = step();
}

/// Keeps for run.json what the totals say.
template <int D, class E>
requires Engine<E, D>
void RunLoop<D, E>::remember(const Totals<D>& totals) {
  const auto list = [](const Vec<D, Int128>& value) {
    return std::vector<Int128>(value.component, value.component + D);
  };
  record_.step = totals.step;
  record_.digest = digest_text(totals.digest());
  record_.start_momentum = list(engine_.state().start_momentum);
  record_.end_momentum = list(totals.momentum);
  record_.outside_impulse = list(totals.outside_impulse);
  record_.particles = totals.particles();
  record_.frozen_particles = static_cast<std::uint64_t>(totals.frozen_count);
  record_.solids = static_cast<std::uint64_t>(totals.sp_count);
}

/// Collective. Times are those of the slowest process.
template <int D, class E>
requires Engine<E, D>
void RunLoop<D, E>::write_record(const std::string& state, const std::string& message) {
  PhaseSeconds phases = engine_.phase_seconds();
  phases.emplace_back("output", output_seconds_);
  phases.emplace_back("steps", stepping_seconds_);
  std::vector<double> seconds;
  for (const auto& phase : phases) seconds.push_back(phase.second);
  setup_.group.maximum(seconds);
  for (std::size_t k = 0; k < phases.size(); ++k) phases[k].second = seconds[k];
  record_.wall_seconds = phases;
  const double done = static_cast<double>(record_.step - first_step_);
  record_.rate = seconds.back() > 0.0 ? done * static_cast<double>(record_.particles) / seconds.back() : 0.0;
  if constexpr (requires { engine_.traffic(); }) {
    const Traffic traffic = engine_.traffic();
    std::vector<double> most{static_cast<double>(traffic.messages), static_cast<double>(traffic.bytes),
                             static_cast<double>(traffic.neighbours), static_cast<double>(engine_.orderings())};
    setup_.group.maximum(most);
    record_.messages_per_step = done > 0.0 ? most[0] / done : 0.0;
    record_.bytes_per_step = done > 0.0 ? most[1] / done : 0.0;
    record_.neighbours = static_cast<int>(most[2]);
    record_.orderings = static_cast<std::uint64_t>(most[3]);
  }
  if constexpr (requires { engine_.domains(); }) record_.borders = borders_in_scene_units();
  record_.state = state;
  record_.message = message;
  on_first(setup_.group, [&] { write_run_record(folder_ / run_record_name, record_); });
}

template <int D, class E>
requires Engine<E, D> std::vector<std::vector<double>> RunLoop<D, E>::borders_in_scene_units()
const {
  std::vector<std::vector<double>> borders;
  for (int axis = 0; axis < D; ++axis) {
    const double unit = setup_.model.pair.length[axis] * setup_.model.units.length;
    auto& along = borders.emplace_back();
    for (const double cut : engine_.domains().cuts()[static_cast<std::size_t>(axis)]) along.push_back(cut * unit);
  }
  return borders;
}

/// The state may hold nonsense: the figures stay those of the last sample. A disk that is full for a checkpoint may be
/// full for this as well; the error that is under way matters more.
template <int D, class E>
requires Engine<E, D>
void RunLoop<D, E>::write_record_of_failure(const std::string& state, const std::string& message) {
  progress_->finish();
  try {
    write_record(state, message);
  } catch (const InputError&) {
  }
}

template <int D, class E>
requires Engine<E, D>
void RunLoop<D, E>::say_end(const std::string& message) {
  progress_->finish();
  if (!message.empty()) fmt::print("stopped at step {}; {}\n", record_.step, message);
  fmt::print("digest {} step {} particles {} ranks {} particle-steps/s {:.4g}\n", record_.digest, record_.step,
             record_.particles, record_.ranks, record_.rate);
  std::fflush(stdout);
}

}  // namespace mappm
