#include "scene/walls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.hpp"

namespace mappm {

namespace {

/// Surfaces nearer than this, in spacings, touch: declared numbers are rounded.
constexpr double touch = 1e-6;

constexpr std::size_t at(int axis) { return static_cast<std::size_t>(axis); }

double nearest_image(double difference, double side) { return difference - side * std::floor(difference / side + 0.5); }

double distance_of_middles(const Scene& scene, const WallSide& a, const WallSide& b, int axis) {
  return std::fabs(nearest_image(a.first + 0.5 * a.length - (b.first + 0.5 * b.length), scene.box[at(axis)]));
}

bool overlap(const Scene& scene, const BodyScene& a, const BodyScene& b) {
  for (int axis = 0; axis < scene.dimension; ++axis) {
    const WallSide one = side_of(scene, a, axis), other = side_of(scene, b, axis);
    if (one.whole || other.whole) continue;
    if (distance_of_middles(scene, one, other, axis) > 0.5 * (one.length + other.length) - touch * scene.fluid.spacing)
      return false;
  }
  return true;
}

/// Whether `b` covers the end of `a` along an extent of it, the upper one or the lower.
bool closes(const Scene& scene, const BodyScene& a, const BodyScene::Extent& extent, const BodyScene& b, bool upper) {
  const double tolerance = touch * scene.fluid.spacing;
  const int along = extent.axis;
  for (int axis = 0; axis < scene.dimension; ++axis) {
    const WallSide one = side_of(scene, a, axis), other = side_of(scene, b, axis);
    if (axis == along) {
      const double end = upper ? extent.to : extent.from;
      const double face = upper ? other.first : other.first + other.length;
      if (other.whole || std::fabs(nearest_image(end - face, scene.box[at(axis)])) > tolerance) return false;
    } else if (!other.whole && (one.whole || distance_of_middles(scene, one, other, axis) >
                                                 0.5 * (other.length - one.length) + tolerance)) {
      return false;
    }
  }
  return true;
}

void check_ends(const Scene& scene, const BodyScene& wall, const BodyScene::Extent& extent) {
  for (const bool upper : {false, true}) {
    const auto closed = [&](const BodyScene& other) {
      return is_wall(other) && &other != &wall && closes(scene, wall, extent, other, upper);
    };
    if (std::any_of(scene.bodies.begin(), scene.bodies.end(), closed)) continue;
    throw InputError(scene.file, extent.key + (upper ? ".to" : ".from"),
                     fmt::format("{}", upper ? extent.to : extent.from),
                     "this end of the wall is open to the fluid; let it touch one wall that covers it");
  }
}

}  // namespace

WallSide side_of(const Scene& scene, const BodyScene& wall, int axis) {
  if (axis == wall.axis) return {wall.position, wall.thickness, false};
  if (const BodyScene::Extent* extent = extent_along(wall, axis))
    return {extent->from, extent->to - extent->from, false};
  return {0.0, scene.box[at(axis)], true};
}

double distance_to_wall(const Scene& scene, const BodyScene& wall, const Triple& x) {
  const auto distance = [&](int axis) {
    const WallSide side = side_of(scene, wall, axis);
    const double middle = side.first + 0.5 * side.length;
    return std::fabs(nearest_image(x[at(axis)] - middle, scene.box[at(axis)])) - 0.5 * side.length;
  };
  double inside = distance(wall.axis);
  double outside = std::max(inside, 0.0);
  for (const BodyScene::Extent& extent : wall.extents) {
    const double beyond = distance(extent.axis);
    inside = std::max(inside, beyond);
    outside = std::hypot(outside, std::max(beyond, 0.0));
  }
  return inside > 0.0 ? outside : inside;
}

const BodyScene::Extent* extent_along(const BodyScene& wall, int axis) {
  for (const BodyScene::Extent& extent : wall.extents)
    if (extent.axis == axis) return &extent;
  return nullptr;
}

std::uint64_t lattice_nodes(const Scene& scene, int axis) {
  const double nodes = std::floor(scene.box[at(axis)] / scene.fluid.spacing + 0.5);
  return static_cast<std::uint64_t>(std::clamp(nodes, 1.0, too_many_nodes));
}

bool fits_lattice(const Scene& scene, const BodyScene& wall) {
  for (int axis = 0; axis < scene.dimension; ++axis) {
    const WallSide side = side_of(scene, wall, axis);
    if (side.whole) continue;
    const double cell = scene.box[at(axis)] / static_cast<double>(lattice_nodes(scene, axis));
    for (const double edge : {side.first / cell, (side.first + side.length) / cell})
      if (std::fabs(edge - std::floor(edge + 0.5)) > touch) return false;
  }
  return true;
}

const BodyScene* limited_wall(const Scene& scene) {
  for (const BodyScene& body : scene.bodies)
    if (is_wall(body) && !body.extents.empty()) return &body;
  return nullptr;
}

void check_walls(const Scene& scene) {
  std::vector<const BodyScene*> walls;
  for (const BodyScene& body : scene.bodies)
    if (is_wall(body)) walls.push_back(&body);
  for (std::size_t i = 0; i < walls.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (overlap(scene, *walls[i], *walls[j]))
        throw InputError(scene.file, walls[i]->key + ".position", fmt::format("{}", walls[i]->position),
                         fmt::format("overlaps the wall {}; move one of them or limit one with extent", walls[j]->key));
  const BodyScene* limited = limited_wall(scene);
  if (!limited) return;
  for (const BodyScene* wall : walls)
    if (!fits_lattice(scene, *wall))
      throw InputError(
          scene.file, wall->key, "",
          fmt::format("where a wall is limited ({}.extent), all faces of walls must lie at whole multiples of the "
                      "lattice spacing; move them or change fluid.spacing",
                      limited->key));
  for (const BodyScene* wall : walls)
    for (const BodyScene::Extent& extent : wall->extents) check_ends(scene, *wall, extent);
}

}  // namespace mappm
