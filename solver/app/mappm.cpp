// mappm: the parallel solver. It runs as one process, or as many under mpirun.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "app/command.hpp"
#include "app/instruction_set.hpp"
#include "app/memory.hpp"
#include "app/run_loop.hpp"
#include "app/setup_notice.hpp"
#include "app/signals.hpp"
#include "parallel/communicator.hpp"
#include "parallel/domains.hpp"
#include "parallel/engine.hpp"
#include "scene/reader.hpp"

namespace mappm {

namespace {

struct DomainOptions {
  std::string grid;    // "2x4"; empty: slabs
  bool faces = false;  // the ledger of the faces, at every sample
  std::string isa;     // instruction set; empty: the best
  ParallelOptions engine;

  /// What differs from the defaults, as it is given on the command line.
  std::string repeated() const {
    std::string text = grid.empty() ? "" : " --domains " + grid;
    if (engine.threads != ParallelOptions{}.threads) text += " --threads " + std::to_string(engine.threads);
    if (engine.rebalance != ParallelOptions{}.rebalance) text += " --rebalance " + std::to_string(engine.rebalance);
    if (faces) text += " --faces";
    if (!isa.empty()) text += " --isa " + isa;
    return text;
  }
};

/// Of the parallel engine: measured in plane and space, at 2.5 to 6 spacings of rcut.
constexpr ParticleBytes particle_bytes{.each = 0.0, .an_axis = 150.0, .a_neighbour = 0.75};

/// Throws InputError. What --isa names was chosen before this code began, if it could be.
void check_instruction_set(const std::string& isa) {
  if (isa.empty() || isa == instruction_set) return;
  const char* const fix = build_info::portable
                              ? "this processor lacks it; leave --isa out, which chooses {} here"
                              : "this program is built for {} alone; leave --isa out, or build the preset portable";
  throw InputError("command line", "--isa", isa, fmt::format(fmt::runtime(fix), instruction_set));
}

template <int D>
void run_scene(const Scene& scene, const RunOptions& options, const DomainOptions& domain_options,
               const Communicator& communicator, SetupNotice& notice) {
  const MemoryNeed need = memory_need(scene, particle_bytes);
  check_memory(scene, need, communicator);
  notice.doing("bodies and limits");
  BuiltModel<D> built = together(communicator, [&] { return make_model<D>(scene); });
  const Domains<D> domains =
      together(communicator, [&] { return make_domains<D>(built.model, communicator.size(), domain_options.grid); });
  notice.doing(options.resume.empty() ? "particles" : "reading the checkpoint");
  Start<D> start = start_run<D>(scene, built.model, domains.region(communicator.rank()), options, communicator);
  notice.doing("domains");
  ParallelOptions engine_options = domain_options.engine;
  if (domain_options.faces) engine_options.faces = scene.output.sample;
  engine_options.last_step = last_step(scene, built.model, options);
  ParallelEngine<D> engine(built.model, domains, communicator, std::move(start.state), engine_options);

  RunSetup<D> setup = make_run_setup(scene, built, communicator, options, start, "mappm", instruction_set, need.text());
  setup.program_options = domain_options.repeated();
  const Vec<D, int> grid = domains.grid();
  setup.domains.assign(grid.component, grid.component + D);
  setup.threads = domain_options.engine.threads;
  setup.faces = domain_options.faces;
  notice.end();
  run_loop<D>(setup, engine);
}

}  // namespace

}  // namespace mappm

int main(int argc, char** argv) try {
  using namespace mappm;
  open_standard_streams();
  make_write_signals_errors();
  const Communicator communicator(argc, argv);
  DomainOptions domain_options;
  const auto add_options = [&](CLI::App& command) {
    add_text(command, "--domains", domain_options.grid,
             "domains along x, y(, z), as in 2x4 (default: slabs along the longest side, of equal ones the last)");
    add_whole_number(command, "--threads", domain_options.engine.threads, 1, 256, "threads a process (default: 1)");
    add_whole_number(command, "--rebalance", domain_options.engine.rebalance, 0, last_countable_step,
                     "steps between moves of the domain borders to the particle load (default: at start only)");
    command.add_flag("--faces", domain_options.faces,
                     "write to faces.csv, at every sample, the impulse that each domain received from each other");
    add_text(command, "--isa", domain_options.isa, "instruction set (default: the best that the processor has)")
        ->check(CLI::IsMember(std::vector<std::string>(instruction_sets.begin(), instruction_sets.end())));
  };
  return run_command(argc, argv, communicator, "mappm", add_options, [&](const RunOptions& options) {
    together(communicator, [&] { check_instruction_set(domain_options.isa); });
    SetupNotice notice(communicator, options);
    std::string text;  // read once: a pipe gives it to one process alone
    on_first(communicator, [&] { text = scene_file_text(options.scene); });
    text = communicator.broadcast(text, 0);
    const Scene scene = together(communicator, [&] { return read_scene_text(text, options.scene, options.overrides); });
    if (scene.dimension == 2)
      run_scene<2>(scene, options, domain_options, communicator, notice);
    else
      run_scene<3>(scene, options, domain_options, communicator, notice);
  });
} catch (const std::exception& error) {  // before the command line could be read
  std::fprintf(stderr, "error: %s\n", error.what());
  return mappm::exit_defect;
}
