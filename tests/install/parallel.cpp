// The same by the layers below, for a scene in the plane: embedded-parallel SCENE.toml STEPS, also under mpirun.
#include <cstdio>
#include <cstdlib>
#include <mappm/output/totals.hpp>
#include <mappm/parallel/engine.hpp>
#include <mappm/scene/build.hpp>
#include <mappm/scene/reader.hpp>

int main(int argc, char** argv) {
  const mappm::Communicator processes(argc, argv);
  if (argc != 3) return EXIT_FAILURE;
  const mappm::Scene scene = mappm::read_scene(argv[1], {});
  const auto built = mappm::make_model<2>(scene);
  const auto domains = mappm::make_domains<2>(built.model, processes.size(), "");
  mappm::ParallelEngine<2> engine(built.model, domains, processes,
                                  mappm::build_state<2>(scene, built.model, domains.region(processes.rank())), {});
  for (long steps = std::atol(argv[2]); steps > 0; --steps) engine.step();
  const auto totals = mappm::measure(built.model, engine.sample(), processes);
  if (processes.is_first()) std::printf("%s\n", mappm::digest_text(totals.digest()).c_str());
  return EXIT_SUCCESS;
}
