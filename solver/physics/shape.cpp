#include "physics/shape.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "physics/kernel.hpp"
#include "physics/matter.hpp"

namespace mappm {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Of points that lie equally deep in two balls, the first ball's is kept: what counts as equal, rcut.
constexpr double depth_tolerance = 1e-9;

/// A ball farther than this from an FP covers nothing of its kernel's support, rcut.
constexpr double support_and_cell = 1.1;

template <int D>
double ball_volume(double radius) {
  return D == 2 ? pi * radius * radius : 4.0 / 3.0 * pi * radius * radius * radius;
}

template <int D>
Vec<D, double> first_axis() {
  Vec<D, double> unit;
  unit[0] = 1.0;
  return unit;
}

double to_density_quanta(double density) {
  return static_cast<double>(to_fixed_wide(density / density_quantum)) * density_quantum;
}

/// Number of FPs that stand for the ring (shell) from radius - dx/2 to radius + dx/2.
template <int D>
int ring_count(double radius, const FrozenLayer& layer) {
  const double outer = radius + 0.5 * layer.spacing;
  const double inner = std::max(radius - 0.5 * layer.spacing, 0.0);
  const double count = layer.number_density * (ball_volume<D>(outer) - ball_volume<D>(inner));
  return std::max(1, static_cast<int>(std::floor(count + 0.5)));
}

/// FPs of one ball in rings, as if it were alone: own_density is not yet set. A ring of one FP is the centre; a ball
/// smaller than a ring has that one.
template <int D>
std::vector<FrozenParticle<D>> fill_ball(const Ball<D>& ball, const FrozenLayer& layer) {
  std::vector<FrozenParticle<D>> frozen;
  for (int ring = 0;; ++ring) {
    const double depth = (ring + 0.5) * layer.spacing;
    const double radius = ball.radius - depth;
    if (depth >= layer.thickness || (radius <= 0.0 && ring > 0)) return frozen;
    const int count = ring_count<D>(radius, layer);
    if (count == 1) {
      frozen.push_back({ball.offset, first_axis<D>(), ball.radius, 0.0});
      continue;
    }
    for (int i = 0; i < count; ++i) {
      const Vec<D, double> normal = direction<D>(i, count, ring % 2 == 0 ? 0.0 : 0.5);
      frozen.push_back({ball.offset + radius * normal, normal, depth, 0.0});
    }
  }
}

/// Whether ball `own` is the one in which the FP lies deepest.
template <int D>
bool is_deepest(const FrozenParticle<D>& point, std::size_t own, const std::vector<Ball<D>>& balls) {
  for (std::size_t other = 0; other < balls.size(); ++other) {
    if (other == own) continue;
    const double allowed = other < own ? point.depth - depth_tolerance : point.depth + depth_tolerance;
    if (depth_in_ball(point.offset, balls[other]) > allowed) return false;
  }
  return true;
}

/// Sets own_density: each FP sees the body as a continuum, so that in smooth surroundings it has the fluid's density.
/// On a single ball it depends on the depth alone and is worked out once a ring.
template <int D, class Kernel>
void set_own_density(Shape<D>& shape, double number_density) {
  const auto quadrature = SupportQuadrature<D>::of(Kernel{});
  std::vector<Ball<D>> seen;
  const auto depth_at = [&](const Vec<D, double>& x) { return depth_in_union(x, seen); };
  const bool single = shape.balls.size() == 1;
  double known_depth = -1.0;
  double known_density = 0.0;
  for (FrozenParticle<D>& point : shape.frozen) {
    if (!single || point.depth != known_depth) {
      const Vec<D, double> x = single ? (shape.balls[0].radius - point.depth) * first_axis<D>() : point.offset;
      known_depth = point.depth;
      seen.clear();
      for (const Ball<D>& ball : shape.balls)
        if (depth_in_ball(x, ball) > -support_and_cell) seen.push_back(ball);
      known_density = to_density_quanta(number_density * quadrature.inside_share(x, depth_at));
    }
    point.own_density = known_density;
  }
}

template <int D>
void set_single_ball_mass(Shape<D>& shape, double density) {
  const double radius = shape.balls[0].radius;
  shape.balls[0].offset = {};
  shape.volume = ball_volume<D>(radius);
  shape.mass = density * shape.volume;
  const double inertia = (D == 2 ? 0.5 : 0.4) * shape.mass * radius * radius;
  constexpr int n = angular_components<D>;
  for (int i = 0; i < n; ++i) shape.inverse_inertia[n * i + i] = 1.0 / inertia;
}

template <int D>
void set_union_mass(Shape<D>& shape, double density) {
  const Moments<D> moments = integrate_union(shape.balls);
  for (Ball<D>& ball : shape.balls) ball.offset -= moments.centre;
  shape.volume = moments.volume;
  shape.mass = density * moments.volume;
  shape.inverse_inertia = inverse_inertia(moments, density);
}

/// Distances of a column of FPs from the ends of its wall along an axis.
struct FromEnds {
  double below = HUGE_VAL, above = HUGE_VAL;
};

/// The sheets of FPs of a wall from its lower to its upper face, in a column with these distances from its ends along
/// other axes: depth, normal and own_density of their FPs.
template <int D, class Kernel>
std::vector<FrozenParticle<D>> make_sheets(int axis, double thickness, int count,
                                           const std::array<FromEnds, D - 1>& from_ends, const FrozenLayer& layer) {
  const auto quadrature = SupportQuadrature<D>::of(Kernel{});
  const auto depth_at = [&](const Vec<D, double>& x) {
    double depth = std::min(x[0], thickness - x[0]);
    for (int a = 1; a < D; ++a) depth = std::min({depth, from_ends[a - 1].below + x[a], from_ends[a - 1].above - x[a]});
    return depth;
  };
  std::vector<FrozenParticle<D>> sheets(count);
  for (int i = 0; i < count; ++i) {
    FrozenParticle<D>& sheet = sheets[i];
    const bool lower = 2 * i < count - 1;
    sheet.depth = ((lower ? i : count - 1 - i) + 0.5) * (thickness / count);
    sheet.normal[axis] = lower ? -1.0 : 1.0;
    const double share = quadrature.inside_share(sheet.depth * first_axis<D>(), depth_at);
    sheet.own_density = to_density_quanta(layer.number_density * share);
  }
  return sheets;
}

}  // namespace

template <int D, class Kernel>
Shape<D> make_body(std::vector<Ball<D>> balls, double density, const FrozenLayer& layer) {
  Shape<D> shape;
  shape.balls = std::move(balls);
  if (shape.balls.size() == 1)
    set_single_ball_mass(shape, density);
  else
    set_union_mass(shape, density);
  for (std::size_t own = 0; own < shape.balls.size(); ++own) {
    const Ball<D>& ball = shape.balls[own];
    for (const FrozenParticle<D>& point : fill_ball(ball, layer))
      if (is_deepest(point, own, shape.balls)) shape.frozen.push_back(point);
    const double distance = std::sqrt(dot(ball.offset, ball.offset));
    shape.reach = std::max(shape.reach, distance + std::max(ball.radius, ball.contact_radius));
  }
  set_own_density<D, Kernel>(shape, layer.number_density);
  return shape;
}

template <int D, class Kernel>
Shape<D> make_wall_piece(int axis, const std::array<double, D>& sides, const std::array<double, D>& spacing,
                         const FrozenLayer& layer, const WallEnds<D>& ends) {
  Shape<D> shape;
  shape.rotates = false;
  shape.volume = 1.0;
  int count[D];
  int nodes = 1;
  double square = 0.0;
  for (int a = 0; a < D; ++a) {
    count[a] = std::max(1, static_cast<int>(std::floor(sides[a] / spacing[a] + 0.5)));
    nodes *= count[a];
    shape.volume *= sides[a];
    square += sides[a] * sides[a];
  }
  shape.mass = layer.number_density * shape.volume;
  shape.reach = 0.5 * std::sqrt(square);

  // By column as the ends see it: along an axis without an end all columns are one.
  std::map<std::array<int, D>, std::vector<FrozenParticle<D>>> sheets;
  for (int node = 0; node < nodes; ++node) {
    int index[D];
    int rest = node;
    for (int a = 0; a < D; ++a) {
      index[a] = rest % count[a];
      rest /= count[a];
    }
    std::array<int, D> column{};
    std::array<FromEnds, D - 1> from_ends{};
    for (int a = 0, ended = 0; a < D; ++a) {
      if (!ends.below[a] && !ends.above[a]) continue;
      const double cell = sides[a] / count[a];
      column[a] = index[a];
      if (ends.below[a]) from_ends[ended].below = (index[a] + 0.5) * cell;
      if (ends.above[a]) from_ends[ended].above = (count[a] - index[a] - 0.5) * cell;
      ++ended;
    }
    std::vector<FrozenParticle<D>>& sheet = sheets[column];
    if (sheet.empty()) sheet = make_sheets<D, Kernel>(axis, sides[axis], count[axis], from_ends, layer);
    FrozenParticle<D> point = sheet[index[axis]];
    if (point.depth >= layer.thickness) continue;
    for (int a = 0; a < D; ++a) point.offset[a] = (2 * index[a] + 1 - count[a]) * (0.5 * sides[a] / count[a]);
    shape.frozen.push_back(point);
  }
  return shape;
}

template <int D>
using Lengths = const std::array<double, D>&;

template Shape<2> make_body<2, WendlandC2>(std::vector<Ball<2>>, double, const FrozenLayer&);
template Shape<2> make_body<2, Lucy>(std::vector<Ball<2>>, double, const FrozenLayer&);
template Shape<2> make_body<2, MpsWeight>(std::vector<Ball<2>>, double, const FrozenLayer&);
template Shape<3> make_body<3, WendlandC2>(std::vector<Ball<3>>, double, const FrozenLayer&);
template Shape<3> make_body<3, Lucy>(std::vector<Ball<3>>, double, const FrozenLayer&);
template Shape<3> make_body<3, MpsWeight>(std::vector<Ball<3>>, double, const FrozenLayer&);
template Shape<2> make_wall_piece<2, WendlandC2>(int, Lengths<2>, Lengths<2>, const FrozenLayer&, const WallEnds<2>&);
template Shape<2> make_wall_piece<2, Lucy>(int, Lengths<2>, Lengths<2>, const FrozenLayer&, const WallEnds<2>&);
template Shape<2> make_wall_piece<2, MpsWeight>(int, Lengths<2>, Lengths<2>, const FrozenLayer&, const WallEnds<2>&);
template Shape<3> make_wall_piece<3, WendlandC2>(int, Lengths<3>, Lengths<3>, const FrozenLayer&, const WallEnds<3>&);
template Shape<3> make_wall_piece<3, Lucy>(int, Lengths<3>, Lengths<3>, const FrozenLayer&, const WallEnds<3>&);
template Shape<3> make_wall_piece<3, MpsWeight>(int, Lengths<3>, Lengths<3>, const FrozenLayer&, const WallEnds<3>&);

}  // namespace mappm
