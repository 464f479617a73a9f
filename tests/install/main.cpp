// Runs the first steps of a scene and prints the digest: embedded SCENE.toml STEPS
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <mappm/library/simulation.hpp>

int main(int argc, char** argv) try {
  if (argc != 3) return EXIT_FAILURE;
  mappm::Simulation simulation(argv[1]);
  for (long steps = std::atol(argv[2]); steps > 0; --steps) simulation.step();
  std::printf("%s\n", simulation.digest().c_str());
  return EXIT_SUCCESS;
} catch (const std::exception& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return EXIT_FAILURE;
}
