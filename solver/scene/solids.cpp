#include "scene/solids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "physics/shape.hpp"

namespace mappm {

namespace {

constexpr std::uint64_t first_face_id = std::uint64_t{1} << 62;

/// Length of a piece of a wall along itself, rcut: wanted, and allowed from half to twice of it.
constexpr double piece_length = 2.5;

/// Number of lattice nodes that a wall spans along an axis.
template <int D>
std::uint64_t nodes_of(const Scene& scene, const BodyScene& wall, const Lattice<D>& lattice, int axis) {
  const WallSide side = side_of(scene, wall, axis);
  if (side.whole) return lattice.count[axis];
  const double cell = lattice.spacing[axis] * scene.fluid.cutoff;
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(side.length / cell + 0.5));
}

/// Number of lattice nodes a piece spans along an axis: the divisor of the wall's that comes nearest to `piece_length`
/// (in ratio). A wall shorter than a piece is one piece.
template <int D>
std::uint64_t nodes_per_piece(const Scene& scene, const BodyScene& wall, const Lattice<D>& lattice, int axis) {
  const std::uint64_t count = nodes_of(scene, wall, lattice, axis);
  const auto mismatch = [&](std::uint64_t nodes) {
    const double ratio = static_cast<double>(nodes) * lattice.spacing[axis] / piece_length;
    return ratio < 1.0 ? 1.0 / ratio : ratio;
  };
  std::uint64_t best = count;
  for (std::uint64_t nodes = 1; nodes < count; ++nodes)
    if (count % nodes == 0 && mismatch(nodes) < mismatch(best)) best = nodes;
  if (best < count && mismatch(best) <= 2.0) return best;
  if (static_cast<double>(count) * lattice.spacing[axis] <= 2.0 * piece_length) return count;
  throw InputError(scene.file, wall.key, "",
                   fmt::format("there are {} lattice nodes along the wall, which do not divide into pieces of about "
                               "{} rcut; change box.size or fluid.spacing so that the number has more divisors",
                               count, piece_length));
}

/// Number of pieces of a wall along an axis.
template <int D>
std::uint64_t pieces_of(const Scene& scene, const BodyScene& wall, const Lattice<D>& lattice, int axis) {
  if (axis == wall.axis) return 1;
  return nodes_of(scene, wall, lattice, axis) / nodes_per_piece(scene, wall, lattice, axis);
}

/// What no fluid sees needs no FPs; of a wall without fluid its faces are left, which solids touch.
bool has_pieces(const Scene& scene, const BodyScene& body) { return is_wall(body) && scene.fluid.particles; }

/// Kinds of pieces along an extent of a wall: a first, a last and, between them, a middle one.
template <int D>
std::uint64_t kinds_along(const Scene& scene, const BodyScene& wall, const Lattice<D>& lattice,
                          const BodyScene::Extent& extent) {
  return std::min<std::uint64_t>(3, pieces_of(scene, wall, lattice, extent.axis));
}

/// Kinds of pieces of a wall: one, but for a limited wall. Kinds along its first extent run first.
template <int D>
std::uint64_t kinds_of_pieces(const Scene& scene, const BodyScene& wall, const Lattice<D>& lattice) {
  std::uint64_t kinds = 1;
  if (has_pieces(scene, wall))
    for (const BodyScene::Extent& extent : wall.extents) kinds *= kinds_along(scene, wall, lattice, extent);
  return kinds;
}

/// Piece number `piece` of `pieces` along an extent: 0 the first, 1 the last, 2 one between.
std::uint64_t kind_of_piece(std::uint64_t piece, std::uint64_t pieces) {
  return piece == 0 ? 0 : piece + 1 == pieces ? 1 : 2;
}

template <int D>
Shape<D> make_wall_shape(const Scene& scene, const BodyScene& wall, const Model<D>& model, const Lattice<D>& lattice,
                         std::uint64_t kind) {
  WallEnds<D> ends;
  for (const BodyScene::Extent& extent : wall.extents) {
    const std::uint64_t kinds = kinds_along(scene, wall, lattice, extent);
    ends.below[extent.axis] = kind % kinds == 0;
    ends.above[extent.axis] = kind % kinds == 1 || kinds == 1;
    kind /= kinds;
  }
  FrozenLayer layer{model.spacing, model.rest_density};
  // What is seen of a wall by the FPs of one that touches it lies deeper than what the fluid sees.
  if (limited_wall(scene)) layer.thickness = HUGE_VAL;
  std::array<double, D> sides{}, spacing{};
  for (int axis = 0; axis < D; ++axis) {
    spacing[axis] = lattice.spacing[axis];
    sides[axis] = axis == wall.axis
                      ? wall.thickness / scene.fluid.cutoff
                      : lattice.spacing[axis] * static_cast<double>(nodes_per_piece(scene, wall, lattice, axis));
  }
  Shape<D> shape;
  with_pair_law(model, [&](auto kernel, auto) {
    shape = make_wall_piece<D, decltype(kernel)>(wall.axis, sides, spacing, layer, ends);
  });
  return shape;
}

template <int D>
Shape<D> make_ball_shape(const Scene& scene, const BodyScene& body, const Model<D>& model) {
  const double length = scene.fluid.cutoff;
  std::vector<Ball<D>> balls;
  for (const BallScene& part : body.balls) {
    Ball<D> ball;
    for (int axis = 0; axis < D; ++axis) ball.offset[axis] = part.centre[static_cast<std::size_t>(axis)] / length;
    ball.radius = part.radius / length;
    ball.contact_radius = part.contact_radius / length;
    balls.push_back(ball);
  }
  const double density = body.density / scene.fluid.density * model.rest_density;
  FrozenLayer layer{model.spacing, model.rest_density};
  if (!scene.fluid.particles) layer.thickness = 0.0;
  Shape<D> shape;
  with_pair_law(model, [&](auto kernel, auto) { shape = make_body<D, decltype(kernel)>(balls, density, layer); });
  shape.rotates = body.rotates;
  return shape;
}

/// Position quanta of a position in scene units, wrapped into the box.
double to_quanta(double position, double side) {
  const double quanta = static_cast<double>(to_fixed_wide(position / side * box_quanta));
  return wrap_position(quanta);
}

template <int D>
Vec<D, double> centre_of_mass(const Scene& scene, const BodyScene& body, std::size_t member, const Model<D>& model) {
  Vec<D, double> x;
  const Shape<D>& shape = model.shapes[static_cast<std::size_t>(&body - scene.bodies.data())];
  for (int axis = 0; axis < D; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double shift = body.balls[0].centre[a] / scene.fluid.cutoff - shape.balls[0].offset[axis];
    x[axis] = wrap_position(to_quanta(body.positions[member][a], scene.box[a]) +
                            static_cast<double>(to_fixed_wide(shift / model.pair.length[axis])));
  }
  return x;
}

template <int D>
void place_wall(const Scene& scene, std::size_t index, const Lattice<D>& lattice, std::uint32_t group,
                std::uint32_t further_shapes, std::vector<PlacedSolid<D>>& solids) {
  const BodyScene& wall = scene.bodies[index];
  std::array<std::uint64_t, D> pieces{};
  std::uint64_t total = 1;
  for (int axis = 0; axis < D; ++axis) total *= pieces[axis] = pieces_of(scene, wall, lattice, axis);
  for (std::uint64_t piece = 0; piece < total; ++piece) {
    const auto body = static_cast<std::uint32_t>(index);
    PlacedSolid<D> solid{body, body, group, 0, {}};
    std::uint64_t rest = piece;
    std::uint64_t kind = 0, kinds = 1;
    for (int axis = 0; axis < D; ++axis) {
      const std::uint64_t number = rest % pieces[axis];
      const WallSide side = side_of(scene, wall, axis);
      if (axis == wall.axis)
        solid.x[axis] = wall_middle(scene, wall);
      else if (side.whole)
        solid.x[axis] = cell_centre(number, pieces[axis]);
      else {
        const double part = (static_cast<double>(number) + 0.5) / static_cast<double>(pieces[axis]);
        solid.x[axis] = to_quanta(side.first + part * side.length, scene.box[static_cast<std::size_t>(axis)]);
        kind += kinds * kind_of_piece(number, pieces[axis]);
        kinds *= kinds_along(scene, wall, lattice, *extent_along(wall, axis));
      }
      rest /= pieces[axis];
    }
    if (kind > 0) solid.shape = further_shapes + static_cast<std::uint32_t>(kind - 1);
    solids.push_back(solid);
  }
}

}  // namespace

double wall_middle(const Scene& scene, const BodyScene& wall) {
  return to_quanta(wall.position + 0.5 * wall.thickness, scene.box[static_cast<std::size_t>(wall.axis)]);
}

template <int D>
std::vector<Shape<D>> make_shapes(const Scene& scene, const Model<D>& model, const Lattice<D>& lattice) {
  std::vector<Shape<D>> shapes;
  for (const BodyScene& body : scene.bodies)
    shapes.push_back(has_pieces(scene, body) ? make_wall_shape(scene, body, model, lattice, 0)
                     : is_wall(body)         ? Shape<D>{}
                                             : make_ball_shape(scene, body, model));
  for (const BodyScene& body : scene.bodies)
    for (std::uint64_t kind = 1; kind < kinds_of_pieces(scene, body, lattice); ++kind)
      shapes.push_back(make_wall_shape(scene, body, model, lattice, kind));
  return shapes;
}

template <int D>
std::vector<PlacedSolid<D>> place_solids(const Scene& scene, const Model<D>& model, const Lattice<D>& lattice) {
  std::vector<PlacedSolid<D>> solids;
  std::uint32_t group = 0;
  auto further_shapes = static_cast<std::uint32_t>(scene.bodies.size());
  for (std::size_t index = 0; index < scene.bodies.size(); ++index) {
    const BodyScene& body = scene.bodies[index];
    if (has_pieces(scene, body)) place_wall(scene, index, lattice, group++, further_shapes, solids);
    further_shapes += static_cast<std::uint32_t>(kinds_of_pieces(scene, body, lattice) - 1);
    const auto number = static_cast<std::uint32_t>(index);
    for (std::size_t member = 0; member < body.positions.size(); ++member)
      solids.push_back({number, number, group++, member, centre_of_mass(scene, body, member, model)});
  }
  return solids;
}

template <int D>
std::vector<WallFace<D>> wall_faces(const Scene& scene, const Model<D>& model) {
  std::vector<WallFace<D>> faces;
  for (const BodyScene& wall : scene.bodies) {
    if (!is_wall(wall)) continue;
    const double side = scene.box[static_cast<std::size_t>(wall.axis)];
    for (const double sign : {-1.0, 1.0}) {
      WallFace<D> face;
      face.id = first_face_id + faces.size();
      face.axis = wall.axis;
      face.sign = sign;
      face.thickness = wall.thickness / scene.fluid.cutoff;
      face.x = to_quanta(sign < 0.0 ? wall.position : wall.position + wall.thickness, side);
      for (int axis = 0; axis < D; ++axis)
        face.velocity[axis] = wall.velocities[0][static_cast<std::size_t>(axis)] / model.units.velocity;
      faces.push_back(face);
    }
  }
  return faces;
}

template std::vector<Shape<2>> make_shapes(const Scene&, const Model<2>&, const Lattice<2>&);
template std::vector<Shape<3>> make_shapes(const Scene&, const Model<3>&, const Lattice<3>&);
template std::vector<PlacedSolid<2>> place_solids(const Scene&, const Model<2>&, const Lattice<2>&);
template std::vector<PlacedSolid<3>> place_solids(const Scene&, const Model<3>&, const Lattice<3>&);
template std::vector<WallFace<2>> wall_faces(const Scene&, const Model<2>&);
template std::vector<WallFace<3>> wall_faces(const Scene&, const Model<3>&);

}  // namespace mappm
