#include "physics/matter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#ifndef EIGEN_DONT_VECTORIZE
#define EIGEN_DONT_VECTORIZE  // the same bits on every machine
#endif
#include <Eigen/Dense>

namespace mappm {

namespace {

constexpr double golden_turn = 0.38196601125010515;  // (3 - sqrt 5) / 2, the golden angle as a part of a full turn

/// Gauss and Legendre's nodes and weights in [-1, 1], of which each stands for two.
constexpr std::array<double, 6> gauss_nodes{0.12523340851146891547, 0.36783149899818019375, 0.58731795428661744730,
                                            0.76990267419430468704, 0.90411725637047485668, 0.98156063424671925069};
constexpr std::array<double, 6> gauss_weights{0.24914704581340278500, 0.23349253653835480876, 0.20316742672306592175,
                                              0.16007832854334622633, 0.10693932599531843096, 0.04717533638651182719};

/// Bounds the cost: of more heights where a slice of the union changes its form only every so many-th is kept.
constexpr std::size_t most_panels = 256;

/// Where three balls meet in a point, a slice changes its form inside a panel: few panels are cut until they are as
/// many as this.
constexpr std::size_t least_panels = 64;

/// Integrates over a union of balls: along lines in closed form, over the lines of a slice and over the slices by
/// Gauss' rule, panel by panel. At the ends of a panel the integrand may have a root of the distance to it, which
/// x = (3 s - s^3) / 2 removes. Slices of balls are balls again, of one dimension less: `axis` is the last one left.
template <int D>
class UnionIntegral {
 public:
  explicit UnionIntegral(const std::vector<Ball<D>>& balls) { slice(D - 1, balls, {}, 1.0); }
  const Moments<D>& about_origin() const { return sum_; }

 private:
  void slice(int axis, const std::vector<Ball<D>>& balls, Vec<D, double> point, double weight) {
    if (axis == 0) return add_line(balls, point, weight);
    const std::vector<double> ends = axis == D - 1 ? cut(panels(axis, balls)) : panels(axis, balls);
    for (std::size_t k = 1; k < ends.size(); ++k)
      for (std::size_t i = 0; i < gauss_nodes.size(); ++i)
        for (const double s : {-gauss_nodes[i], gauss_nodes[i]}) {
          const double half = 0.5 * (ends[k] - ends[k - 1]);
          point[axis] = 0.5 * (ends[k] + ends[k - 1]) + half * 0.5 * s * (3.0 - s * s);
          const double width = half * 1.5 * (1.0 - s * s) * gauss_weights[i];
          slice(axis - 1, slices_of(axis, balls, point[axis]), point, weight * width);
        }
  }

  static std::vector<double> cut(const std::vector<double>& ends) {
    const std::size_t parts = (least_panels + ends.size() - 1) / ends.size();
    std::vector<double> all;
    for (std::size_t k = 1; k < ends.size(); ++k)
      for (std::size_t part = 0; part < parts; ++part)
        all.push_back(ends[k - 1] + (ends[k] - ends[k - 1]) * static_cast<double>(part) / static_cast<double>(parts));
    all.push_back(ends.back());
    return all;
  }

  static std::vector<Ball<D>> slices_of(int axis, const std::vector<Ball<D>>& balls, double x) {
    std::vector<Ball<D>> slices;
    for (const Ball<D>& ball : balls) {
      const double distance = x - ball.offset[axis];
      const double square = ball.radius * ball.radius - distance * distance;
      if (square <= 0.0) continue;
      slices.push_back(ball);
      slices.back().radius = std::sqrt(square);
    }
    return slices;
  }

  /// Where slices normal to `axis` change their form: at the ends of balls and of the spheres in which two intersect,
  /// as far as no other ball covers them.
  static std::vector<double> panels(int axis, const std::vector<Ball<D>>& balls) {
    std::vector<double> ends;
    const auto distance_square = [&](const Vec<D, double>& a, const Vec<D, double>& b) {
      double square = 0.0;
      for (int k = 0; k <= axis; ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
      return square;
    };
    const auto add = [&](const Vec<D, double>& end, std::size_t i, std::size_t j) {
      for (std::size_t k = 0; k < balls.size(); ++k)
        if (k != i && k != j && distance_square(end, balls[k].offset) < balls[k].radius * balls[k].radius) return;
      ends.push_back(end[axis]);
    };
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const Ball<D>& one = balls[i];
      for (const double sign : {-1.0, 1.0}) {
        Vec<D, double> end = one.offset;
        end[axis] += sign * one.radius;
        add(end, i, i);
      }
      for (std::size_t j = i + 1; j < balls.size(); ++j) {
        const Ball<D>& other = balls[j];
        const double square = distance_square(one.offset, other.offset);
        const double sum = one.radius + other.radius, difference = one.radius - other.radius;
        if (square >= sum * sum || square <= difference * difference) continue;
        const Vec<D, double> between = other.offset - one.offset;
        const double share = 0.5 + 0.5 * sum * difference / square;
        Vec<D, double> across = (-between[axis] / square) * between;  // the axis, less its part along `between`
        across[axis] += 1.0;
        double across_square = 0.0;
        for (int k = 0; k <= axis; ++k) across_square += across[k] * across[k];
        if (across_square == 0.0) continue;
        const double radius_square = one.radius * one.radius - share * share * square;
        const double length = std::sqrt(std::max(0.0, radius_square) / across_square);
        for (const double sign : {-1.0, 1.0}) add(one.offset + share * between + sign * length * across, i, j);
      }
    }
    std::sort(ends.begin(), ends.end());
    std::vector<double> kept;
    const std::size_t stride = (ends.size() + most_panels - 1) / most_panels;
    for (std::size_t k = 0; k < ends.size(); k += stride) kept.push_back(ends[k]);
    if (!ends.empty() && kept.back() < ends.back()) kept.push_back(ends.back());
    return kept;
  }

  /// Segments that overlap count once.
  void add_line(const std::vector<Ball<D>>& segments, Vec<D, double> point, double weight) {
    line_.clear();
    for (const Ball<D>& segment : segments)
      line_.emplace_back(segment.offset[0] - segment.radius, segment.offset[0] + segment.radius);
    std::sort(line_.begin(), line_.end());
    double end = -HUGE_VAL;
    for (const auto& [low, high] : line_) {
      const double from = std::max(low, end);
      if (high <= from) continue;
      end = high;
      const double length = high - from, share = weight * length;
      point[0] = 0.5 * (from + high);
      sum_.volume += share;
      sum_.centre += share * point;
      for (int a = 0; a < D; ++a) sum_.second[a] += (share * point[a]) * point;
      sum_.second[0][0] += share * length * length / 12.0;
    }
  }

  Moments<D> sum_;  // centre: not yet divided by the volume
  std::vector<std::pair<double, double>> line_;
};

/// Middle of the box that holds some balls.
template <int D>
Vec<D, double> middle_of(const std::vector<Ball<D>>& balls) {
  Vec<D, double> middle;
  for (int axis = 0; axis < D; ++axis) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const Ball<D>& ball : balls) {
      low = std::min(low, ball.offset[axis] - ball.radius);
      high = std::max(high, ball.offset[axis] + ball.radius);
    }
    middle[axis] = 0.5 * (low + high);
  }
  return middle;
}

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
Moments<D> integrate_union(std::vector<Ball<D>> balls) {
  const Vec<D, double> middle = middle_of(balls);
  for (Ball<D>& ball : balls) ball.offset -= middle;
  Moments<D> moments = UnionIntegral<D>(balls).about_origin();
  moments.centre = (1.0 / moments.volume) * moments.centre;
  for (int a = 0; a < D; ++a) moments.second[a] -= (moments.volume * moments.centre[a]) * moments.centre;
  moments.centre += middle;
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
template Moments<2> integrate_union(std::vector<Ball<2>>);
template Vec<1, double> inverse_inertia(const Moments<2>&, double);
template Vec<2, double> direction<2>(int, int, double);
template class SupportQuadrature<2>;
template double depth_in_ball(const Vec<3, double>&, const Ball<3>&);
template double depth_in_union(const Vec<3, double>&, const std::vector<Ball<3>>&);
template Moments<3> integrate_union(std::vector<Ball<3>>);
template Vec<9, double> inverse_inertia(const Moments<3>&, double);
template Vec<3, double> direction<3>(int, int, double);
template class SupportQuadrature<3>;

}  // namespace mappm
