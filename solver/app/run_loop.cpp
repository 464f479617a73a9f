#include "app/run_loop.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "app/poll.hpp"
#include "app/run_recorder.hpp"
#include "app/signals.hpp"
#include "base/stopwatch.hpp"
#include "output/checkpoint_folder.hpp"
#include "output/face_series.hpp"
#include "output/fastest.hpp"
#include "output/output_trial.hpp"
#include "output/progress.hpp"
#include "output/series.hpp"
#include "output/snapshot.hpp"
#include "output/solid_series.hpp"
#include "output/trace_file.hpp"

namespace mappm {

namespace {

template <int D>
class RunLoop {
 public:
  RunLoop(const RunSetup<D>& setup, Engine<D>& engine)
      : setup_(setup),
        engine_(engine),
        folder_(setup.start.folder.path()),
        first_step_(engine.state().step),
        last_step_(std::max(first_step_, last_step(setup.scene, setup.model, setup.options))),
        sampled_step_(setup.start.sampled_step),
        poll_(setup.group, first_step_, [this](const std::string& text) { warn(text); }),
        recorder_(setup, first_step_) {}

  void run();

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
  void open_series();
  void make_step();
  bool advance();
  bool outputs_due() const;
  void write_outputs();
  void sample(const Sample<D>& now);
  void check_mach(const Totals<D>& totals, const FluidParticles<D>& fluid);
  void warn(const std::string& text);
  std::string step_text() const;
  std::string resume_text() const;
  void save();
  void remember(const Totals<D>& totals) { recorder_.remember(totals, engine_.state().start_momentum); }
  void write_record(const std::string& state, const std::string& message) {
    recorder_.write(state, message, engine_, stepping_seconds_, output_seconds_);
  }
  void write_record_of_failure(const std::string& state, const std::string& message);
  void say_begin();
  void say_end(const std::string& message);

  const RunSetup<D>& setup_;
  Engine<D>& engine_;
  std::filesystem::path folder_;
  std::uint64_t first_step_, last_step_, sampled_step_;
  Poll poll_;
  std::optional<Series<D>> series_;
  std::optional<SolidSeries<D>> solid_series_;
  std::optional<FaceSeries<D>> face_series_;
  std::optional<Progress> progress_;
  RunRecorder<D> recorder_;
  double stepping_seconds_ = 0.0, output_seconds_ = 0.0;
  std::filesystem::path saved_;  // the last checkpoint of this run
  std::uint64_t saved_step_ = 0;
  bool too_fast_ = false;  // and warned about it
};

template <int D>
void RunLoop<D>::run() {
  watch_stop_signals();
  begin();
  std::string state = "finished", message;
  try {
    if (!advance()) {
      state = "stopped";
      message = resume_text();
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

template <int D>
void RunLoop<D>::begin() {
  check_trace();
  remember(measure(setup_.model, engine_.sample(), setup_.group));
  try_last_files();
  // From here on what was there before is replaced.
  setup_.start.folder.open(setup_.scene.identity, setup_.group);
  open_series();
  write_record("running", "");
  say_on_first([&] { say_begin(); });
  const bool quiet = setup_.options.quiet;
  const ProgressStyle style = setup_.group.is_first() ? progress_style(quiet) : ProgressStyle::silent;
  progress_.emplace(std::cerr, style, first_step_, last_step_, recorder_.record().particles);
}

template <int D>
void RunLoop<D>::open_series() {
  const Scene& scene = setup_.scene;
  const UnitNames units = scene.units == Units::si ? si_unit_names(D) : UnitNames{};
  // The last row of the run before may stand beyond its last sample: it is no row of the run that goes on.
  const auto kept = setup_.start.resumed_step.has_value() ? std::optional(setup_.start.sampled_step) : std::nullopt;
  series_.emplace(folder_, setup_.model, units, setup_.group, kept);
  if (scene.output.solids) solid_series_.emplace(folder_, setup_.model, units, setup_.group, kept);
  if (setup_.faces) face_series_.emplace(folder_, setup_.group, kept);
}

/// Steps to the end, with all output; false if a signal ended it before.
template <int D>
bool RunLoop<D>::advance() {
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

template <int D>
void RunLoop<D>::make_step() {
  const auto& trace = setup_.options.trace;
  const bool traced = trace.has_value() && trace->step == step();
  if (traced) engine_.trace_next_step(trace->particle);
  stepping_seconds_ += seconds_of([&] { engine_.step(); });
  if (traced) write_trace(folder_, engine_.last_trace(), setup_.model.terms.transport, setup_.group);
}

/// A trace of a step that the run does not make would be a file that never comes.
template <int D>
void RunLoop<D>::check_trace() const {
  const auto& trace = setup_.options.trace;
  if (!trace.has_value()) return;
  check_traced(engine_.state().fluid, trace->particle, setup_.group);
  if (trace->step >= first_step_ && trace->step < last_step_) return;
  throw InputError("command line", "--trace", fmt::format("{}@{}", trace->particle, trace->step),
                   fmt::format("this run goes from step {} to {}; choose a step from {} to {}, or change --steps",
                               first_step_, last_step_, first_step_, std::max(first_step_ + 1, last_step_) - 1));
}

/// The snapshot and the checkpoint with which a run ends.
template <int D>
void RunLoop<D>::try_last_files() {
  const RunRecord& record = recorder_.record();
  const std::uint64_t fluid = record.particles - record.frozen_particles;
  const SnapshotPaths snapshot(folder_ / snapshot_folder_name, last_step_);
  const std::filesystem::path checkpoint = checkpoint_path(folder_ / checkpoint_folder_name, last_step_);
  try_output({{snapshot.solids, record.particles * snapshot_point_bytes},
              {checkpoint, checkpoint_bytes<D>(fluid, record.solids)}},
             setup_.group);
}

template <int D>
bool RunLoop<D>::outputs_due() const {
  const OutputScene& output = setup_.scene.output;
  return step() == last_step_ || falls_on(output.sample) || falls_on(output.snapshot) || falls_on(output.checkpoint);
}

template <int D>
void RunLoop<D>::write_outputs() {
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

template <int D>
void RunLoop<D>::sample(const Sample<D>& now) {
  State<D>& state = now.state;
  const Totals<D> totals = measure(setup_.model, now, setup_.group);
  series_->add(totals, state.start_momentum, sampled_step_);
  if (solid_series_.has_value()) solid_series_->add(state, sampled_step_);
  if (face_series_.has_value()) face_series_->add(state.step, engine_.faces());
  check_mach(totals, state.fluid);
  for (Solid<D>& solid : state.solids) solid.sampled_impulse = solid.fluid_impulse;
  sampled_step_ = state.step;
  remember(totals);
}

/// Length of a step, and what limits it.
template <int D>
std::string RunLoop<D>::step_text() const {
  const double length = recorder_.record().time_step;
  const StepLimit ruling = setup_.limits.ruling(), last = setup_.limits.first(&StepLimit::last);
  if (!std::isfinite(ruling.usual)) return fmt::format("of {:.4g}", length);
  return fmt::format("of {:.4g} ({} rules: {:.4g}; last stable: {:.4g})", length, ruling.of, ruling.usual, last.last);
}

/// The command that goes on from the last checkpoint.
template <int D>
std::string RunLoop<D>::resume_text() const {
  const int ranks = setup_.group.size();
  return fmt::format("resume with: {}{} run {}{} --resume {}", ranks > 1 ? fmt::format("mpirun -np {} ", ranks) : "",
                     setup_.program, setup_.options.repeated(), setup_.program_options, shell_word(saved_.string()));
}

/// Warns once of a fluid that has become fast beside its sound.
template <int D>
void RunLoop<D>::check_mach(const Totals<D>& totals, const FluidParticles<D>& fluid) {
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

template <int D>
void RunLoop<D>::warn(const std::string& text) {
  recorder_.warn(text);
  say_on_first([&] { fmt::print(stderr, "warning: {}\n", text); });
}

template <int D>
void RunLoop<D>::save() {
  output_seconds_ += seconds_of([&] {
    saved_ = save_checkpoint(folder_ / checkpoint_folder_name, setup_.scene.identity, engine_.state(), sampled_step_,
                             setup_.group);
  });
  saved_step_ = step();
}

/// The state may hold nonsense: the figures stay those of the last sample. A disk that is full for a checkpoint may be
/// full for this as well; the error that is under way matters more.
template <int D>
void RunLoop<D>::write_record_of_failure(const std::string& state, const std::string& message) {
  progress_->finish();
  try {
    write_record(state, message);
  } catch (const InputError&) {
  }
}

/// To standard output. Where that fails, check_standard_output tells at the end: a run is not lost for it.
void say(const std::string& text) { std::fputs(text.c_str(), stdout); }

template <int D>
void RunLoop<D>::say_begin() {
  const RunRecord& record = recorder_.record();
  for (const std::string& warning : setup_.warnings) fmt::print(stderr, "warning: {}\n", warning);
  if (!setup_.options.quiet)
    say(fmt::format("{}: steps {} to {} {}, {} particles, about {} of memory, terms: {}; output in {}\n",
                    record.scene_name, first_step_, last_step_, step_text(), record.particles, setup_.memory,
                    fmt::join(term_names(record.terms), ", "), folder_.string()));
  std::fflush(stdout);
}

template <int D>
void RunLoop<D>::say_end(const std::string& message) {
  const RunRecord& record = recorder_.record();
  progress_->finish();
  if (!message.empty()) say(fmt::format("stopped at step {}; {}\n", record.step, message));
  say(fmt::format("digest {} step {} particles {} ranks {} particle-steps/s {:.4g}\n", record.digest, record.step,
                  record.particles, record.ranks, record.rate));
  std::fflush(stdout);
}

}  // namespace

template <int D>
void run_loop(const RunSetup<D>& setup, Engine<D>& engine) {
  RunLoop<D>(setup, engine).run();
}

template void run_loop(const RunSetup<2>&, Engine<2>&);
template void run_loop(const RunSetup<3>&, Engine<3>&);

}  // namespace mappm
