// The pair passes alone, that of densities and that of forces together, and the search for its lists: a fluid in
// disorder, 39 neighbours in the plane and 77 in space, about 10^5 PPs. The number of cells to a reach is varied: it
// decides how many candidates the search meets, and how the PPs lie in blocks.
#include "parallel/fluid_pass.hpp"

#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "sorted_fluid.hpp"

namespace mappm {
namespace {

enum class Work { pass, search };

template <int D, class Numbers, Work work>
void measure(benchmark::State& state) {
  bench::SortedFluid<D> setup(D == 2 ? 320 : 48, [&](auto&) {
    Vec<D, double> cells;
    for (int axis = 0; axis < D; ++axis)
      cells[axis] = axis == 0 ? static_cast<double>(state.range(1)) : 0.01 * static_cast<double>(state.range(0));
    return cells;
  });
  FluidPass<D, Numbers> pass(setup.fluid.model, 1);
  setup.list(pass);
  for (auto _ : state) {
    if constexpr (work == Work::pass)
      setup.sum(pass);
    else
      setup.list(pass);
    benchmark::DoNotOptimize(pass.blocks().sums(0));
  }
  const auto rate = [&](std::uint64_t count) {
    return benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate);
  };
  state.counters["pairs/s"] = rate(setup.pairs);
  state.counters["particle-steps/s"] = rate(setup.owned);
}

template <int D>
void with_cells(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"percent_across", "along"})
      ->ArgsProduct({{100, 125, 145, 160, 200, 300}, {4, 8, 16}})
      ->Unit(benchmark::kMillisecond);
}

BENCHMARK(measure<2, DoubleLanes<2>, Work::pass>)->Name("pass_2d_39_neighbours")->Apply(with_cells<2>);
BENCHMARK(measure<3, DoubleLanes<3>, Work::pass>)->Name("pass_3d_77_neighbours")->Apply(with_cells<3>);
BENCHMARK(measure<2, SingleLanes<2>, Work::pass>)->Name("pass_2d_39_neighbours_single")->Apply(with_cells<2>);
BENCHMARK(measure<3, SingleLanes<3>, Work::pass>)->Name("pass_3d_77_neighbours_single")->Apply(with_cells<3>);
BENCHMARK(measure<2, DoubleLanes<2>, Work::search>)->Name("search_2d_39_neighbours")->Apply(with_cells<2>);
BENCHMARK(measure<3, DoubleLanes<3>, Work::search>)->Name("search_3d_77_neighbours")->Apply(with_cells<3>);

}  // namespace
}  // namespace mappm

BENCHMARK_MAIN();
