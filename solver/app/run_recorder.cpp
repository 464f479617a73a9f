#include "app/run_recorder.hpp"

#include <vector>

#include "output/together.hpp"

namespace mappm {

template <int D>
RunRecorder<D>::RunRecorder(const RunSetup<D>& setup, std::uint64_t first_step)
    : setup_(setup), path_(setup.start.folder.path() / run_record_name) {
  const Model<D>& model = setup.model;
  record_.program = setup.program;
  record_.instruction_set = setup.instruction_set;
  record_.scene_file = setup.scene.file;
  record_.scene_name = setup.scene.name;
  record_.scene_text = setup.scene.text;
  record_.scene_identity = setup.scene.identity;
  record_.terms = model.terms;
  record_.warnings = setup.warnings;
  record_.first_step = first_step;
  record_.time_step = model.dt * model.units.time();
  record_.limits = setup.limits;
  record_.iota = velocity_quantum * model.units.mass * model.units.velocity;
  record_.ranks = setup.group.size();
  record_.threads = setup.threads;
  record_.domains = setup.domains;
}

template <int D>
void RunRecorder<D>::remember(const Totals<D>& totals, const Vec<D, Int128>& start_momentum) {
  const auto list = [](const Vec<D, Int128>& value) {
    return std::vector<Int128>(value.component, value.component + D);
  };
  record_.step = totals.step;
  record_.digest = digest_text(totals.digest());
  record_.start_momentum = list(start_momentum);
  record_.end_momentum = list(totals.momentum);
  record_.outside_impulse = list(totals.outside_impulse);
  record_.particles = totals.particles();
  record_.frozen_particles = static_cast<std::uint64_t>(totals.frozen_count);
  record_.solids = static_cast<std::uint64_t>(totals.sp_count);
}

template <int D>
void RunRecorder<D>::write(const std::string& state, const std::string& message, const Engine<D>& engine,
                           double stepping_seconds, double output_seconds) {
  set_times(engine, stepping_seconds, output_seconds);
  if (const auto report = engine.domain_report()) set_domains(*report);
  record_.state = state;
  record_.message = message;
  on_first(setup_.group, [&] { write_run_record(path_, record_); });
}

template <int D>
void RunRecorder<D>::set_times(const Engine<D>& engine, double stepping_seconds, double output_seconds) {
  PhaseSeconds phases = engine.phase_seconds();
  phases.emplace_back("output", output_seconds);
  phases.emplace_back("steps", stepping_seconds);
  std::vector<double> seconds;
  for (const auto& phase : phases) seconds.push_back(phase.second);
  setup_.group.maximum(seconds);
  for (std::size_t k = 0; k < phases.size(); ++k) phases[k].second = seconds[k];
  record_.wall_seconds = phases;
  const double done = static_cast<double>(record_.step - record_.first_step);
  record_.rate = seconds.back() > 0.0 ? done * static_cast<double>(record_.particles) / seconds.back() : 0.0;
}

template <int D>
void RunRecorder<D>::set_domains(const DomainReport<D>& report) {
  const Traffic& traffic = report.traffic;
  std::vector<double> most{static_cast<double>(traffic.messages), static_cast<double>(traffic.bytes),
                           static_cast<double>(traffic.neighbours), static_cast<double>(report.orderings)};
  setup_.group.maximum(most);
  const double done = static_cast<double>(record_.step - record_.first_step);
  record_.messages_per_step = done > 0.0 ? most[0] / done : 0.0;
  record_.bytes_per_step = done > 0.0 ? most[1] / done : 0.0;
  record_.neighbours = static_cast<int>(most[2]);
  record_.orderings = static_cast<std::uint64_t>(most[3]);
  record_.borders.clear();
  for (int axis = 0; axis < D; ++axis) {
    const double unit = setup_.model.pair.length[axis] * setup_.model.units.length;
    auto& along = record_.borders.emplace_back();
    for (const double cut : report.cuts[static_cast<std::size_t>(axis)]) along.push_back(cut * unit);
  }
}

template class RunRecorder<2>;
template class RunRecorder<3>;

}  // namespace mappm
