// Random packings: solids that do not overlap, one after the other, from a seed.
#pragma once

#include <cstdint>

#include "scene/scene.hpp"

namespace mappm {

struct Packing {
  std::size_t body = 0;  // index in the scene
  std::size_t count = 0;
  std::uint64_t seed = 0;
  double gap = 0.0;  // kept between surfaces
};

/// Radius of the ball about the origin of a body's frame that holds all its balls.
double bounding_radius(const BodyScene& body);

/// Places `packing.count` solids clear of all that are placed already, of walls, and of each other: random sequential
/// addition. Returns how many fitted within the tries; the same on every machine (Mersenne twister, + - * / sqrt).
std::size_t place_at_random(const Packing& packing, Scene& scene);

}  // namespace mappm
