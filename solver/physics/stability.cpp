#include "physics/stability.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/rotation.hpp"
#include "base/vec.hpp"
#include "physics/wall.hpp"

namespace mappm {

namespace {

/// Neighbours of a PP within the reach, dx.
template <int D>
using Neighbours = std::vector<Vec<D, double>>;

template <int D>
struct Lattice {
  Vec<D, double> basis[D];
  /// Unit vectors: of the wave first, of the displacements across it behind.
  std::vector<std::vector<Vec<D, double>>> directions;
};

template <int D>
Vec<D, double> unit(Vec<D, double> v) {
  return (1.0 / std::sqrt(dot(v, v))) * v;
}

/// With a volume of 1 per node.
std::vector<Lattice<2>> lattices(std::integral_constant<int, 2>) {
  const double side = std::sqrt(2.0 / std::sqrt(3.0)), height = side * std::sqrt(0.75);
  const std::vector<Vec<2, double>> x{{{1.0, 0.0}}, {{0.0, 1.0}}}, y{{{0.0, 1.0}}, {{1.0, 0.0}}};
  const std::vector<Vec<2, double>> diagonal{unit<2>({{1.0, 1.0}}), unit<2>({{1.0, -1.0}})};
  return {{{{{1.0, 0.0}}, {{0.0, 1.0}}}, {x, diagonal}}, {{{{side, 0.0}}, {{0.5 * side, height}}}, {x, y}}};
}
std::vector<Lattice<3>> lattices(std::integral_constant<int, 3>) {
  const double half = 0.5 * std::cbrt(4.0);
  const std::vector<Vec<3, double>> edge{{{1.0, 0.0, 0.0}}, {{0.0, 1.0, 0.0}}};
  const std::vector<Vec<3, double>> face{unit<3>({{1.0, 1.0, 0.0}}), unit<3>({{1.0, -1.0, 0.0}}), {{0.0, 0.0, 1.0}}};
  const std::vector<Vec<3, double>> body{unit<3>({{1.0, 1.0, 1.0}}), unit<3>({{1.0, -1.0, 0.0}})};
  return {{{{{1.0, 0.0, 0.0}}, {{0.0, 1.0, 0.0}}, {{0.0, 0.0, 1.0}}}, {edge, face, body}},
          {{{{half, half, 0.0}}, {{half, 0.0, half}}, {{0.0, half, half}}}, {edge, face, body}}};
}

template <int D>
Neighbours<D> neighbours(const Lattice<D>& lattice, double reach) {
  const int most = 2 * static_cast<int>(reach) + 3;
  Neighbours<D> found;
  for (int k = D == 3 ? -most : 0; k <= (D == 3 ? most : 0); ++k)
    for (int j = -most; j <= most; ++j)
      for (int i = -most; i <= most; ++i) {
        const int node[3] = {i, j, k};
        Vec<D, double> r;
        for (int axis = 0; axis < D; ++axis) r = r + static_cast<double>(node[axis]) * lattice.basis[axis];
        const double square = dot(r, r);
        if (square > 1e-9 && square < reach * reach) found.push_back(r);
      }
  return found;
}

/// d profile / dq, from the profile itself.
template <class Profile>
double slope(Profile&& profile, double q) {
  constexpr double near = 1e-5;
  return (profile(q + near) - profile(q - near)) / (2.0 * near);
}

template <class Kernel, int D>
void add_waves(const Lattice<D>& lattice, double reach, std::vector<LatticeWave>& waves) {
  const Neighbours<D> around = neighbours(lattice, reach);
  const auto weight = [](double q) { return q < 1.0 ? Kernel::weight(q) : 0.0; };
  const auto gradient = [](double q) { return q < 1.0 ? Kernel::gradient(q) : 0.0; };
  struct Profiles {
    double g, slope_over_r, rate;
  };
  std::vector<Profiles> profiles;
  double weights = Kernel::self_weight, gradients = 0.0;
  for (const Vec<D, double>& r : around) {
    const double length = std::sqrt(dot(r, r)), q = length / reach;
    profiles.push_back({gradient(q), slope(gradient, q) / (reach * length), -slope(weight, q) / (reach * length)});
    weights += weight(q);
    gradients += length * length * gradient(q);
  }
  constexpr int lengths = 48;
  const double shortest = 1.3 * std::numbers::pi * std::sqrt(D);  // wave number beyond which waves repeat
  for (const auto& direction : lattice.directions)
    for (int n = 1; n <= lengths; ++n) {
      const double number = shortest * n / lengths;
      double along = 0.0, rate = 0.0;
      LatticeWave wave;
      std::vector<double> shift(direction.size(), 0.0);
      for (std::size_t j = 0; j < around.size(); ++j) {
        const double way = dot(direction[0], around[j]);
        const Vec<2, double> phase = unit_circle(number * way / (2.0 * std::numbers::pi));
        along += profiles[j].g * way * phase[1];
        rate += profiles[j].rate * way * phase[1];
        wave.friction += 2.0 * profiles[j].g * (1.0 - phase[0]);
        for (std::size_t t = 0; t < direction.size(); ++t) {
          const double displaced = dot(direction[t], around[j]);
          shift[t] += (profiles[j].g + profiles[j].slope_over_r * displaced * displaced) * (1.0 - phase[0]);
        }
      }
      const double scale = D / gradients;
      wave.friction *= scale;
      for (std::size_t t = 0; t < direction.size(); ++t) {
        wave.pressure = t == 0 ? along * scale * rate / weights : 0.0;
        wave.shift = shift[t] * scale;
        waves.push_back(wave);
      }
    }
}

}  // namespace

template <int D>
std::vector<LatticeWave> lattice_waves(KernelKind kernel, double reach) {
  std::vector<LatticeWave> waves;
  for (const Lattice<D>& lattice : lattices(std::integral_constant<int, D>())) {
    switch (kernel) {
      case KernelKind::wendland_c2:
        add_waves<WendlandC2>(lattice, reach, waves);
        break;
      case KernelKind::lucy:
        add_waves<Lucy>(lattice, reach, waves);
        break;
      case KernelKind::mps:
        add_waves<MpsWeight>(lattice, reach, waves);
        break;
    }
  }
  return waves;
}

/// The eigenvalues of the step, a matrix of two rows, are above -1 (Jury's criterion): its characteristic polynomial is
/// not negative at -1, and rises there.
bool is_stable(const LatticeWave& wave, double step, double viscosity, double shift_rate) {
  const double damping = 1.0 - step * viscosity * wave.friction;
  const double shifted = 1.0 + step * shift_rate * (wave.shift + wave.pressure);
  const double sound = step * step * wave.pressure;
  return damping + shifted - sound >= -2.0 && (1.0 + damping) * (1.0 + shifted) >= sound;
}

namespace {

/// PPs on the nodes of a square lattice on the near sides of the walls, FPs half a spacing further on the far sides. Of
/// an FP beyond several walls the largest factor counts.
template <class Kernel, int D>
double wall_friction_of(double reach, double largest_no_slip, int walls) {
  const int most = static_cast<int>(reach) + 1;
  struct Row {
    double position, no_slip;  // no_slip: 0 for a PP
  };
  std::vector<Row> both_sides, at_wall;
  for (int k = -most; k <= most; ++k) {
    both_sides.push_back({static_cast<double>(k), 0.0});
    if (k >= 0) at_wall.push_back({static_cast<double>(k), 0.0});
    const Vec<1, double> above{{k + 0.5}}, normal{{1.0}};
    if (k >= 0) at_wall.push_back({-above[0], no_slip_factor(above, normal, above[0], 0.25, largest_no_slip)});
  }
  const auto sum = [&](const std::vector<Row>& x, const std::vector<Row>& y, const std::vector<Row>& z) {
    double friction = 0.0;
    for (const Row& i : x)
      for (const Row& j : y)
        for (const Row& k : z) {
          const double square = i.position * i.position + j.position * j.position + k.position * k.position;
          if (square == 0.0 || square >= reach * reach) continue;
          const double no_slip = std::max({i.no_slip, j.no_slip, k.no_slip});
          friction += (no_slip > 0.0 ? no_slip : 2.0) * Kernel::gradient(std::sqrt(square) / reach);
        }
    return friction;
  };
  const std::vector<Row> one{{0.0, 0.0}};
  const auto rows = [&](int axis) -> const std::vector<Row>& {
    if (axis >= D) return one;
    return axis < walls ? at_wall : both_sides;
  };
  const double in_fluid = sum(both_sides, both_sides, D == 3 ? both_sides : one);
  return std::max(1.0, sum(rows(0), rows(1), rows(2)) / in_fluid);
}

}  // namespace

template <int D>
double wall_friction(KernelKind kernel, double reach, double largest_no_slip, int walls) {
  switch (kernel) {
    case KernelKind::wendland_c2:
      return wall_friction_of<WendlandC2, D>(reach, largest_no_slip, walls);
    case KernelKind::lucy:
      return wall_friction_of<Lucy, D>(reach, largest_no_slip, walls);
    case KernelKind::mps:
      return wall_friction_of<MpsWeight, D>(reach, largest_no_slip, walls);
  }
  return 1.0;
}

template <int D>
double first_instability(KernelKind kernel, double reach, double viscosity, double shift_rate) {
  const std::vector<LatticeWave> waves = lattice_waves<D>(kernel, reach);
  const double h = 0.5 * reach;
  const auto all_stable = [&](double step) {
    return std::ranges::all_of(
        waves, [&](const LatticeWave& wave) { return is_stable(wave, step * h, viscosity * h, shift_rate * h); });
  };
  double low = 0.0, high = 4.0;
  while (high - low > 1e-4) {
    const double middle = 0.5 * (low + high);
    (all_stable(middle) ? low : high) = middle;
  }
  return std::floor(100.0 * low + 0.005) / 100.0;
}

template std::vector<LatticeWave> lattice_waves<2>(KernelKind, double);
template std::vector<LatticeWave> lattice_waves<3>(KernelKind, double);
template double wall_friction<2>(KernelKind, double, double, int);
template double wall_friction<3>(KernelKind, double, double, int);
template double first_instability<2>(KernelKind, double, double, double);
template double first_instability<3>(KernelKind, double, double, double);

}  // namespace mappm
