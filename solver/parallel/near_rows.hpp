// The search of the fast engine. A row is a line of cells along x, in which particles are ordered by x; the partners of
// a particle are a range in each row nearby, as long as the chord that the row cuts from the sphere of the reach, which
// is the unit of length here.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "base/lanes.hpp"
#include "particles/cell_grid.hpp"

namespace mappm {

/// How far rows of cells lie from another, in cells across, that a pair can join; the own row first. `half`: of the
/// others only those that come later in memory.
template <int D>
std::vector<Vec<D, int>> row_offsets(const CellGrid<D>& grid, bool half) {
  std::vector<Vec<D, int>> offsets{Vec<D, int>{}};
  const int slow = D == 3 ? grid.margin(D - 1) : 0;
  for (int dz = half ? 0 : -slow; dz <= slow; ++dz)
    for (int dy = half && dz == 0 ? 1 : -grid.margin(1); dy <= grid.margin(1); ++dy) {
      Vec<D, int> offset{};
      offset[1] = dy;
      if constexpr (D == 3) offset[2] = dz;
      double square = 0.0;
      for (int axis = 1; axis < D; ++axis) {
        const double gap = std::max(0, std::abs(offset[axis]) - 1) * grid.width(axis);
        square += gap * gap;
      }
      if (square < 1.0 && (dy != 0 || dz != 0)) offsets.push_back(offset);
    }
  return offsets;
}

/// The rows near one row, and in them the ranges of particles near a box in the row.
template <int D>
class NearRows {
 public:
  /// The rows at `offsets` from `row` that lie in the grid. Ranges are given in slots of `blocks`.
  template <class Blocks>
  void fit(const CellGrid<D>& grid, const Blocks& blocks, const std::vector<Vec<D, int>>& offsets,
           const Vec<D, int>& row) {
    row_ = row;
    highest_ = grid.count(0) - 1;
    rows_.clear();
    for (auto& borders : borders_) borders.clear();
    for (const Vec<D, int>& offset : offsets) {
      const Vec<D, int> other = row + offset;
      bool chosen = true;
      for (int axis = 1; axis < D; ++axis) chosen = chosen && other[axis] >= 0 && other[axis] < grid.count(axis);
      if (!chosen) continue;
      rows_.push_back({grid.row(other), blocks.gap(other[D - 1])});
      for (int axis = 1; axis < D; ++axis) borders_[axis].push_back(offset[axis] * grid.width(axis));
    }
    const std::size_t padded = (rows_.size() + lane_count - 1) / lane_count * lane_count;
    for (auto& borders : borders_) borders.resize(padded);
    low_.resize(padded);
    high_.resize(padded);
  }

  std::size_t count() const { return rows_.size(); }

  /// For positions in this box, its borders among them.
  MAPPM_INLINE void find(const CellGrid<D>& grid, const Region<D>& box) {
    const double first = grid.fractional_coordinate(0, box.low[0]), last = grid.fractional_coordinate(0, box.high[0]);
    const double cells_per_reach = 1.0 / grid.width(0);
    Region<D> inside;  // of the row, from its lower borders
    for (int axis = 1; axis < D; ++axis) {
      inside.low[axis] = (grid.fractional_coordinate(axis, box.low[axis]) - row_[axis]) * grid.width(axis);
      inside.high[axis] = (grid.fractional_coordinate(axis, box.high[axis]) - row_[axis]) * grid.width(axis);
    }
    for (std::size_t n = 0; n < rows_.size(); n += lane_count) {
      Lanes left = 1.0 + rounding;  // square of half the chord
      for (int axis = 1; axis < D; ++axis) {
        const Lanes border = load_lanes(&borders_[axis][n]);
        const Lanes beside =
            larger(larger(border - inside.high[axis], inside.low[axis] - (border + grid.width(axis))), Lanes(0.0));
        left -= beside * beside;
      }
      const Lanes chord = square_root(larger(left, Lanes(0.0))) * cells_per_reach + rounding;
      const Lanes half = smaller(chord, larger(left * 1e300, Lanes(first - last - 1.0)));  // empty without a chord
      whole_numbers(smaller(larger(first - half, Lanes(0.0)), Lanes(highest_)), &low_[n]);
      whole_numbers(larger(smaller(last + half, Lanes(highest_)), Lanes(-1.0)), &high_[n]);
    }
  }

  /// Slots [first, end) of a row that hold all those within the reach of the box, and others. There may be none, with
  /// end <= first.
  struct Range {
    std::uint32_t first, end;
  };
  MAPPM_INLINE Range range(const CellGrid<D>& grid, std::size_t n) const {
    const Row& row = rows_[n];
    return {grid.start(row.cells + static_cast<std::size_t>(low_[n])) + row.gap,
            grid.start(row.cells + static_cast<std::size_t>(high_[n] + 1)) + row.gap};
  }

 private:
  static constexpr double rounding = 1e-6;  // far more than that of a coordinate, in cells and in reaches
  struct Row {
    std::size_t cells;  // its first one
    std::uint32_t gap;  // slot of a particle less its index
  };
  Vec<D, int> row_;
  double highest_ = 0.0;  // cell along x
  std::vector<Row> rows_;
  std::array<std::vector<double>, D> borders_;  // the lower ones of each row, from those of the own one
  std::vector<std::int32_t> low_, high_;        // cells along x
};

}  // namespace mappm
