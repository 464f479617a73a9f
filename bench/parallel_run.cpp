// The whole step of the parallel engine on a fluid in disorder: exchange, sorting, pairs, integration. Runs alone or
// under mpirun; prints one line a figure. A `figure` is an absolute value, a `ratio` is one against a stated other:
//   speed_over_6e6      particle-steps/s of a core against 6 million
//   speed_over_serial   against the serial engine (one process only)
//   pair_share          of the wall time spent in the two pair passes
//   bytes_over_200      bytes a PP, by growth of the resident set, against 200
#include <fmt/format.h>
#include <malloc.h>

#include <cmath>
#include <fstream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "disordered_fluid.hpp"
#include "parallel/engine.hpp"
#include "serial/engine.hpp"
#include "timing.hpp"

namespace mappm {
namespace {

constexpr int repeats = 7, steps_a_repeat = 15, first_steps = 10;

/// Largest resident set of this process since `reset_peak`, bytes.
double peak_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmHWM:") {
      double kibibytes = 0.0;
      status >> kibibytes;
      return 1024.0 * kibibytes;
    }
  return 0.0;
}

/// Gives free memory back to the system and starts the peak anew (clear_refs 5, see proc(5)).
void reset_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

/// Mean number of neighbours of owned PPs that lie deeper in the region than rcut; `enough` of them are asked.
template <int D>
double mean_neighbours(const Model<D>& model, const FluidParticles<D>& particles, Region<D> region) {
  constexpr std::uint64_t enough = 2000;
  NeighbourSearch<D> search(model.box, Neighbours::cells);
  for (std::size_t i = 0; i < particles.size(); ++i) search.add(particles.position(i));
  for (int axis = 0; axis < D; ++axis) {
    region.low[axis] += std::ceil(1.0 / model.pair.length[axis]);
    region.high[axis] -= std::ceil(1.0 / model.pair.length[axis]);
  }
  std::uint64_t asked = 0, neighbours = 0;
  for (std::size_t i = 0; i < particles.size() && asked < enough; ++i) {
    if (!region.contains(particles.position(i))) continue;
    ++asked;
    search.for_each_near(particles.position(i), [&](int k) {
      const auto j = static_cast<std::size_t>(k);
      if (j != i && bench::distance(model, particles, i, j) < 1.0) ++neighbours;
    });
  }
  return static_cast<double>(neighbours) / static_cast<double>(asked);
}

/// Median seconds of a step on the slowest process.
template <class Engine>
double step_seconds(const Communicator& world, Engine& engine, int count, int steps) {
  std::vector<double> seconds;
  for (int repeat = 0; repeat < count; ++repeat) {
    world.barrier();
    double taken = seconds_of([&] {
                     for (int step = 0; step < steps; ++step) engine.step();
                   }) /
                   steps;
    world.maximum(std::span(&taken, 1));
    seconds.push_back(taken);
  }
  return bench::median(seconds);
}

template <int D>
void measure(const Communicator& world, const std::string& name, std::uint64_t side) {
  const bench::DisorderedFluid<D> fluid(side);
  const Domains<D> domains = make_domains<D>(fluid.model, world.size(), "");
  reset_peak();
  const double before = peak_bytes();
  ParallelEngine<D> engine(fluid.model, domains, world, fluid.state(domains.region(world.rank())), {});
  for (int step = 0; step < first_steps; ++step) engine.step();
  const double resident = (peak_bytes() - before) / static_cast<double>(engine.state().fluid.size());
  double pair_seconds = 0.0, all_seconds = 0.0;
  const double step = step_seconds(world, engine, repeats, steps_a_repeat);
  for (const auto& [phase, seconds] : engine.phase_seconds()) {
    all_seconds += seconds;
    if (phase == "densities" || phase == "pairs") pair_seconds += seconds;
  }
  const double neighbours = mean_neighbours(fluid.model, engine.state().fluid, engine.domains().region(world.rank()));
  if (engine.first_fault().any()) throw RangeError(engine.first_fault().text());
  const double particles = std::pow(static_cast<double>(side), D), cores = world.size();

  std::vector<std::pair<std::string, double>> figures{{"particles", particles},
                                                      {"processes", cores},
                                                      {"neighbours", neighbours},
                                                      {"particle_steps_per_s", particles / step},
                                                      {"particle_steps_per_s_and_core", particles / step / cores},
                                                      {"pairs_per_s", 0.5 * neighbours * particles / step},
                                                      {"bytes_per_particle_resident", resident}};
  std::vector<std::pair<std::string, double>> ratios{{"speed_over_6e6", particles / step / cores / 6e6},
                                                     {"pair_share", pair_seconds / all_seconds},
                                                     {"bytes_over_200", resident / 200.0}};
  if (world.size() == 1) {
    SerialEngine<D> serial(fluid.model, fluid.state(Region<D>::whole_box()), Neighbours::cells);
    ratios.emplace_back("speed_over_serial", step_seconds(world, serial, 5, 1) / step);
  }
  if (!world.is_first()) return;
  for (const auto& [figure, value] : figures) fmt::print("figure {}.{} {:.6g}\n", name, figure, value);
  for (const auto& [ratio, value] : ratios) fmt::print("ratio {}.{} {:.4g}\n", name, ratio, value);
}

}  // namespace
}  // namespace mappm

int main(int argc, char** argv) {
  const mappm::Communicator world(argc, argv);
  mappm::measure<2>(world, "fluid_2d_39", 400);
  mappm::measure<3>(world, "fluid_3d_77", 54);
}
