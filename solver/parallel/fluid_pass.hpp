// The pair pass of the fast engine: every pair of PPs once (half list), every PP-FP pair once, in rows of lanes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "parallel/lanes_loop.hpp"
#include "particles/cell_grid.hpp"
#include "particles/pair_trace.hpp"

namespace mappm {

template <int D>
class FluidPass {
 public:
  FluidPass(const Model<D>& model, int threads) : model_(model), threads_(threads) {}

  /// Sums over all neighbours of the owned PPs in `fluid`, which is in the order of `grid`; sums of ghosts are partial
  /// and meaningless. `frozen` are all FPs in reach; `frozen_sums[k]` becomes complete where FP k lies in the region.
  void sum(FluidParticles<D>& fluid, const CellGrid<D>& grid, const std::vector<FrozenInStep<D>>& frozen,
           std::vector<NeighbourSums<D>>& frozen_sums);

  NeighbourSums<D> sums(std::size_t i) const;

  /// After `sum` and with its arguments: what each partner gave to the PP with this id that lies in the region, every
  /// pair of `sum` taken alone; none where there is no such PP. For an FP `id` is the index of its solid in the step.
  std::optional<std::vector<PartnerTrace<D>>> trace(const FluidParticles<D>& fluid, const CellGrid<D>& grid,
                                                    const std::vector<FrozenInStep<D>>& frozen,
                                                    std::uint64_t particle) const;

 private:
  /// A row of cells beside the row of a particle: how far it lies off, and how many cells along x are in reach.
  struct RowOffset {
    Vec<D, int> cell;
    int reach;
  };
  std::vector<RowOffset> rows_within_cutoff(const CellGrid<D>& grid, bool half) const;
  void prepare(FluidParticles<D>& fluid);
  PairFields<D> fields(const FluidParticles<D>& fluid);
  template <class Work>
  void for_each_row(const CellGrid<D>& grid, int first_plane, int last_plane, Work&& work) const;
  template <class Work>
  void for_each_centre(const CellGrid<D>& grid, const Vec<D, int>& row, Work&& work) const;
  template <class PairWith>
  void for_each_range(const CellGrid<D>& grid, const FrozenInStep<D>& fp, PairWith&& pair_with) const;
  PairCentre<D> centre(const FluidParticles<D>& fluid, std::size_t i) const;
  template <class Kernel, bool transport>
  void sum_row(const FluidParticles<D>& fluid, const CellGrid<D>& grid, const PairFields<D>& fields,
               const Vec<D, int>& row);
  template <class Kernel, bool transport>
  void sum_frozen(const CellGrid<D>& grid, const PairFields<D>& fields, const FrozenInStep<D>& fp,
                  NeighbourSums<D>& sums) const;
  struct PairSums {
    NeighbourSums<D> centre, other;
  };
  template <class Kernel, bool transport, bool lanes_first, class Beta>
  PairSums sums_of_pair(const FluidParticles<D>& fluid, const PairCentre<D>& centre, std::uint32_t j, const Beta& beta);
  template <class Work>
  void for_each_band(const CellGrid<D>& grid, Work&& work) const;

  const Model<D>& model_;
  int threads_;
  std::vector<RowOffset> half_rows_, all_rows_;
  std::vector<double> v2_, pv2_;
  std::array<std::vector<std::int64_t>, D> impulse_, shift_;
  std::vector<std::int64_t> density_;
};

}  // namespace mappm
