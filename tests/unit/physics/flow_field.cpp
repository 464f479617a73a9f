// Oracle: the fields written with the sines of the mathematics library, and their laws by central differences.
#include "physics/flow_field.hpp"

#include <gtest/gtest.h>

namespace mappm {
namespace {

using Kind = FlowField::Kind;

constexpr double two_pi = 6.283185307179586476925;

template <int D>
Vec<D, double> at(const FlowField& field, const Vec<D, double>& fractions) {
  return flow_at(field, box_quanta * fractions);
}

/// d value[component] / d x[axis], in radians of the first mode.
double slope(const FlowField& field, const Vec<3, double>& x, int component, int axis) {
  constexpr double h = 0x1p-13;
  Vec<3, double> above = x, below = x;
  above[axis] += h;
  below[axis] -= h;
  return (at(field, above)[component] - at(field, below)[component]) / (2.0 * h * two_pi);
}

constexpr Vec<3, double> places[] = {{{0.1, 0.2, 0.3}}, {{0.9, 0.35, 0.71}}, {{0.5, 0.01, 0.6}}};

TEST(FlowField, a_wave_moves_one_axis_and_varies_along_one) {
  const FlowField field{Kind::wave, 0.5, 3, 0, 1};
  for (const double y : {0.0, 0.1, 0.25, 0.9}) {
    const Vec<2, double> value = at<2>(field, {{0.7, y}});
    EXPECT_NEAR(value[0], 0.5 * std::sin(3 * two_pi * y), 1e-14);
    EXPECT_EQ(value[1], 0.0);
  }
}

TEST(FlowField, vortices_of_the_plane) {
  const FlowField field{Kind::vortices, 0.5, 2};
  for (const Vec<3, double>& x : places) {
    const double a = 2 * two_pi * x[0], b = 2 * two_pi * x[1];
    const Vec<2, double> value = at<2>(field, {{x[0], x[1]}});
    EXPECT_NEAR(value[0], 0.5 * std::sin(a) * std::cos(b), 1e-14);
    EXPECT_NEAR(value[1], -0.5 * std::cos(a) * std::sin(b), 1e-14);
  }
}

TEST(FlowField, vortices_of_space) {
  const FlowField field{Kind::vortices, 0.5, 1};
  for (const Vec<3, double>& x : places) {
    const double a = two_pi * x[0], b = two_pi * x[1], c = two_pi * x[2];
    const Vec<3, double> value = at(field, x);
    EXPECT_NEAR(value[0], 0.5 * std::sin(a) * std::cos(b) * std::cos(c), 1e-14);
    EXPECT_NEAR(value[1], -0.5 * std::cos(a) * std::sin(b) * std::cos(c), 1e-14);
    EXPECT_EQ(value[2], 0.0);
  }
}

TEST(FlowField, abc_is_its_own_curl_divided_by_k) {
  const FlowField field{Kind::abc, 0.5, 2};
  for (const Vec<3, double>& x : places) {
    const Vec<3, double> value = at(field, x);
    EXPECT_NEAR(value[0], 0.5 * (std::sin(2 * two_pi * x[2]) + std::cos(2 * two_pi * x[1])), 1e-14);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      // Central differences: (k h)^2 / 6 of 2 A, less than 4e-7.
      EXPECT_NEAR(slope(field, x, k, j) - slope(field, x, j, k), 2.0 * value[i], 1e-6);
    }
  }
}

TEST(FlowField, vortices_and_abc_have_no_divergence) {
  for (const Kind kind : {Kind::vortices, Kind::abc})
    for (const Vec<3, double>& x : places) {
      const FlowField field{kind, 0.5, 1};
      EXPECT_NEAR(slope(field, x, 0, 0) + slope(field, x, 1, 1) + slope(field, x, 2, 2), 0.0, 1e-12);
    }
}

TEST(FlowField, the_largest_value_is_reached_and_never_passed) {
  const Vec<3, double> peaks[] = {{{0.0, 0.25, 0.0}}, {{0.25, 0.0, 0.0}}, {{0.125, 0.125, 0.125}}};
  for (const Kind kind : {Kind::wave, Kind::vortices, Kind::abc}) {
    const FlowField field{kind, -0.5, 1, 0, 1};
    const auto length = [&](const Vec<3, double>& x) { return std::sqrt(dot(at(field, x), at(field, x))); };
    EXPECT_NEAR(length(peaks[static_cast<int>(kind)]), largest_flow(field), 1e-14);
    double largest = 0.0;
    for (int n = 0; n < 16 * 16 * 16; ++n)
      largest = std::max(largest, length({{n % 16 / 16.0, n / 16 % 16 / 16.0, n / 256 / 16.0}}));
    EXPECT_LE(largest, largest_flow(field) * (1.0 + 1e-14));
  }
}

TEST(FlowField, the_impulse_is_the_nearest_number_of_iotas) {
  const FlowField kick{Kind::abc, 1e-5, 1};
  for (const Vec<3, double>& x : places) {
    const Vec<3, double> value = at(kick, x);
    const Vec<3, std::int64_t> impulse = field_impulse(kick, box_quanta * x);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(static_cast<double>(impulse[axis]), std::nearbyint(value[axis] * 0x1p48));
  }
}

}  // namespace
}  // namespace mappm
