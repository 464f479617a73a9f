// Oracle: a comparison of all pairs of bodies; the meshes worked by hand.
#include "particles/cell_levels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace mappm {
namespace {

template <int D>
struct Body {
  Vec<D, double> x;
  double radius;
};

/// Bodies of radii from 0.1 to 1, evenly in the logarithm, so that every mesh has some. A few lie outside the region.
template <int D>
std::vector<Body<D>> scatter(const Vec<D, double>& low, const Vec<D, double>& high, int count) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Body<D>> bodies(static_cast<std::size_t>(count));
  for (Body<D>& body : bodies) {
    body.radius = std::max(0.1, std::pow(10.0, -unit(random)));
    for (int axis = 0; axis < D; ++axis) body.x[axis] = low[axis] - 0.5 + (high[axis] - low[axis] + 1.0) * unit(random);
  }
  bodies[0].radius = 1.0;
  bodies[1].radius = 0.1;
  return bodies;
}

TEST(CellLevels, a_body_is_on_the_coarsest_mesh_not_larger_than_its_radius) {
  const CellLevels<2> levels({{0.0, 0.0}}, {{8.0, 8.0}}, 1.0, 0.1);  // meshes 1, 1/2, 1/4, 1/8, 1/16
  EXPECT_EQ(levels.level_count(), 5);
  EXPECT_EQ(levels.level_of(1.0), 0);
  EXPECT_EQ(levels.level_of(0.99), 1);
  EXPECT_EQ(levels.level_of(0.5), 1);
  EXPECT_EQ(levels.level_of(0.3), 2);
  EXPECT_EQ(levels.level_of(0.125), 3);
  EXPECT_EQ(levels.level_of(0.1), 4);
  const CellLevels<3> single({{0.0, 0.0, 0.0}}, {{8.0, 8.0, 8.0}}, 0.7, 0.7);
  EXPECT_EQ(single.level_count(), 1);
  EXPECT_EQ(single.level_of(0.7), 0);
}

/// True neighbours are all found, once; a body on a mesh is visited only if its cell touches the reach. The mesh is not
/// larger than its radius, and a whole number of cells in the region not twice as wide as the mesh.
template <int D>
void expect_neighbours(const Vec<D, double>& low, const Vec<D, double>& high, int count, double gap,
                       double largest_share) {
  const std::vector<Body<D>> bodies = scatter(low, high, count);
  CellLevels<D> levels(low, high, 1.0, 0.1);
  std::vector<double> largest(static_cast<std::size_t>(levels.level_count()), 0.0);
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    levels.add(i, bodies[i].x, bodies[i].radius);
    double& radius = largest[static_cast<std::size_t>(levels.level_of(bodies[i].radius))];
    radius = std::max(radius, bodies[i].radius);
  }
  std::size_t visits = 0, neighbours = 0;
  for (const Body<D>& one : bodies) {
    std::vector<int> visited(bodies.size(), 0);
    levels.for_each_near(one.x, one.radius, gap, [&](std::uint32_t i) { ++visited[i]; });
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const Body<D>& other = bodies[i];
      const Vec<D, double> r = one.x - other.x;
      const double touch = one.radius + other.radius + gap;
      visits += static_cast<std::size_t>(visited[i]);
      ASSERT_LE(visited[i], 1);
      if (dot(r, r) < touch * touch) {
        ++neighbours;
        ASSERT_EQ(visited[i], 1);
      }
      if (visited[i] == 0) continue;
      const double reach = one.radius + gap + largest[static_cast<std::size_t>(levels.level_of(other.radius))];
      for (int axis = 0; axis < D; ++axis) {
        const bool outside = other.x[axis] < low[axis] || other.x[axis] > high[axis] || one.x[axis] < low[axis] ||
                             one.x[axis] > high[axis];
        if (outside) continue;
        ASSERT_LE(std::fabs(r[axis]), reach + 2.0 * other.radius + 1e-12);
      }
    }
  }
  EXPECT_GT(neighbours, bodies.size());  // each finds itself, and some of them others
  EXPECT_LT(static_cast<double>(visits), largest_share * static_cast<double>(bodies.size() * bodies.size()));
}

TEST(CellLevels, bodies_of_1_to_10_in_size_find_all_their_neighbours_and_few_others) {
  // A body reaches at most 2 + gap and a cell of 1: a square of side 2 (2 + 0.3 + 1) in 30 x 19.3 is 8 % of the area,
  // and the mean radius is 0.39 rather than 1.
  expect_neighbours<2>({{-3.0, 4.0}}, {{27.0, 23.3}}, 800, 0.3, 0.04);
  expect_neighbours<3>({{-3.0, 4.0, 0.0}}, {{9.0, 17.5, 11.3}}, 800, 0.1, 0.04);
}

TEST(CellLevels, a_mesh_that_is_fine_for_its_region_finds_the_same_with_wider_cells) {
  // A region of 10^5 and a mesh of 1/4 would have 10^11 cells.
  CellLevels<2> levels({{0.0, 0.0}}, {{1e5, 1e5}}, 0.25, 0.25);
  levels.add(0, {{5e4, 5e4}}, 0.25);
  levels.add(1, {{5e4 + 0.4, 5e4}}, 0.25);
  levels.add(2, {{9e4, 9e4}}, 0.25);
  std::vector<std::uint32_t> visited;
  levels.for_each_near({{5e4, 5e4}}, 0.25, 0.0, [&](std::uint32_t i) { visited.push_back(i); });
  EXPECT_EQ(visited, (std::vector<std::uint32_t>{0, 1}));
}

TEST(CellLevels, a_small_region_still_works_and_clear_forgets) {
  expect_neighbours<2>({{0.0, 0.0}}, {{0.6, 0.4}}, 30, 0.0, 1.1);
  CellLevels<2> levels({{0.0, 0.0}}, {{5.0, 5.0}}, 1.0, 0.5);
  levels.add(3, {{1.0, 1.0}}, 1.0);
  levels.clear();
  int visits = 0;
  levels.for_each_near({{1.0, 1.0}}, 1.0, 1.0, [&](std::uint32_t) { ++visits; });
  EXPECT_EQ(visits, 0);
}

}  // namespace
}  // namespace mappm
