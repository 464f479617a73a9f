#include "base/rotation.hpp"

#include <cmath>

namespace mappm {

namespace {

constexpr double two_pi = 6.283185307179586476925;
constexpr double ln_2 = 0.6931471805599453094172;

/// sum of (-1)^k x^(2k) (first - 1)! / (first - 1 + 2k)!, the Taylor series shared by cos (first = 1) and
/// sin / x (first = 2). Nine terms leave less than 1e-17 for |x| <= pi / 4.
double alternating_series(double square, int first) {
  double sum = 1.0;
  for (int k = 8; k >= 1; --k)
    sum = 1.0 - square * sum / static_cast<double>((first + 2 * k - 2) * (first + 2 * k - 1));
  return sum;
}

template <int N>
Vec<N, double> to_unit_length(const Vec<N, double>& v) {
  return (1.0 / std::sqrt(dot(v, v))) * v;
}

template <int D>
Rotation<D> inverse(const Rotation<D>& rotation) {
  Rotation<D> result{-rotation.component};
  result.component[0] = rotation.component[0];
  return result;
}

Vec<2, double> complex_product(const Vec<2, double>& a, const Vec<2, double>& b) {
  return {{a[0] * b[0] - a[1] * b[1], a[1] * b[0] + a[0] * b[1]}};
}

Vec<3, double> vector_part(const Rotation<3>& rotation) {
  return {{rotation.component[1], rotation.component[2], rotation.component[3]}};
}

}  // namespace

template <int D>
Vec<D, double> rotate(const Rotation<D>& rotation, const Vec<D, double>& v) {
  if constexpr (D == 2) {
    return complex_product(rotation.component, v);
  } else {  // v + w t + u x t with t = 2 u x v, for the quaternion (w, u)
    const Vec<3, double> u = vector_part(rotation);
    const Vec<3, double> t = 2.0 * cross<3, double>(u, v);
    return v + rotation.component[0] * t + cross<3, double>(u, t);
  }
}

template <int D>
Vec<D, double> rotate_back(const Rotation<D>& rotation, const Vec<D, double>& v) {
  return rotate(inverse(rotation), v);
}

template <int D>
Rotation<D> turn(const Rotation<D>& rotation, const AngularVec<D, double>& angle) {
  const AngularVec<D, double> half = 0.5 * angle;
  if (half == AngularVec<D, double>{}) return rotation;  // what does not turn keeps its bits
  if constexpr (D == 2) {  // (1 + i a/2) / (1 - i a/2) has the direction of (1 + i a/2)^2 = 1 - a^2/4 + i a
    const Vec<2, double> step{{1.0 - half[0] * half[0], angle[0]}};
    return {to_unit_length(complex_product(step, rotation.component))};
  } else {  // the product of the quaternions (1, a/2) and (w, u)
    const double w = rotation.component[0];
    const Vec<3, double> u = vector_part(rotation);
    const Vec<3, double> v = u + w * half + cross<3, double>(half, u);
    return {to_unit_length(Vec<4, double>{{w - dot(half, u), v[0], v[1], v[2]}})};
  }
}

Vec<2, double> unit_circle(double turns) {
  const double fraction = turns - std::floor(turns + 0.5);   // exact
  const double quarters = std::floor(4.0 * fraction + 0.5);  // -2 .. 2
  const double x = (fraction - 0.25 * quarters) * two_pi;    // within pi / 4
  const double c = alternating_series(x * x, 1);
  const double s = x * alternating_series(x * x, 2);
  switch (static_cast<int>(quarters)) {
    case 0:
      return {{c, s}};
    case 1:
      return {{-s, c}};
    case -1:
      return {{s, -c}};
    default:
      return {{-c, -s}};
  }
}

/// x = m 2^k with m within a factor sqrt(2) of 1; ln m = 2 artanh((m-1)/(m+1)), whose argument is below 0.172, so that
/// twelve terms leave less than 1e-19.
double natural_log(double x) {
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < 0.70710678118654752) {
    mantissa *= 2.0;
    --exponent;
  }
  const double z = (mantissa - 1.0) / (mantissa + 1.0);
  const double square = z * z;
  double sum = 0.0;
  for (int k = 11; k >= 1; --k) sum = square * (sum + 1.0 / (2 * k + 1));
  return static_cast<double>(exponent) * ln_2 + 2.0 * (z + z * sum);
}

template Vec<2, double> rotate(const Rotation<2>&, const Vec<2, double>&);
template Vec<3, double> rotate(const Rotation<3>&, const Vec<3, double>&);
template Vec<2, double> rotate_back(const Rotation<2>&, const Vec<2, double>&);
template Vec<3, double> rotate_back(const Rotation<3>&, const Vec<3, double>&);
template Rotation<2> turn(const Rotation<2>&, const AngularVec<2, double>&);
template Rotation<3> turn(const Rotation<3>&, const AngularVec<3, double>&);

}  // namespace mappm
