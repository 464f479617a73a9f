// Multi-level cells for bodies of different sizes: each body is registered on the coarsest mesh whose cells are not
// larger than its radius, and looks for partners on every mesh (Tang et al. 2004, section 2.1).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/vec.hpp"

namespace mappm {

template <int D>
class CellLevels {
 public:
  /// A region [low, high] in any unit of length, and the largest radius that will be registered.
  CellLevels(const Vec<D, double>& low, const Vec<D, double>& high, double largest_radius, double smallest_radius)
      : low_(low), high_(high) {
    for (double mesh = largest_radius;; mesh *= 0.5) {
      levels_.push_back(make_level(mesh));
      if (mesh <= smallest_radius) break;
    }
  }

  /// Number of meshes, and the one on which a body of this radius is registered.
  int level_count() const { return static_cast<int>(levels_.size()); }
  int level_of(double radius) const {
    for (int level = 0; level < level_count(); ++level)
      if (levels_[static_cast<std::size_t>(level)].mesh <= radius) return level;
    return level_count() - 1;
  }

  void clear() {
    for (Level& level : levels_) {
      for (const std::size_t cell : level.used) level.cells[cell].clear();
      level.used.clear();
      level.largest_radius = 0.0;
    }
  }

  void add(std::uint32_t body, const Vec<D, double>& x, double radius) {
    Level& level = levels_[static_cast<std::size_t>(level_of(radius))];
    Vec<D, int> cell;
    for (int axis = 0; axis < D; ++axis) cell[axis] = coordinate(level, axis, x[axis]);
    const std::size_t flat = index(level, cell);
    if (level.cells[flat].empty()) level.used.push_back(flat);
    level.cells[flat].push_back(body);
    level.largest_radius = std::max(level.largest_radius, radius);
  }

  /// Visits every body that may be nearer to x than `radius` plus its own radius plus `gap`; may visit others too.
  template <class Visit>
  void for_each_near(const Vec<D, double>& x, double radius, double gap, Visit&& visit) const {
    for (const Level& level : levels_) {
      if (level.largest_radius == 0.0) continue;
      const double reach = radius + level.largest_radius + gap;
      Vec<D, int> first, last;
      for (int axis = 0; axis < D; ++axis) {
        first[axis] = coordinate(level, axis, x[axis] - reach);
        last[axis] = coordinate(level, axis, x[axis] + reach);
      }
      Vec<D, int> cell = first;
      while (cell[D - 1] <= last[D - 1]) {
        for (const std::uint32_t body : level.cells[index(level, cell)]) visit(body);
        for (int axis = 0; axis < D; ++axis) {
          if (++cell[axis] <= last[axis] || axis == D - 1) break;
          cell[axis] = first[axis];
        }
      }
    }
  }

 private:
  static constexpr double most_cells = 1 << 18;

  struct Level {
    double mesh = 0.0;
    double largest_radius = 0.0;  // of the bodies registered now
    Vec<D, int> count;
    std::vector<std::vector<std::uint32_t>> cells;
    std::vector<std::size_t> used;  // cells that hold bodies now
  };

  /// Cells as wide as the mesh, or wider where there would be more than `most_cells` of them: a body may be registered
  /// in a cell of any width, only the visits grow.
  Level make_level(double mesh) const {
    Level level;
    level.mesh = mesh;
    double cells = 0.0;
    for (double width = mesh; cells == 0.0 || cells > most_cells; width *= 2.0) {
      cells = 1.0;
      for (int axis = 0; axis < D; ++axis) {
        const double along = std::max(1.0, std::ceil((high_[axis] - low_[axis]) / width));
        level.count[axis] = static_cast<int>(std::min(along, 2.0 * most_cells));
        cells *= along;
      }
    }
    level.cells.resize(static_cast<std::size_t>(cells));
    return level;
  }
  int coordinate(const Level& level, int axis, double x) const {
    const double cell = (x - low_[axis]) / (high_[axis] - low_[axis]) * level.count[axis];
    return std::clamp(static_cast<int>(std::floor(cell)), 0, level.count[axis] - 1);
  }
  std::size_t index(const Level& level, const Vec<D, int>& cell) const {
    std::size_t flat = 0;
    for (int axis = D - 1; axis >= 0; --axis)
      flat = flat * static_cast<std::size_t>(level.count[axis]) + static_cast<std::size_t>(cell[axis]);
    return flat;
  }

  Vec<D, double> low_, high_;
  std::vector<Level> levels_;
};

}  // namespace mappm
