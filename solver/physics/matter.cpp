#include "physics/matter.hpp"

#include <algorithm>
#include <cmath>

#ifndef EIGEN_DONT_VECTORIZE
#define EIGEN_DONT_VECTORIZE  // the same bits on every machine
#endif
#include <Eigen/Dense>

namespace mappm {

namespace {

constexpr double golden_turn = 0.38196601125010515;  // (3 - sqrt 5) / 2, the golden angle as a part of a full turn

/// A grid of cells of one size over the bounding box of some balls, met one after the other.
template <int D>
class BoundingGrid {
 public:
  BoundingGrid(const std::vector<Ball<D>>& balls, double cell) : cell_(cell) {
    for (int axis = 0; axis < D; ++axis) {
      double low = HUGE_VAL;
      double high = -HUGE_VAL;
      for (const Ball<D>& ball : balls) {
        low = std::min(low, ball.offset[axis] - ball.radius);
        high = std::max(high, ball.offset[axis] + ball.radius);
      }
      count_[axis] = static_cast<long>(std::ceil((high - low) / cell));
      first_[axis] = 0.5 * (low + high) - 0.5 * static_cast<double>(count_[axis] - 1) * cell;  // centred
    }
  }

  long size() const {
    long product = 1;
    for (int axis = 0; axis < D; ++axis) product *= count_[axis];
    return product;
  }

  Vec<D, double> centre(long index) const {
    Vec<D, double> point;
    for (int axis = 0; axis < D; ++axis) {
      point[axis] = first_[axis] + static_cast<double>(index % count_[axis]) * cell_;
      index /= count_[axis];
    }
    return point;
  }

 private:
  double cell_;
  long count_[D] = {};
  Vec<D, double> first_;
};

}  // namespace

template <int D>
double depth_in_ball(const Vec<D, double>& point, const Ball<D>& ball) {
  const Vec<D, double> r = point - ball.offset;
  return ball.radius - std::sqrt(dot(r, r));
}

template <int D>
double depth_in_union(const Vec<D, double>& point, const std::vector<Ball<D>>& balls) {
  double deepest = -HUGE_VAL;
  for (const Ball<D>& ball : balls) deepest = std::max(deepest, depth_in_ball(point, ball));
  return deepest;
}

template <int D>
Moments<D> integrate_union(const std::vector<Ball<D>>& balls, double cell) {
  const BoundingGrid<D> grid(balls, cell);
  Moments<D> moments;
  const long cells = grid.size();
  for (long index = 0; index < cells; ++index) {
    const Vec<D, double> x = grid.centre(index);
    const double share = coverage(depth_in_union(x, balls), cell);
    if (share == 0.0) continue;
    moments.volume += share;
    moments.centre += share * x;
    for (int a = 0; a < D; ++a) moments.second[a] += (share * x[a]) * x;
  }
  double cell_volume = 1.0;
  for (int axis = 0; axis < D; ++axis) cell_volume *= cell;
  moments.centre = (1.0 / moments.volume) * moments.centre;
  for (int a = 0; a < D; ++a) {
    moments.second[a] -= (moments.volume * moments.centre[a]) * moments.centre;
    moments.second[a] = cell_volume * moments.second[a];
  }
  moments.volume *= cell_volume;
  return moments;
}

template <int D>
Vec<D == 2 ? 1 : 9, double> inverse_inertia(const Moments<D>& moments, double density) {
  double trace = 0.0;
  for (int a = 0; a < D; ++a) trace += moments.second[a][a];
  if constexpr (D == 2) {
    return {{1.0 / (density * trace)}};
  } else {
    Eigen::Matrix3d inertia;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) inertia(a, b) = density * ((a == b ? trace : 0.0) - moments.second[a][b]);
    const Eigen::Matrix3d inverse = inertia.inverse();
    Vec<9, double> rows;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) rows[3 * a + b] = inverse(a, b);
    return rows;
  }
}

template <int D>
Vec<D, double> direction(int index, int n, double shift) {
  if constexpr (D == 2) {
    return unit_circle((index + shift) / n);
  } else {
    const double z = 1.0 - (2.0 * index + 1.0) / n;
    const Vec<2, double> circle = std::sqrt(1.0 - z * z) * unit_circle((index + shift) * golden_turn);
    return {{circle[0], circle[1], z}};
  }
}

/// One direction of each pair: those of half the circle, or of the upper half of the sphere.
template <int D>
SupportQuadrature<D>::SupportQuadrature(const std::array<double, radii>& profile) : shell_weight_(profile) {
  for (int i = 0; i < pairs; ++i) directions_.push_back(direction<D>(i, 2 * pairs, 0.5));
  for (int k = 0; k < radii; ++k)
    for (int axis = 1; axis < D; ++axis) shell_weight_[k] *= radius(k);
}

template double depth_in_ball(const Vec<2, double>&, const Ball<2>&);
template double depth_in_union(const Vec<2, double>&, const std::vector<Ball<2>>&);
template Moments<2> integrate_union(const std::vector<Ball<2>>&, double);
template Vec<1, double> inverse_inertia(const Moments<2>&, double);
template Vec<2, double> direction<2>(int, int, double);
template class SupportQuadrature<2>;
template double depth_in_ball(const Vec<3, double>&, const Ball<3>&);
template double depth_in_union(const Vec<3, double>&, const std::vector<Ball<3>>&);
template Moments<3> integrate_union(const std::vector<Ball<3>>&, double);
template Vec<9, double> inverse_inertia(const Moments<3>&, double);
template Vec<3, double> direction<3>(int, int, double);
template class SupportQuadrature<3>;

}  // namespace mappm
