// Which lattice nodes the solids take: as many as their volume asks for, the deepest first. Private to the builder.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "particles/model.hpp"
#include "scene/lattice.hpp"
#include "scene/solids.hpp"

namespace mappm {

/// Volume of all solids, rcut^D.
template <int D>
double solid_volume(const Scene& scene, const Model<D>& model, const std::vector<PlacedSolid<D>>& solids);

/// Nodes of the box that keep a PP: the fluid's volume over that of a lattice cell, rounded.
template <int D>
std::uint64_t kept_nodes(const Lattice<D>& lattice, double volume_of_solids);

/// Indices of nodes along one axis, as an interval that may stick out of the box on either side; each node at most
/// once.
struct Span {
  std::int64_t first, last;
};

/// Decides over all nodes of the box at once, so that every process finds the same; stores only those near a surface.
template <int D>
class Carving {
 public:
  /// Keeps references to its arguments.
  Carving(const Scene& scene, const Model<D>& model, const Lattice<D>& lattice,
          const std::vector<PlacedSolid<D>>& solids);

  /// Ids of the nodes of `range` that carry no PP, ascending.
  std::vector<std::uint64_t> removed(const NodeRange<D>& range) const;

  /// Ids of the nodes of `range` that lie inside a solid or nearer than `distance` (rcut) to one, ascending.
  std::vector<std::uint64_t> nearer_than(double distance, const NodeRange<D>& range) const;

 private:
  /// A node by its signed distance to the nearest surface (negative inside, rcut), then by its id.
  using Ranked = std::pair<double, std::uint64_t>;

  /// Calls f(distance, id) for each node of the range nearer than `band` to a solid or inside one. A node between
  /// two solids is met once for each.
  template <class F>
  void visit(const NodeRange<D>& range, double band, F&& f) const;
  template <class F>
  void visit_balls(const PlacedSolid<D>& solid, const NodeRange<D>& range, double band, F&& f) const;
  template <class F>
  void visit_wall(const BodyScene& wall, const NodeRange<D>& range, double band, F&& f) const;
  Span span_along(const BodyScene& wall, int axis, const NodeRange<D>& range) const;

  const Scene& scene_;
  const Model<D>& model_;
  const Lattice<D>& lattice_;
  const std::vector<PlacedSolid<D>>& solids_;
  double band_;  // nodes deeper than this are always removed, nodes farther out never
  Ranked last_removed_;
};

}  // namespace mappm
