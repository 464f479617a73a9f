// The PPs near FPs, in lists of a step.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "parallel/lanes_loop.hpp"
#include "parallel/near_rows.hpp"
#include "particles/cell_grid.hpp"
#include "particles/frozen.hpp"

namespace mappm {

/// Indices of the FPs in each plane of cells, ordered by rows.
template <int D>
std::vector<std::vector<std::uint32_t>> frozen_by_plane(const CellGrid<D>& grid,
                                                        const std::vector<FrozenInStep<D>>& frozen) {
  std::vector<std::vector<std::uint32_t>> by_plane(static_cast<std::size_t>(grid.count(D - 1)));
  for (std::uint32_t k = 0; k < frozen.size(); ++k)
    by_plane[static_cast<std::size_t>(grid.coordinate(D - 1, frozen[k].place.x[D - 1]))].push_back(k);
  if constexpr (D == 3)
    for (auto& plane : by_plane)
      std::ranges::sort(plane, {}, [&](std::uint32_t k) { return grid.coordinate(1, frozen[k].place.x[1]); });
  return by_plane;
}

/// An FP as the centre of pairs.
template <int D, class Numbers>
MAPPM_INLINE PairCentre<D, Numbers> centre_of(const Numbers& numbers, const FrozenInStep<D>& fp) {
  using Real = typename Numbers::Real;
  PairCentre<D, Numbers> centre;
  for (int axis = 0; axis < D; ++axis) {
    centre.x[axis] = numbers.coordinate(axis, fp.place.x[axis]);
    centre.v[axis] = static_cast<Real>(fp.place.v[axis]);
  }
  centre.volume = {static_cast<Real>(fp.volume.v2), static_cast<Real>(fp.volume.pv2)};
  return centre;
}

/// Finds the PPs in blocks near FPs; one for each thread.
template <int D, class Numbers>
class FrozenSearch {
 public:
  using Lists = PartnerLists<D, Numbers>;

  /// FPs of a plane of cells, ordered by rows: calls work(lists) with the PPs near some of them. `rows`: all that a
  /// pair can join, from `row_offsets`.
  template <class Work>
  void for_each_list(const Numbers& numbers, const PairBlocks<D, Numbers>& blocks, const CellGrid<D>& grid,
                     const std::vector<Vec<D, int>>& rows, const std::vector<FrozenInStep<D>>& frozen,
                     std::span<const std::uint32_t> chosen, Work&& work) {
    Vec<D, int> fitted{};
    for (std::size_t n = 0; n < chosen.size(); ++n) {
      const FrozenInStep<D>& fp = frozen[chosen[n]];
      Vec<D, int> row;
      for (int axis = 1; axis < D; ++axis) row[axis] = grid.coordinate(axis, fp.place.x[axis]);
      if (n == 0 || row != fitted) near_.fit(grid, blocks, rows, row);
      fitted = row;
      near_.find(grid, {fp.place.x, fp.place.x});
      lists_.add(chosen[n], centre_of(numbers, fp).x, near_.count(),
                 [&](std::size_t other) { return near_.range(grid, other); });
      if (!lists_.is_full() && n + 1 < chosen.size()) continue;
      work(lists_);
      lists_.clear();
    }
  }

 private:
  NearRows<D> near_;
  Lists lists_;
};

}  // namespace mappm
