// The pair pass alone: a fluid in disorder, 39 neighbours in the plane and 77 in space, about 10^5 PPs. The number of
// cells to a cutoff is varied: it decides how many candidates are met.
#include "parallel/fluid_pass.hpp"

#include <benchmark/benchmark.h>

#include "sorted_fluid.hpp"

namespace mappm {
namespace {

template <int D, class Numbers>
void pair_pass(benchmark::State& state) {
  bench::SortedFluid<D> setup(D == 2 ? 320 : 48, static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  FluidPass<D, Numbers> pass(setup.fluid.model, 1);
  for (auto _ : state) {
    pass.sum(setup.particles, setup.grid);
    benchmark::DoNotOptimize(pass.sums(0));
  }
  const auto rate = [&](std::uint64_t count) {
    return benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate);
  };
  state.counters["pairs/s"] = rate(setup.pairs);
  state.counters["particle-steps/s"] = rate(setup.owned);
}

BENCHMARK(pair_pass<2, DoublePairs<2>>)
    ->Name("fluid_pass_2d_39_neighbours")
    ->ArgNames({"across", "along"})
    ->ArgsProduct({{1, 2, 3, 4}, {4, 8, 16}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(pair_pass<3, DoublePairs<3>>)
    ->Name("fluid_pass_3d_77_neighbours")
    ->ArgNames({"across", "along"})
    ->ArgsProduct({{1, 2, 3}, {4, 8, 16}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(pair_pass<2, SinglePairs<2>>)
    ->Name("fluid_pass_2d_39_neighbours_single")
    ->ArgNames({"across", "along"})
    ->ArgsProduct({{1, 2, 3, 4}, {4, 8, 16}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(pair_pass<3, SinglePairs<3>>)
    ->Name("fluid_pass_3d_77_neighbours_single")
    ->ArgNames({"across", "along"})
    ->ArgsProduct({{1, 2, 3}, {4, 8, 16}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mappm

BENCHMARK_MAIN();
