// The pair pass alone: a fluid in disorder, 39 neighbours in the plane and 77 in space, about 10^5 PPs. The outermost
// rcut of the box stands for ghosts. The number of cells to a cutoff is varied: it decides how many candidates are met.
#include "parallel/fluid_pass.hpp"

#include <benchmark/benchmark.h>

#include "disordered_fluid.hpp"
#include "serial/neighbours.hpp"

namespace mappm {
namespace {

template <int D>
struct Setup {
  bench::DisorderedFluid<D> fluid;
  FluidParticles<D> particles;
  CellGrid<D> grid;
  std::uint64_t owned = 0, pairs = 0;

  Setup(std::uint64_t side, int across, int along) : fluid(side), particles(fluid.state(Region<D>::whole_box()).fluid) {
    Region<D> region;
    for (int axis = 0; axis < D; ++axis) {
      region.low[axis] = std::ceil(1.0 / fluid.model.pair.length[axis]);
      region.high[axis] = box_quanta - region.low[axis];
    }
    Vec<D, int> cells_per_cutoff;
    for (int axis = 1; axis < D; ++axis) cells_per_cutoff[axis] = across;
    cells_per_cutoff[0] = along;
    grid.fit(region, fluid.model.pair.length, cells_per_cutoff);
    grid.sort(particles);
    count(region);
  }

  /// Pairs within the cutoff of which at least one PP is owned.
  void count(const Region<D>& region) {
    NeighbourSearch<D> search(fluid.model.box, Neighbours::cells);
    for (std::size_t i = 0; i < particles.size(); ++i) search.add(bench::position(particles, i));
    for (std::size_t i = 0; i < particles.size(); ++i) {
      if (!region.contains(bench::position(particles, i))) continue;
      ++owned;
      search.for_each_near(bench::position(particles, i), [&](int k) {
        const auto j = static_cast<std::size_t>(k);
        if (j == i || bench::distance(fluid.model, particles, i, j) >= 1.0) return;
        if (j > i || !region.contains(bench::position(particles, j))) ++pairs;
      });
    }
  }
};

template <int D>
void pair_pass(benchmark::State& state) {
  Setup<D> setup(D == 2 ? 320 : 48, static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  FluidPass<D> pass(setup.fluid.model, 1);
  std::vector<NeighbourSums<D>> frozen_sums;
  for (auto _ : state) {
    pass.sum(setup.particles, setup.grid, {}, frozen_sums);
    benchmark::DoNotOptimize(pass.sums(0));
  }
  const auto rate = [&](std::uint64_t count) {
    return benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate);
  };
  state.counters["pairs/s"] = rate(setup.pairs);
  state.counters["particle-steps/s"] = rate(setup.owned);
}

BENCHMARK(pair_pass<2>)
    ->Name("fluid_pass_2d_39_neighbours")
    ->ArgNames({"across", "along"})
    ->ArgsProduct({{1, 2, 3, 4}, {4, 8, 16}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(pair_pass<3>)
    ->Name("fluid_pass_3d_77_neighbours")
    ->ArgNames({"across", "along"})
    ->ArgsProduct({{1, 2, 3}, {4, 8, 16}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mappm

BENCHMARK_MAIN();
