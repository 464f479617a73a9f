#include "scene/obstacles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "scene/walls.hpp"

namespace mappm {

namespace {

double nearest_image(double difference, double side) { return difference - side * std::floor(difference / side + 0.5); }

std::string point_text(const Scene& scene, const Triple& x) {
  std::string text;
  for (int axis = 0; axis < scene.dimension; ++axis)
    text += fmt::format("{}{}", text.empty() ? "" : ", ", x[static_cast<std::size_t>(axis)]);
  return "[" + text + "]";
}

}  // namespace

PlacedBall placed_ball(const Scene& scene, std::size_t body, std::size_t member, std::size_t ball) {
  const BodyScene& declared = scene.bodies[body];
  const BallScene& part = declared.balls[ball];
  PlacedBall placed{declared.positions[member], std::max(part.radius, part.contact_radius), body, member};
  for (std::size_t axis = 0; axis < 3; ++axis) placed.centre[axis] += part.centre[axis];
  return placed;
}

Obstacles::Obstacles(const Scene& scene, double largest_radius, double gap) : scene_(&scene) {
  double longest = 0.0;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(scene.dimension); ++axis) {
    const double cells = std::floor(scene.box[axis] / (2.0 * largest_radius + gap));
    count_[axis] = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::min(cells, 1e6)));
    longest = std::max(longest, scene.box[axis]);
  }
  tolerance_ = 1e-12 * longest;  // balls declared to touch do not overlap by rounding
}

Obstacles::Cell Obstacles::cell_of(const Triple& x) const {
  Cell cell{};
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(scene_->dimension); ++axis) {
    const double turns = x[axis] / scene_->box[axis];
    const double fraction = turns - std::floor(turns);
    cell[axis] = std::min(static_cast<std::int64_t>(fraction * static_cast<double>(count_[axis])), count_[axis] - 1);
  }
  return cell;
}

std::uint64_t Obstacles::key_of(const Cell& cell) const {
  return static_cast<std::uint64_t>((cell[2] * count_[1] + cell[1]) * count_[0] + cell[0]);
}

double Obstacles::distance(const Triple& a, const Triple& b) const {
  double square = 0.0;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(scene_->dimension); ++axis) {
    const double d = nearest_image(a[axis] - b[axis], scene_->box[axis]);
    square += d * d;
  }
  return std::sqrt(square);
}

void Obstacles::add(const PlacedBall& ball) { cells_[key_of(cell_of(ball.centre))].push_back(ball); }

const PlacedBall* Obstacles::ball_near(const PlacedBall& ball, double gap) const {
  const Cell home = cell_of(ball.centre);
  Cell first{}, last{};  // each cell once, also where an axis has fewer than three
  for (std::size_t axis = 0; axis < 3; ++axis) {
    first[axis] = count_[axis] > 2 ? -1 : 0;
    last[axis] = count_[axis] > 1 ? 1 : 0;
  }
  Cell step{};
  for (step[2] = first[2]; step[2] <= last[2]; ++step[2])
    for (step[1] = first[1]; step[1] <= last[1]; ++step[1])
      for (step[0] = first[0]; step[0] <= last[0]; ++step[0]) {
        Cell cell{};
        for (std::size_t axis = 0; axis < 3; ++axis)
          cell[axis] = (home[axis] + step[axis] + count_[axis]) % count_[axis];
        const auto found = cells_.find(key_of(cell));
        if (found == cells_.end()) continue;
        for (const PlacedBall& other : found->second) {
          if (other.body == ball.body && other.member == ball.member) continue;
          if (distance(ball.centre, other.centre) < ball.radius + other.radius + gap - tolerance_) return &other;
        }
      }
  return nullptr;
}

const BodyScene* Obstacles::wall_near(const PlacedBall& ball, double gap) const {
  for (const BodyScene& body : scene_->bodies)
    if (is_wall(body) && distance_to_wall(*scene_, body, ball.centre) < ball.radius + gap - tolerance_) return &body;
  return nullptr;
}

void check_overlaps(const Scene& scene) {
  check_walls(scene);
  double largest = 0.0;
  std::vector<PlacedBall> balls;
  for (std::size_t body = 0; body < scene.bodies.size(); ++body)
    for (std::size_t member = 0; member < scene.bodies[body].positions.size(); ++member)
      for (std::size_t ball = 0; ball < scene.bodies[body].balls.size(); ++ball) {
        balls.push_back(placed_ball(scene, body, member, ball));
        largest = std::max(largest, balls.back().radius);
      }
  if (balls.empty()) return;
  Obstacles placed(scene, largest, 0.0);
  for (const PlacedBall& ball : balls) {
    const std::string key = scene.bodies[ball.body].key;
    const std::string where = fmt::format("the solid at {}", point_text(scene, ball.centre));
    if (const BodyScene* wall = placed.wall_near(ball, 0.0))
      throw InputError(scene.file, key, "", fmt::format("{} overlaps the wall {}; move it", where, wall->key));
    if (const PlacedBall* other = placed.ball_near(ball, 0.0))
      throw InputError(scene.file, key, "",
                       fmt::format("{} overlaps that at {} of {}; move one of them or make it smaller", where,
                                   point_text(scene, other->centre), scene.bodies[other->body].key));
    placed.add(ball);
  }
}

}  // namespace mappm
