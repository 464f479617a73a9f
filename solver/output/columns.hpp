// One row of a table with its header: names, units and values are given in one place, so they cannot drift apart.
#pragma once

#include <fmt/format.h>

#include <string>

#include "base/fixed_point.hpp"
#include "base/vec.hpp"

namespace mappm {

/// Names of the units in which a scene is given. All empty for a dimensionless one.
struct UnitNames {
  std::string time, length, velocity, angular_velocity, force, energy, angular_momentum;
};

/// SI; in the plane, forces, energies and angular momenta are those per metre of depth.
inline UnitNames si_unit_names(int dimension) {
  if (dimension == 2) return {"s", "m", "m/s", "rad/s", "N/m", "J/m", "kg m/s"};
  return {"s", "m", "m/s", "rad/s", "N", "J", "kg m2/s"};
}

class Columns {
 public:
  /// Numbers are written in the shortest form that reads back to the same value.
  template <class T>
  void add(const std::string& name, const std::string& unit, const T& value) {
    if (!header_.empty()) {
      header_ += ',';
      row_ += ',';
    }
    header_ += unit.empty() ? name : name + " [" + unit + "]";
    row_ += fmt::format("{}", value);
  }
  /// A column an axis; an angular quantity in the plane has one component and no suffix.
  template <int N, class T>
  void add(const std::string& name, const std::string& unit, const Vec<N, T>& value) {
    if constexpr (N == 1) return add(name, unit, value[0]);
    for (int axis = 0; axis < N; ++axis) add(name + "_" + "xyz"[axis], unit, value[axis]);
  }
  const std::string& header() const { return header_; }
  const std::string& row() const { return row_; }

 private:
  std::string header_, row_;
};

}  // namespace mappm
