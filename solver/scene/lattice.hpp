// The lattice on which PPs start: nodes in the middle of equal cells that divide the box.
#pragma once

#include <array>
#include <cstdint>

#include "base/fixed_point.hpp"
#include "base/vec.hpp"
#include "scene/walls.hpp"

namespace mappm {

/// Position (i + 1/2) / n of the box, rounded once to a quantum; exact where n is a power of two.
inline double cell_centre(std::uint64_t i, std::uint64_t n) {
  __extension__ using Wide = unsigned __int128;
  const Wide doubled = (static_cast<Wide>(2 * i + 1) << 52) + n;
  return static_cast<double>(static_cast<std::uint64_t>(doubled / (2 * static_cast<Wide>(n))));
}

/// Indices first <= i < last on each axis.
template <int D>
struct NodeRange {
  std::array<std::uint64_t, D> first{}, last{};
  std::uint64_t size() const {
    std::uint64_t product = 1;
    for (int axis = 0; axis < D; ++axis) product *= last[axis] - first[axis];
    return product;
  }
};

template <int D>
struct Lattice {
  std::array<std::uint64_t, D> count{};
  Vec<D, double> spacing;  // rcut

  double position(int axis, std::uint64_t i) const { return cell_centre(i, count[axis]); }

  std::uint64_t id(const std::array<std::uint64_t, D>& node) const {
    std::uint64_t index = 0;
    for (int axis = D - 1; axis >= 0; --axis) index = index * count[axis] + node[axis];
    return index;
  }

  NodeRange<D> whole() const {
    NodeRange<D> range;
    range.last = count;
    return range;
  }

  /// The first node at or above x quanta; the number of nodes if there is none.
  std::uint64_t first_at_or_above(int axis, double x) const {
    std::uint64_t low = 0, high = count[axis];
    while (low < high) {
      const std::uint64_t middle = low + (high - low) / 2;
      if (position(axis, middle) < x)
        low = middle + 1;
      else
        high = middle;
    }
    return low;
  }

  double cell_volume() const {
    double volume = 1.0;
    for (int axis = 0; axis < D; ++axis) volume *= spacing[axis];
    return volume;
  }
};

/// As many nodes per side as come nearest to the declared spacing.
template <int D>
Lattice<D> make_lattice(const Scene& scene) {
  Lattice<D> lattice;
  for (int axis = 0; axis < D; ++axis) {
    lattice.count[axis] = lattice_nodes(scene, axis);
    lattice.spacing[axis] =
        scene.box[static_cast<std::size_t>(axis)] / static_cast<double>(lattice.count[axis]) / scene.fluid.cutoff;
  }
  return lattice;
}

}  // namespace mappm
