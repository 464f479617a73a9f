// mappm-reference: the serial solver, another program for the same scenes.
#include <cstdio>
#include <exception>
#include <map>
#include <string>
#include <utility>

#include "app/command.hpp"
#include "app/instruction_set.hpp"
#include "app/memory.hpp"
#include "app/run_loop.hpp"
#include "app/setup_notice.hpp"
#include "app/signals.hpp"
#include "base/single_group.hpp"
#include "scene/reader.hpp"
#include "serial/engine.hpp"

namespace mappm {

namespace {

/// Of the serial engine: measured in plane and space, at 2.5 to 6 spacings of rcut.
constexpr ParticleBytes particle_bytes{.each = 180.0, .an_axis = 26.0, .a_neighbour = 0.0};

template <int D>
void run_scene(const Scene& scene, const RunOptions& options, Neighbours neighbours, const Group& group,
               SetupNotice& notice) {
  const MemoryNeed need = memory_need(scene, particle_bytes);
  check_memory(scene, need, group);
  notice.doing("bodies and limits");
  BuiltModel<D> built = make_model<D>(scene);
  notice.doing(options.resume.empty() ? "particles" : "reading the checkpoint");
  Start<D> start = start_run<D>(scene, built.model, Region<D>::whole_box(), options, group);
  SerialEngine<D> engine(built.model, std::move(start.state), neighbours);

  RunSetup<D> setup =
      make_run_setup(scene, built, group, options, start, "mappm-reference", instruction_set, need.text());
  if (neighbours == Neighbours::all_pairs) setup.program_options = " --neighbours all-pairs";
  notice.end();
  run_loop<D>(setup, engine);
}

}  // namespace

}  // namespace mappm

int main(int argc, char** argv) try {
  using namespace mappm;
  open_standard_streams();
  make_write_signals_errors();
  const SingleGroup group;
  Neighbours neighbours = Neighbours::cells;
  const std::map<std::string, Neighbours> searches{{"cells", Neighbours::cells}, {"all-pairs", Neighbours::all_pairs}};
  const auto add_options = [&](CLI::App& command) {
    command
        .add_option("--neighbours", neighbours, "neighbour search: cells, or all-pairs (the oracle, for small scenes)")
        ->transform(CLI::CheckedTransformer(searches));
  };
  return run_command(argc, argv, group, "mappm-reference", add_options, [&](const RunOptions& options) {
    SetupNotice notice(group, options);
    const Scene scene = read_scene(options.scene, options.overrides);
    if (scene.dimension == 2)
      run_scene<2>(scene, options, neighbours, group, notice);
    else
      run_scene<3>(scene, options, neighbours, group, notice);
  });
} catch (const std::exception& error) {  // before the command line could be read
  std::fprintf(stderr, "error: %s\n", error.what());
  return mappm::exit_defect;
}
