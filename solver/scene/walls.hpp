// Walls as boxes: where each stands, and which sets of walls can be. A wall fills the box along its own plane, or is
// limited along axes of it. Private to reader and builder.
#pragma once

#include "scene/scene.hpp"

namespace mappm {

inline bool is_wall(const BodyScene& body) { return body.shape == BodyScene::Shape::wall; }

/// What a wall fills along an axis, scene units. `whole`: the periodic box side.
struct WallSide {
  double first = 0.0, length = 0.0;
  bool whole = false;
};
WallSide side_of(const Scene& scene, const BodyScene& wall, int axis);

/// Distance of a point to a wall's surface, by the nearest image: negative inside.
double distance_to_wall(const Scene& scene, const BodyScene& wall, const Triple& x);

/// More nodes than can be numbered (check_box refuses them), and few enough for a 64-bit integer.
inline constexpr double too_many_nodes = 0x1p51;

/// Nodes of the start's lattice along a side of the box: as many as come nearest to the declared spacing.
std::uint64_t lattice_nodes(const Scene& scene, int axis);

/// Whether all surfaces of a wall lie between two rows of nodes.
bool fits_lattice(const Scene& scene, const BodyScene& wall);

/// Its extent along an axis, or null.
const BodyScene::Extent* extent_along(const BodyScene& wall, int axis);

/// The first limited wall, or null.
const BodyScene* limited_wall(const Scene& scene);

/// Throws InputError if walls overlap; in a scene with a limited wall also if one does not fit the lattice, or if an
/// end of a limited wall is not closed by another wall.
void check_walls(const Scene& scene);

}  // namespace mappm
