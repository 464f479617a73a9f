// A fluid in disorder, laid into cells as the engine does before the pair pass.
#pragma once

#include <cmath>
#include <cstdint>

#include "disordered_fluid.hpp"
#include "particles/cell_grid.hpp"
#include "serial/neighbours.hpp"

namespace mappm::bench {

/// The outermost rcut of the box stands for ghosts. `across`, `along`: cells to a cutoff.
template <int D>
struct SortedFluid {
  DisorderedFluid<D> fluid;
  FluidParticles<D> particles;
  CellGrid<D> grid;
  std::uint64_t owned = 0, pairs = 0;

  SortedFluid(std::uint64_t side, int across, int along)
      : fluid(side), particles(fluid.state(Region<D>::whole_box()).fluid) {
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
    for (std::size_t i = 0; i < particles.size(); ++i) search.add(position(particles, i));
    for (std::size_t i = 0; i < particles.size(); ++i) {
      if (!region.contains(position(particles, i))) continue;
      ++owned;
      search.for_each_near(position(particles, i), [&](int k) {
        const auto j = static_cast<std::size_t>(k);
        if (j == i || distance(fluid.model, particles, i, j) >= 1.0) return;
        if (j > i || !region.contains(position(particles, j))) ++pairs;
      });
    }
  }
};

}  // namespace mappm::bench
