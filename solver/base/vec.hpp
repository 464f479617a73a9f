// Small fixed-size vectors over any number type: double, integers, or SIMD lanes.
#pragma once

namespace mappm {

template <int N, class T>
struct Vec {
  T component[N]{};

  constexpr T& operator[](int axis) { return component[axis]; }
  constexpr const T& operator[](int axis) const { return component[axis]; }

  constexpr Vec& operator+=(const Vec& other) {
    for (int axis = 0; axis < N; ++axis) component[axis] = component[axis] + other[axis];
    return *this;
  }
  constexpr Vec& operator-=(const Vec& other) {
    for (int axis = 0; axis < N; ++axis) component[axis] = component[axis] - other[axis];
    return *this;
  }
  friend constexpr Vec operator+(Vec a, const Vec& b) { return a += b; }
  friend constexpr Vec operator-(Vec a, const Vec& b) { return a -= b; }
  friend constexpr Vec operator-(const Vec& a) { return Vec{} - a; }
  friend constexpr Vec operator*(const T& factor, Vec a) {
    for (int axis = 0; axis < N; ++axis) a[axis] = factor * a[axis];
    return a;
  }
  friend constexpr bool operator==(const Vec& a, const Vec& b) {
    for (int axis = 0; axis < N; ++axis)
      if (!(a[axis] == b[axis])) return false;
    return true;
  }
};

/// Scalar product, summed from the first axis to the last (the order is part of the result's bits).
template <int N, class T>
constexpr T dot(const Vec<N, T>& a, const Vec<N, T>& b) {
  T sum = a[0] * b[0];
  for (int axis = 1; axis < N; ++axis) sum = sum + a[axis] * b[axis];
  return sum;
}

/// Number of components of an angular quantity: one in the plane, three in space.
template <int D>
inline constexpr int angular_components = D == 2 ? 1 : 3;

template <int D, class T>
using AngularVec = Vec<angular_components<D>, T>;

/// a x b; in the plane its only component, along the normal.
template <int D, class T>
constexpr AngularVec<D, T> cross(const Vec<D, T>& a, const Vec<D, T>& b) {
  if constexpr (D == 2)
    return {{a[0] * b[1] - a[1] * b[0]}};
  else
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

/// omega x r: the velocity of a point at r on a body that turns with omega.
template <int D, class T>
constexpr Vec<D, T> rotational_velocity(const AngularVec<D, T>& omega, const Vec<D, T>& r) {
  if constexpr (D == 2)
    return {{-(omega[0] * r[1]), omega[0] * r[0]}};
  else
    return cross<3, T>(omega, r);
}

}  // namespace mappm
