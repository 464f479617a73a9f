// How the planes of a grid, the cells with one coordinate on the slowest axis, are shared out to threads.
#pragma once

#include <omp.h>

#include <algorithm>
#include <cstddef>

#include "particles/cell_grid.hpp"

namespace mappm {

/// What a plane writes lies at most `margin` planes beyond itself, so bands of planes of one parity, each two margins
/// high, run side by side.
template <int D>
class Bands {
 public:
  explicit Bands(int threads) : threads_(threads) {}

  std::size_t threads() const { return static_cast<std::size_t>(threads_); }
  std::size_t count(const CellGrid<D>& grid) const {
    return static_cast<std::size_t>((grid.count(D - 1) + height(grid) - 1) / height(grid));
  }
  /// Calls work(first, last, thread, band) for all bands, of the planes [first, last).
  template <class Work>
  void for_each(const CellGrid<D>& grid, Work&& work) const {
    const int planes = grid.count(D - 1), high = height(grid), bands = static_cast<int>(count(grid));
    for (int parity = 0; parity < std::min(bands, 2); ++parity) {
#pragma omp parallel for num_threads(threads_) schedule(dynamic) if (threads_ > 1)
      for (int band = parity; band < bands; band += 2)
        work(band * high, std::min(planes, (band + 1) * high), static_cast<std::size_t>(omp_get_thread_num()),
             static_cast<std::size_t>(band));
    }
  }

 private:
  int height(const CellGrid<D>& grid) const {
    const int planes = grid.count(D - 1);
    return threads_ == 1 ? planes : std::max(2 * grid.margin(D - 1), planes / (4 * threads_) + 1);
  }

  int threads_;
};

}  // namespace mappm
