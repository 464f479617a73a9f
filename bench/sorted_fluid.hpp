// A fluid in disorder, laid into cells as the engine does before the pair pass.
#pragma once

#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "disordered_fluid.hpp"
#include "parallel/fluid_pass.hpp"
#include "parallel/residents.hpp"
#include "particles/cell_grid.hpp"
#include "serial/neighbours.hpp"

namespace mappm::bench {

/// The outermost reach of the box, rcut and the skin of the lists, stands for ghosts.
template <int D>
struct SortedFluid {
  DisorderedFluid<D> fluid;
  FluidParticles<D> particles;
  CellGrid<D> grid;
  std::uint64_t owned = 0, pairs = 0, pairs_of_ghosts = 0;

  explicit SortedFluid(std::uint64_t side)
      : SortedFluid(side, [](auto& model) { return cells_per_reach(model, reach); }) {}
  /// cells_of(model): cells to a reach.
  template <class CellsOf>
  SortedFluid(std::uint64_t side, CellsOf&& cells_of)
      : fluid(side), particles(fluid.state(Region<D>::whole_box()).fluid) {
    Vec<D, double> in_reach;
    for (int axis = 0; axis < D; ++axis) {
      in_reach[axis] = fluid.model.pair.length[axis] / reach;
      region.low[axis] = std::ceil(1.0 / in_reach[axis]);
      region.high[axis] = box_quanta - region.low[axis];
    }
    grid.fit(region, in_reach, cells_of(fluid.model));
    grid.sort(particles);
    count();
  }

  /// Finds the lists of a pass, as at the start of a stay.
  template <class Pass>
  void list(Pass& pass) {
    std::vector<std::uint32_t> all(particles.size());  // so that each sum lays them into blocks
    std::iota(all.begin(), all.end(), 0u);
    pass.list(particles, grid, widened(fluid.model, region, 0.5 * skin), reach, all, false);
  }

  /// Both passes, of densities and of forces, as if all PPs were owned.
  template <class Pass>
  void sum(Pass& pass) {
    density.resize(particles.size());
    auto known = pass.sum_inner_densities(grid).sum_rest(particles, grid).close({}, density);
    static_cast<void>(std::move(known).sum_inner(grid).sum_rest(density, grid));
  }

 private:
  static constexpr double reach = 1.0 + skin;
  Region<D> region;
  std::vector<double> density;

  /// Pairs within the cutoff: those of which at least one PP is owned, and the others.
  void count() {
    NeighbourSearch<D> search(fluid.model.box, Neighbours::cells);
    for (std::size_t i = 0; i < particles.size(); ++i) search.add(particles.position(i));
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const bool own = region.contains(particles.position(i));
      owned += own ? 1 : 0;
      search.for_each_near(particles.position(i), [&](int k) {
        const auto j = static_cast<std::size_t>(k);
        if (j <= i || distance(fluid.model, particles, i, j) >= 1.0) return;
        ++(own || region.contains(particles.position(j)) ? pairs : pairs_of_ghosts);
      });
    }
  }
};

}  // namespace mappm::bench
