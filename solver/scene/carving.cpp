#include "scene/carving.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace mappm {

namespace {

/// Within `reach` of a point.
template <int D>
Span span_around(const Lattice<D>& lattice, int axis, double x, double reach) {
  const double centre = x / box_quanta * static_cast<double>(lattice.count[axis]);
  const double half = reach / lattice.spacing[axis] + 1.0;
  const auto count = static_cast<std::int64_t>(lattice.count[axis]);
  const Span span{static_cast<std::int64_t>(std::floor(centre - half)),
                  static_cast<std::int64_t>(std::floor(centre + half))};
  return span.last - span.first < count ? span : Span{0, count - 1};
}

/// Calls f(node) for every node of the spans that lies in the range, indices wrapped into the box.
template <int D, class F>
void for_each_node(const Lattice<D>& lattice, const std::array<Span, D>& spans, const NodeRange<D>& range, F&& f) {
  std::array<std::vector<std::uint64_t>, D> indices;
  for (int axis = 0; axis < D; ++axis) {
    const auto count = static_cast<std::int64_t>(lattice.count[axis]);
    for (std::int64_t i = spans[axis].first; i <= spans[axis].last; ++i) {
      const auto wrapped = static_cast<std::uint64_t>((i % count + count) % count);
      if (wrapped >= range.first[axis] && wrapped < range.last[axis]) indices[axis].push_back(wrapped);
    }
  }
  std::array<std::uint64_t, D> node{};
  const auto rows = [&](const auto& self, int axis) -> void {
    for (const std::uint64_t i : indices[axis]) {
      node[axis] = i;
      if (axis == 0)
        f(node);
      else
        self(self, axis - 1);
    }
  };
  rows(rows, D - 1);
}

/// Ascending, each once.
std::vector<std::uint64_t> as_set(std::vector<std::uint64_t>&& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return std::move(ids);
}

}  // namespace

template <int D>
double solid_volume(const Scene& scene, const Model<D>& model, const std::vector<PlacedSolid<D>>& solids) {
  double volume = 0.0;
  for (const BodyScene& wall : scene.bodies) {
    if (!is_wall(wall)) continue;
    double layer = wall.thickness / scene.fluid.cutoff;
    for (int axis = 0; axis < D; ++axis) {
      const WallSide side = side_of(scene, wall, axis);
      if (axis != wall.axis) layer *= side.whole ? model.box[axis] : side.length / scene.fluid.cutoff;
    }
    volume += layer;
  }
  for (const PlacedSolid<D>& solid : solids)
    if (!is_wall(scene.bodies[solid.body])) volume += model.shapes[solid.shape].volume;
  return volume;
}

template <int D>
std::uint64_t kept_nodes(const Lattice<D>& lattice, double volume_of_solids) {
  const std::uint64_t all = lattice.whole().size();
  const auto removed = static_cast<std::uint64_t>(std::floor(volume_of_solids / lattice.cell_volume() + 0.5));
  return removed < all ? all - removed : 0;
}

/// The cells of the nodes within half a cell diagonal outside a surface cover the solid, those as far inside lie in
/// it; so the number asked for is reached within three quarters of a diagonal.
template <int D>
Carving<D>::Carving(const Scene& scene, const Model<D>& model, const Lattice<D>& lattice,
                    const std::vector<PlacedSolid<D>>& solids)
    : scene_(scene),
      model_(model),
      lattice_(lattice),
      solids_(solids),
      band_(0.75 * std::sqrt(dot(lattice.spacing, lattice.spacing))),
      last_removed_(-HUGE_VAL, 0) {
  const std::uint64_t all = lattice.whole().size();
  std::uint64_t wanted = all - kept_nodes(lattice, solid_volume(scene, model, solids));
  std::vector<Ranked> near;
  visit(lattice.whole(), band_, [&](double distance, std::uint64_t id) {
    if (distance >= -band_)
      near.emplace_back(distance, id);
    else
      --wanted;
  });
  std::sort(near.begin(), near.end(), [](const Ranked& a, const Ranked& b) {
    return a.second != b.second ? a.second < b.second : a.first < b.first;
  });
  near.erase(
      std::unique(near.begin(), near.end(), [](const Ranked& a, const Ranked& b) { return a.second == b.second; }),
      near.end());
  assert(wanted <= near.size());
  if (wanted == 0) return;
  const auto nth = near.begin() + static_cast<std::ptrdiff_t>(wanted - 1);
  std::nth_element(near.begin(), nth, near.end());
  last_removed_ = *nth;
}

template <int D>
std::vector<std::uint64_t> Carving<D>::removed(const NodeRange<D>& range) const {
  std::vector<std::uint64_t> ids;
  visit(range, band_, [&](double distance, std::uint64_t id) {
    if (distance < -band_ || Ranked{distance, id} <= last_removed_) ids.push_back(id);
  });
  return as_set(std::move(ids));
}

template <int D>
std::vector<std::uint64_t> Carving<D>::nearer_than(double distance, const NodeRange<D>& range) const {
  std::vector<std::uint64_t> ids;
  visit(range, distance, [&](double, std::uint64_t id) { ids.push_back(id); });
  return as_set(std::move(ids));
}

template <int D>
template <class F>
void Carving<D>::visit(const NodeRange<D>& range, double band, F&& f) const {
  for (const BodyScene& body : scene_.bodies)
    if (is_wall(body)) visit_wall(body, range, band, f);
  for (const PlacedSolid<D>& solid : solids_)
    if (!is_wall(scene_.bodies[solid.body])) visit_balls(solid, range, band, f);
}

template <int D>
template <class F>
void Carving<D>::visit_balls(const PlacedSolid<D>& solid, const NodeRange<D>& range, double band, F&& f) const {
  const Shape<D>& shape = model_.shapes[solid.shape];
  std::array<Span, D> spans;
  for (int axis = 0; axis < D; ++axis) spans[axis] = span_around(lattice_, axis, solid.x[axis], shape.reach + band);
  std::vector<Vec<D, double>> centres;
  for (const Ball<D>& ball : shape.balls) {
    Vec<D, double> centre;
    for (int axis = 0; axis < D; ++axis)
      centre[axis] = wrap_position(solid.x[axis] +
                                   static_cast<double>(to_fixed_wide(ball.offset[axis] / model_.pair.length[axis])));
    centres.push_back(centre);
  }
  for_each_node<D>(lattice_, spans, range, [&](const std::array<std::uint64_t, D>& node) {
    Vec<D, double> x;
    for (int axis = 0; axis < D; ++axis) x[axis] = lattice_.position(axis, node[axis]);
    double distance = HUGE_VAL;
    for (std::size_t ball = 0; ball < centres.size(); ++ball) {
      Vec<D, double> r;
      for (int axis = 0; axis < D; ++axis)
        r[axis] = nearest_difference(x[axis], centres[ball][axis]) * model_.pair.length[axis];
      distance = std::min(distance, std::sqrt(dot(r, r)) - shape.balls[ball].radius);
    }
    if (distance < band) f(distance, lattice_.id(node));
  });
}

/// A limited wall holds whole rows of nodes; those beyond its ends lie in the walls that close it.
template <int D>
Span Carving<D>::span_along(const BodyScene& wall, int axis, const NodeRange<D>& range) const {
  const WallSide side = side_of(scene_, wall, axis);
  if (side.whole)
    return {static_cast<std::int64_t>(range.first[axis]), static_cast<std::int64_t>(range.last[axis]) - 1};
  const double cell = lattice_.spacing[axis] * scene_.fluid.cutoff;
  return {static_cast<std::int64_t>(side.first / cell + 0.5),
          static_cast<std::int64_t>((side.first + side.length) / cell + 0.5) - 1};
}

template <int D>
template <class F>
void Carving<D>::visit_wall(const BodyScene& wall, const NodeRange<D>& range, double band, F&& f) const {
  const double middle = wall_middle(scene_, wall);
  const double half = 0.5 * wall.thickness / scene_.fluid.cutoff;
  std::array<Span, D> spans;
  for (int axis = 0; axis < D; ++axis)
    spans[axis] = axis == wall.axis ? span_around(lattice_, axis, middle, half + band) : span_along(wall, axis, range);
  for_each_node<D>(lattice_, spans, range, [&](const std::array<std::uint64_t, D>& node) {
    const double r = nearest_difference(lattice_.position(wall.axis, node[wall.axis]), middle);
    const double distance = std::fabs(r * model_.pair.length[wall.axis]) - half;
    if (distance < band) f(distance, lattice_.id(node));
  });
}

template double solid_volume(const Scene&, const Model<2>&, const std::vector<PlacedSolid<2>>&);
template double solid_volume(const Scene&, const Model<3>&, const std::vector<PlacedSolid<3>>&);
template std::uint64_t kept_nodes(const Lattice<2>&, double);
template std::uint64_t kept_nodes(const Lattice<3>&, double);
template class Carving<2>;
template class Carving<3>;

}  // namespace mappm
