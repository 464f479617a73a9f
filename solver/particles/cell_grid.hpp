// Cells of one size over a region and its margin, and the order of particles by cell. Cells are a fraction of the reach
// within which pairs are looked for (several to a reach trim the candidates); rows along x are contiguous in memory.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "particles/state.hpp"

namespace mappm {

template <int D>
class CellGrid {
 public:
  /// About `per_reach` cells to the reach on each axis, at least 1, whose borders fall on those of the region; beyond
  /// it, on each side, as many layers of margin cells as the reach can need. length: of a position quantum in reaches,
  /// per axis.
  void fit(const Region<D>& region, const Vec<D, double>& length, const Vec<D, double>& per_reach) {
    region_ = region;
    std::size_t cells = 1;
    for (int axis = 0; axis < D; ++axis) {
      const double quanta = region.high[axis] - region.low[axis], reaches = quanta * length[axis];
      margin_[axis] = static_cast<int>(std::ceil(per_reach[axis]));
      // Cells of the margin are a little wider than the reach altogether, so that rounding never hides a pair within
      // it.
      const double most = reaches * margin_[axis] * (1.0 - 1e-6);
      inner_[axis] = std::max(1, static_cast<int>(std::min(std::round(reaches * per_reach[axis]), most)));
      scale_[axis] = inner_[axis] / quanta;
      width_[axis] = quanta * length[axis] / inner_[axis];
      count_[axis] = inner_[axis] + 2 * margin_[axis];
      cells *= static_cast<std::size_t>(count_[axis]);
    }
    start_.assign(cells + 1, 0);
  }

  /// Coordinate on one axis, in cells from the start of the margin: where rounding does not matter, its floor is
  /// `coordinate`.
  template <class Real>
  Real fractional_coordinate(int axis, const Real& x) const {
    return (x - region_.low[axis]) * scale_[axis] + static_cast<double>(margin_[axis]);
  }

  /// Cell coordinate on one axis, margin cells included; exact about which side of the region's border x lies on.
  int coordinate(int axis, double x) const {
    int cell = static_cast<int>(std::floor((x - region_.low[axis]) * scale_[axis]));
    cell = x < region_.high[axis] ? std::min(cell, inner_[axis] - 1) : std::max(cell, inner_[axis]);
    return std::clamp(cell + margin_[axis], 0, count_[axis] - 1);
  }
  std::size_t row(const Vec<D, int>& cell) const {
    std::size_t flat = 0;
    for (int axis = D - 1; axis > 0; --axis) flat = flat * static_cast<std::size_t>(count_[axis]) + cell[axis];
    return flat * static_cast<std::size_t>(count_[0]);
  }
  bool is_inner(int axis, int cell) const { return cell >= margin_[axis] && cell < margin_[axis] + inner_[axis]; }

  std::size_t cell_count() const { return start_.size() - 1; }
  /// First particle of a plane, the cells of one coordinate on the slowest axis, or the end of the last plane.
  std::uint32_t plane_start(int coordinate) const {
    return start_[cell_count() / static_cast<std::size_t>(count_[D - 1]) * static_cast<std::size_t>(coordinate)];
  }

  int margin(int axis) const { return margin_[axis]; }
  int count(int axis) const { return count_[axis]; }
  int inner(int axis) const { return inner_[axis]; }
  double width(int axis) const { return width_[axis]; }
  /// Particles of cell c are [start(c), start(c + 1)) after `sort`.
  std::uint32_t start(std::size_t cell) const { return start_[cell]; }

  /// Orders the particles by cell (counting sort).
  void sort(FluidParticles<D>& fluid) {
    const std::size_t particles = fluid.size();
    target_.resize(particles);
    std::fill(start_.begin(), start_.end(), 0u);
    for (std::size_t i = 0; i < particles; ++i) {
      Vec<D, int> cell;
      for (int axis = 0; axis < D; ++axis) cell[axis] = coordinate(axis, fluid.x(axis)[i]);
      const auto index = static_cast<std::uint32_t>(row(cell) + static_cast<std::size_t>(cell[0]));
      target_[i] = index;
      ++start_[index + 1];
    }
    for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
    for (std::size_t i = 0; i < particles; ++i) target_[i] = start_[target_[i]]++;
    for (std::size_t c = start_.size() - 1; c > 0; --c) start_[c] = start_[c - 1];
    start_[0] = 0;
    permute(fluid.id, scratch_id_);
    for (auto& values : fluid.field) permute(values, scratch_);
  }

 private:
  template <class Values>
  void permute(Values& values, Values& scratch) const {
    reserve_tightly(scratch, values.size());
    scratch.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) scratch[target_[i]] = values[i];
    values.swap(scratch);
  }

  Region<D> region_;
  Vec<D, int> margin_, inner_, count_;
  Vec<D, double> scale_, width_;
  std::vector<std::uint32_t> start_, target_;
  Column<double> scratch_;
  std::vector<std::uint64_t> scratch_id_;
};

}  // namespace mappm
