#include "scene/packing.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "scene/obstacles.hpp"

namespace mappm {

namespace {

constexpr int tries_per_solid = 20000;

/// Uniform in [0, 1): the standard distributions differ from library to library.
double uniform(std::mt19937_64& generator) { return static_cast<double>(generator() >> 11) * 0x1p-53; }

}  // namespace

double bounding_radius(const BodyScene& body) {
  double largest = 0.0;
  for (const BallScene& ball : body.balls) {
    double square = 0.0;
    for (const double x : ball.centre) square += x * x;
    largest = std::max(largest, std::sqrt(square) + std::max(ball.radius, ball.contact_radius));
  }
  return largest;
}

std::size_t place_at_random(const Packing& packing, Scene& scene) {
  double largest = 0.0;
  for (const BodyScene& body : scene.bodies) largest = std::max(largest, bounding_radius(body));
  Obstacles obstacles(scene, largest, packing.gap);
  for (std::size_t body = 0; body < scene.bodies.size(); ++body)
    for (std::size_t member = 0; member < scene.bodies[body].positions.size(); ++member)
      for (std::size_t ball = 0; ball < scene.bodies[body].balls.size(); ++ball)
        obstacles.add(placed_ball(scene, body, member, ball));

  std::mt19937_64 generator(packing.seed);
  std::vector<Triple>& positions = scene.bodies[packing.body].positions;
  while (positions.size() < packing.count) {
    PlacedBall candidate{{}, bounding_radius(scene.bodies[packing.body]), packing.body, positions.size()};
    bool placed = false;
    for (int attempt = 0; attempt < tries_per_solid && !placed; ++attempt) {
      for (std::size_t axis = 0; axis < static_cast<std::size_t>(scene.dimension); ++axis)
        candidate.centre[axis] = scene.box[axis] * uniform(generator);
      placed = !obstacles.ball_near(candidate, packing.gap) && !obstacles.wall_near(candidate, packing.gap);
    }
    if (!placed) break;
    obstacles.add(candidate);
    positions.push_back(candidate.centre);
  }
  return positions.size();
}

}  // namespace mappm
