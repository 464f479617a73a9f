// The solids of a scene: their shapes, and where each stands at the start. Private to the builder.
#pragma once

#include <cstdint>
#include <vector>

#include "particles/model.hpp"
#include "scene/lattice.hpp"
#include "scene/scene.hpp"

namespace mappm {

/// One solid at its place. A wall is cut into pieces of one shape, all of one group.
template <int D>
struct PlacedSolid {
  std::uint32_t body = 0;   // index in the scene
  std::uint32_t shape = 0;  // the same, but for pieces of a limited wall after its first
  std::uint32_t group = 0;
  std::size_t member = 0;  // index into the body's velocities
  Vec<D, double> x;        // centre of mass, position quanta
};

/// One shape per body of the scene, then those of the other pieces of limited walls. Of `model` it reads box, kernel,
/// rest_density and spacing. Throws InputError if a wall cannot be cut into equal pieces.
template <int D>
std::vector<Shape<D>> make_shapes(const Scene& scene, const Model<D>& model, const Lattice<D>& lattice);

/// All solids of the box, in the order of their ids. Reads also model.shapes.
template <int D>
std::vector<PlacedSolid<D>> place_solids(const Scene& scene, const Model<D>& model, const Lattice<D>& lattice);

/// Two faces per wall; ids above those of all solids. Reads also model.units.velocity.
template <int D>
std::vector<WallFace<D>> wall_faces(const Scene& scene, const Model<D>& model);

/// Middle plane of a wall, position quanta.
double wall_middle(const Scene& scene, const BodyScene& wall);

}  // namespace mappm
