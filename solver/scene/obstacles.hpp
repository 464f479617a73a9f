// Where solids already are, to find overlaps: used by the random packing and by the check of a scene.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "scene/scene.hpp"

namespace mappm {

/// A ball at its place; `body` and `member` tell which solid it belongs to. Lengths in the scene's unit.
struct PlacedBall {
  Triple centre{};
  double radius = 0.0;
  std::size_t body = 0, member = 0;
};

/// The ball number `ball` of the solid `member` of a body, with the larger of its two radii.
PlacedBall placed_ball(const Scene& scene, std::size_t body, std::size_t member, std::size_t ball);

/// Balls and walls in a periodic box, binned by place.
class Obstacles {
 public:
  /// `largest_radius`: of any ball that is added or asked for; `gap`: the largest that is asked for.
  Obstacles(const Scene& scene, double largest_radius, double gap);

  void add(const PlacedBall& ball);

  /// A ball of another solid that comes nearer to `ball` than `gap`, or null. Periodic images count.
  const PlacedBall* ball_near(const PlacedBall& ball, double gap) const;

  /// A wall that comes nearer than `gap`, or null.
  const BodyScene* wall_near(const PlacedBall& ball, double gap) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const Triple& x) const;
  std::uint64_t key_of(const Cell& cell) const;
  double distance(const Triple& a, const Triple& b) const;

  const Scene* scene_;
  Cell count_{1, 1, 1};
  double tolerance_;
  std::unordered_map<std::uint64_t, std::vector<PlacedBall>> cells_;
};

/// Throws InputError if solids of the scene overlap, or what `check_walls` does.
void check_overlaps(const Scene& scene);

}  // namespace mappm
