#include "scene/solids.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "physics/shape.hpp"

namespace mappm {

namespace {

constexpr std::uint64_t first_face_id = std::uint64_t{1} << 62;

/// Length of a piece of a wall along itself, rcut: wanted, and allowed from half to twice of it.
constexpr double piece_length = 2.5;

/// Number of lattice nodes a piece spans along an axis: the divisor of `count` that comes nearest to `piece_length`
/// (in ratio). A box side shorter than a piece is one piece.
template <int D>
std::uint64_t nodes_per_piece(const Scene& scene, const BodyScene& wall, const Lattice<D>& lattice, int axis) {
  const std::uint64_t count = lattice.count[axis];
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
                   fmt::format("the box has {} lattice nodes along the wall, which do not divide into pieces of about "
                               "{} rcut; change box.size or fluid.spacing so that the number has more divisors",
                               count, piece_length));
}

template <int D>
Shape<D> make_wall_shape(const Scene& scene, const BodyScene& wall, const Model<D>& model, const Lattice<D>& lattice) {
  std::array<double, D> sides{}, spacing{};
  for (int axis = 0; axis < D; ++axis) {
    spacing[axis] = lattice.spacing[axis];
    sides[axis] = axis == wall.axis
                      ? wall.thickness / scene.fluid.cutoff
                      : lattice.spacing[axis] * static_cast<double>(nodes_per_piece(scene, wall, lattice, axis));
  }
  Shape<D> shape;
  with_pair_law(model, [&](auto kernel, auto) {
    shape = make_wall_piece<D, decltype(kernel)>(wall.axis, sides, spacing, {model.spacing, model.rest_density});
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
  Shape<D> shape;
  with_pair_law(model, [&](auto kernel, auto) {
    shape = make_body<D, decltype(kernel)>(balls, density, {model.spacing, model.rest_density});
  });
  shape.rotates = body.rotates;
  return shape;
}

/// Position quanta of a place in scene units, wrapped into the box.
double to_quanta(double place, double side) {
  const double quanta = static_cast<double>(to_fixed_wide(place / side * box_quanta));
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
                std::vector<PlacedSolid<D>>& solids) {
  const BodyScene& wall = scene.bodies[index];
  std::array<std::uint64_t, D> pieces{};
  std::uint64_t total = 1;
  for (int axis = 0; axis < D; ++axis) {
    pieces[axis] = axis == wall.axis ? 1 : lattice.count[axis] / nodes_per_piece(scene, wall, lattice, axis);
    total *= pieces[axis];
  }
  for (std::uint64_t piece = 0; piece < total; ++piece) {
    PlacedSolid<D> solid{static_cast<std::uint32_t>(index), group, 0, {}};
    std::uint64_t rest = piece;
    for (int axis = 0; axis < D; ++axis) {
      solid.x[axis] = axis == wall.axis ? wall_middle(scene, wall) : cell_centre(rest % pieces[axis], pieces[axis]);
      rest /= pieces[axis];
    }
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
  for (const BodyScene& body : scene.bodies) {
    shapes.push_back(is_wall(body) ? make_wall_shape(scene, body, model, lattice)
                                   : make_ball_shape(scene, body, model));
    if (!scene.fluid.particles) shapes.back().frozen.clear();
  }
  return shapes;
}

template <int D>
std::vector<PlacedSolid<D>> place_solids(const Scene& scene, const Model<D>& model, const Lattice<D>& lattice) {
  std::vector<PlacedSolid<D>> solids;
  std::uint32_t group = 0;
  for (std::size_t index = 0; index < scene.bodies.size(); ++index) {
    const BodyScene& body = scene.bodies[index];
    if (is_wall(body)) place_wall(scene, index, lattice, group++, solids);
    for (std::size_t member = 0; member < body.positions.size(); ++member)
      solids.push_back(
          {static_cast<std::uint32_t>(index), group++, member, centre_of_mass(scene, body, member, model)});
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
