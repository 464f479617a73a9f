#include "scene/bodies.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>

#include "scene/packing.hpp"

namespace mappm {

namespace {

using Shape = BodyScene::Shape;

constexpr std::size_t most_solids = 10'000'000;  // of one [[body]]
constexpr double extent_rounding = 1e-6;  // spacings, of an end of a wall that is to lie at the border of the box

Shape read_shape(const Fields& table) {
  const bool plane = table.source().dimension == 2;
  const std::string shape = table.word("shape");
  if (plane && shape == "sphere") table.fail("shape", "the box has two sides; write \"disc\" or give it a third");
  if (!plane && shape == "disc") table.fail("shape", "the box has three sides; write \"sphere\"");
  return table.choice<Shape>(
      "shape",
      {{"disc", Shape::ball}, {"sphere", Shape::ball}, {"composite", Shape::composite}, {"wall", Shape::wall}});
}

BallScene read_ball(const Fields& table) {
  BallScene ball;
  ball.radius = table.number("radius", Quantity::length, Sign::positive);
  ball.contact_radius = table.number("contact_radius", Quantity::length, Sign::positive, ball.radius);
  return ball;
}

std::vector<BallScene> read_composite(const Fields& table) {
  std::vector<BallScene> balls;
  for (const Fields& part : table.tables("balls")) {
    BallScene ball = read_ball(part);
    ball.centre = part.vector("centre", Quantity::length);
    part.finish();
    balls.push_back(ball);
  }
  if (balls.empty()) table.fail("balls", "missing or empty; write balls = [{centre = [..], radius = ..}, ...]");
  return balls;
}

/// An evenly spaced matrix over the box, by default with a margin of half a spacing.
std::vector<Triple> read_array(const Fields& table, const Scene& scene) {
  const Triple count = table.vector("count", Quantity::plain);
  double solids = 1.0;
  Triple spacing{}, offset{};
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(scene.dimension); ++axis) {
    if (count[axis] < 1.0 || count[axis] != std::floor(count[axis]))
      table.fail("count", "must be whole numbers of at least 1, one per axis");
    solids *= count[axis];
    if (solids > static_cast<double>(most_solids))
      table.fail("count", fmt::format("makes more than {} solids", most_solids));
    spacing[axis] = scene.box[axis] / count[axis];
    offset[axis] = 0.5 * spacing[axis];
  }
  offset = table.vector("offset", Quantity::length, offset);
  table.finish();
  std::vector<Triple> positions;
  const double layers = scene.dimension == 3 ? count[2] : 1.0;
  for (double k = 0.0; k < layers; ++k)
    for (double j = 0.0; j < count[1]; ++j)
      for (double i = 0.0; i < count[0]; ++i)
        positions.push_back({offset[0] + i * spacing[0], offset[1] + j * spacing[1], offset[2] + k * spacing[2]});
  return positions;
}

std::optional<Packing> read_random(const Fields& body, std::size_t index) {
  const std::optional<Fields> table = body.table("random");
  if (!table) return {};
  Packing packing;
  packing.body = index;
  packing.count = table->count("count");
  packing.seed = table->count("seed");
  packing.gap = table->number("gap", Quantity::length, Sign::not_negative, 0.0);
  if (packing.count == 0) table->fail("count", "must be at least 1; write the number of solids");
  if (packing.count > most_solids) table->fail("count", fmt::format("must be at most {}", most_solids));
  table->finish();
  return packing;
}

void read_positions(const Fields& table, const Scene& scene, BodyScene& body) {
  int given = 0;
  for (const char* key : {"position", "positions", "array", "random"}) given += table.has(key) ? 1 : 0;
  if (given == 0) table.fail("position", "missing; give one of position, positions, array, random");
  if (given > 1) table.fail("position", "given twice; keep one of position, positions, array, random");
  if (table.has("position")) body.positions = {table.vector("position", Quantity::length)};
  if (table.has("positions")) body.positions = table.vectors("positions", Quantity::length);
  if (const auto array = table.table("array")) body.positions = read_array(*array, scene);
  const char* key = table.has("position") ? "position" : table.has("positions") ? "positions" : "array";
  for (const Triple& x : body.positions)
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(scene.dimension); ++axis)
      if (x[axis] < 0.0 || x[axis] >= scene.box[axis])
        table.fail(key, fmt::format("{} lies outside the box [0, {}); move it inside", x[axis], scene.box[axis]));
}

Triple read_angular_velocity(const Fields& table) {
  if (table.source().dimension == 3) return table.vector("angular_velocity", Quantity::angular_velocity, {});
  return {0.0, 0.0, table.number("angular_velocity", Quantity::angular_velocity, Sign::any, 0.0)};
}

/// Velocities of all solids of a body; `count` of them.
void read_velocities(const Fields& table, std::size_t count, BodyScene& body) {
  for (const char* key : {"velocity", "first_velocity", "angular_velocity"})
    if (body.motion == Motion::fixed && table.has(key))
      table.fail(key, "a fixed body has no velocity; remove it or write motion = \"moving\"");
  body.velocities.assign(count, table.vector("velocity", Quantity::velocity, {}));
  body.velocities.front() = table.vector("first_velocity", Quantity::velocity, body.velocities.front());
  if (body.shape == Shape::wall) return;
  body.angular_velocities.assign(count, read_angular_velocity(table));
  body.rotates = table.flag("rotates", body.motion != Motion::fixed);
  if (!body.rotates && table.has("angular_velocity"))
    table.fail("angular_velocity", "the body does not rotate; remove it or write rotates = true");
  if (body.rotates && body.motion == Motion::fixed)
    table.fail("rotates", "a fixed body cannot rotate; remove it or change the motion");
}

BodyScene::Extent read_extent(const Fields& table, const Scene& scene, int normal) {
  BodyScene::Extent extent;
  extent.key = table.path("");
  extent.key.pop_back();
  extent.axis = table.axis("axis");
  extent.from = table.number("from", Quantity::length, Sign::not_negative);
  extent.to = table.number("to", Quantity::length, Sign::positive);
  table.finish();
  if (extent.axis == normal) table.fail("axis", "is the wall's normal; write an axis along the wall");
  if (extent.from >= extent.to) table.fail("from", fmt::format("must be less than to = {}", extent.to));
  const double side = scene.box[static_cast<std::size_t>(extent.axis)];
  if (extent.to > side + extent_rounding * scene.fluid.spacing)
    table.fail("to", fmt::format("lies outside the box [0, {}]; a wall cannot go on across its border", side));
  return extent;
}

/// One table, or a list of them. An extent that fills the box is none.
std::vector<BodyScene::Extent> read_extents(const Fields& wall, const Scene& scene, int normal) {
  std::array<std::optional<BodyScene::Extent>, 3> along;
  for (const Fields& table : wall.table_or_tables("extent")) {
    const BodyScene::Extent extent = read_extent(table, scene, normal);
    std::optional<BodyScene::Extent>& known = along[static_cast<std::size_t>(extent.axis)];
    if (known) table.fail("axis", "limits the wall along one axis twice; keep one of the two tables");
    known = extent;
  }
  const double rounding = extent_rounding * scene.fluid.spacing;
  std::vector<BodyScene::Extent> extents;
  for (std::size_t axis = 0; axis < along.size(); ++axis)
    if (along[axis] && (along[axis]->from > rounding || along[axis]->to < scene.box[axis] - rounding))
      extents.push_back(*along[axis]);
  return extents;
}

void read_wall(const Fields& table, const Scene& scene, BodyScene& body) {
  body.axis = table.axis("axis", scene.dimension - 1);
  body.position = table.number("position", Quantity::length, Sign::not_negative);
  body.thickness = table.number("thickness", Quantity::length, Sign::positive);
  const auto axis = static_cast<std::size_t>(body.axis);
  if (body.position >= scene.box[axis])
    table.fail("position", fmt::format("lies outside the box [0, {}); move it inside", scene.box[axis]));
  if (body.thickness >= scene.box[axis])
    table.fail("thickness", fmt::format("fills the box side {}; make the wall thinner", scene.box[axis]));
  body.extents = read_extents(table, scene, body.axis);
  read_velocities(table, 1, body);
  if (body.velocities.front()[axis] != 0.0)
    table.fail("velocity", "a wall moves along itself only; set its normal component to 0");
  for (const BodyScene::Extent& extent : body.extents)
    if (body.velocities.front()[static_cast<std::size_t>(extent.axis)] != 0.0)
      table.fail("velocity", "a wall does not move along its extent; set that component to 0");
}

BodyScene read_body(const Fields& table, const Scene& scene, std::optional<Packing>& packing) {
  BodyScene body;
  body.key = table.path("");
  body.key.pop_back();
  body.shape = read_shape(table);
  const bool wall = body.shape == Shape::wall;
  const Fields::Names<Motion> motions{{"free", Motion::free}, {"fixed", Motion::fixed}, {"moving", Motion::moving}};
  body.motion = table.choice("motion", motions, wall ? Motion::fixed : Motion::free);
  if (wall) {
    if (body.motion == Motion::free) table.fail("motion", "a wall cannot be free; write \"fixed\" or \"moving\"");
    read_wall(table, scene, body);
  } else {
    body.balls = body.shape == Shape::ball ? std::vector{read_ball(table)} : read_composite(table);
    body.density = body.motion == Motion::free
                       ? table.number("density", Quantity::density, Sign::positive)
                       : table.number("density", Quantity::density, Sign::positive, scene.fluid.density);
    read_positions(table, scene, body);
    packing = read_random(table, static_cast<std::size_t>(scene.bodies.size()));
    read_velocities(table, packing ? packing->count : body.positions.size(), body);
  }
  table.finish();
  return body;
}

}  // namespace

void read_bodies(const std::vector<Fields>& tables, Scene& scene) {
  std::vector<std::pair<const Fields*, Packing>> packings;
  for (const Fields& table : tables) {
    std::optional<Packing> packing;
    scene.bodies.push_back(read_body(table, scene, packing));
    if (packing) packings.emplace_back(&table, *packing);
  }
  for (const auto& [table, packing] : packings) {  // after all that have a place of their own
    const std::size_t placed = place_at_random(packing, scene);
    if (placed < packing.count)
      table->fail("random", fmt::format("only {} of {} solids fit; ask for fewer or smaller ones, a smaller gap, or "
                                        "another seed",
                                        placed, packing.count));
  }
}

}  // namespace mappm
