// Oracles: a comparison of all pairs, the region's own `contains`, and values worked by hand.
#include "particles/cell_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

namespace mappm {
namespace {

template <int D>
Vec<D, double> cells_per_cutoff(double along, double across) {
  Vec<D, double> cells;
  cells[0] = along;
  for (int axis = 1; axis < D; ++axis) cells[axis] = across;
  return cells;
}

/// A region inside the box whose borders are no round numbers.
template <int D>
struct Site {
  Region<D> region;
  Vec<D, double> length;

  explicit Site(double side_in_cutoffs) {
    for (int axis = 0; axis < D; ++axis) {
      length[axis] = (9.0 + axis) / box_quanta;
      region.low[axis] = std::floor(box_quanta / 7.0) + 3.0 * axis + 1.0;
      region.high[axis] = region.low[axis] + std::floor((side_in_cutoffs + 0.31 * axis) / length[axis]);
    }
  }
  double margin(int axis) const { return std::ceil(1.0 / length[axis]); }
};

/// Particles all over the region and its margin of rcut, a quarter of them on a border or one quantum beside it. Every
/// field is a function of the id, so that a mixed-up row shows.
template <int D>
FluidParticles<D> scatter(const Site<D>& site, std::size_t count) {
  std::mt19937_64 random(20240611);
  FluidParticles<D> fluid;
  fluid.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    fluid.id[i] = 1000 + i;
    for (int axis = 0; axis < D; ++axis) {
      const double low = site.region.low[axis], high = site.region.high[axis], margin = site.margin(axis);
      const double borders[] = {low - margin, low - 1.0, low,        low + 1.0,
                                high - 1.0,   high,      high + 1.0, high + margin - 1.0};
      std::uniform_real_distribution<double> anywhere(low - margin, high + margin);
      fluid.x(axis)[i] = random() % 4 == 0 ? borders[random() % 8] : std::floor(anywhere(random));
      fluid.v(axis)[i] = static_cast<double>(i) + 0.25 * axis;
    }
  }
  return fluid;
}

template <int D>
Vec<D, double> position(const FluidParticles<D>& fluid, std::size_t i) {
  Vec<D, double> x;
  for (int axis = 0; axis < D; ++axis) x[axis] = fluid.x(axis)[i];
  return x;
}

template <int D>
bool is_inner(const CellGrid<D>& grid, const Vec<D, double>& x) {
  for (int axis = 0; axis < D; ++axis)
    if (!grid.is_inner(axis, grid.coordinate(axis, x[axis]))) return false;
  return true;
}

template <int D>
void expect_all_pairs_in_reach(double side, double per_cutoff) {
  SCOPED_TRACE(::testing::Message() << D << "D, side " << side << ", cells to a cutoff " << per_cutoff);
  const Site<D> site(side);
  CellGrid<D> grid;
  grid.fit(site.region, site.length, cells_per_cutoff<D>(per_cutoff + 2, per_cutoff));
  const FluidParticles<D> fluid = scatter(site, 700);
  int pairs = 0;
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    if (!site.region.contains(position(fluid, i))) continue;
    for (std::size_t j = 0; j < fluid.size(); ++j) {
      double square = 0.0;
      Vec<D, double> distance;
      for (int axis = 0; axis < D; ++axis) {
        distance[axis] = std::fabs(fluid.x(axis)[i] - fluid.x(axis)[j]) * site.length[axis];
        square += distance[axis] * distance[axis];
      }
      if (square >= 1.0) continue;
      ++pairs;
      for (int axis = 0; axis < D; ++axis) {
        const int apart = std::abs(grid.coordinate(axis, fluid.x(axis)[i]) - grid.coordinate(axis, fluid.x(axis)[j]));
        ASSERT_LE(apart, grid.margin(axis));
        // Cells that lie `apart` leave apart - 1 whole cells between; the rounding of a cell coordinate is 1e-15.
        ASSERT_LE((apart - 1) * grid.width(axis), distance[axis] + 1e-12);
      }
    }
  }
  EXPECT_GT(pairs, 1000);
}

TEST(CellGrid, every_pair_within_the_cutoff_of_an_owned_particle_is_in_reach) {
  for (const double side : {1.25, 2.0, 3.7})
    for (const double per_cutoff : {1.0, 1.45, 1.9, 2.0, 2.3, 3.0}) {
      expect_all_pairs_in_reach<2>(side, per_cutoff);
      expect_all_pairs_in_reach<3>(side, per_cutoff);
    }
}

template <int D>
void expect_exact_ownership(const Site<D>& site, double per_cutoff) {
  CellGrid<D> grid;
  grid.fit(site.region, site.length, cells_per_cutoff<D>(per_cutoff + 2, per_cutoff));
  for (int axis = 0; axis < D; ++axis) {
    const double low = site.region.low[axis], high = site.region.high[axis];
    EXPECT_FALSE(grid.is_inner(axis, grid.coordinate(axis, low - 1.0)));
    EXPECT_TRUE(grid.is_inner(axis, grid.coordinate(axis, low)));
    EXPECT_TRUE(grid.is_inner(axis, grid.coordinate(axis, high - 1.0)));
    EXPECT_FALSE(grid.is_inner(axis, grid.coordinate(axis, high)));
    EXPECT_EQ(grid.coordinate(axis, low), grid.margin(axis));
    EXPECT_EQ(grid.coordinate(axis, high - 1.0), grid.margin(axis) + grid.inner(axis) - 1);
  }
  const FluidParticles<D> fluid = scatter(site, 3000);
  for (std::size_t i = 0; i < fluid.size(); ++i)
    ASSERT_EQ(is_inner(grid, position(fluid, i)), site.region.contains(position(fluid, i)));
}

TEST(CellGrid, ownership_by_cell_is_exact_at_the_borders) {
  for (double side = 1.25; side < 6.0; side += 0.37)
    for (const double per_cutoff : {1.0, 1.45, 3.0}) {
      expect_exact_ownership(Site<2>(side), per_cutoff);
      expect_exact_ownership(Site<3>(side), per_cutoff);
    }
}

TEST(CellGrid, cells_by_hand) {
  // A box of 6 x 4 rcut as one region, three cells to a cutoff: a hair wider than 1/3, so 17 and 11 inner cells.
  CellGrid<2> grid;
  grid.fit(Region<2>::whole_box(), {{6.0 / box_quanta, 4.0 / box_quanta}}, cells_per_cutoff<2>(3, 3));
  EXPECT_EQ(grid.inner(0), 17);
  EXPECT_EQ(grid.inner(1), 11);
  EXPECT_EQ(grid.count(0), 23);
  EXPECT_EQ(grid.count(1), 17);
  EXPECT_DOUBLE_EQ(grid.width(0), 6.0 / 17.0);
  EXPECT_EQ(grid.row({{5, 2}}), 2u * 23u);
  EXPECT_EQ(grid.coordinate(0, std::floor(box_quanta * 2.5 / 17.0)), 3 + 2);
  // Beyond the margin a particle is kept in the outermost cell.
  EXPECT_EQ(grid.coordinate(0, -0.9 * box_quanta), 0);
  EXPECT_EQ(grid.coordinate(0, 1.9 * box_quanta), 22);
  // 1.4 cells to a cutoff are 8.4 and 5.6 cells, and two of them reach as far. Of 1.95 there would be 11.7 and 7.8, but
  // 12 and 8 would not, for want of a hair.
  grid.fit(Region<2>::whole_box(), {{6.0 / box_quanta, 4.0 / box_quanta}}, cells_per_cutoff<2>(1.4, 1.4));
  EXPECT_EQ(grid.inner(0), 8);
  EXPECT_EQ(grid.inner(1), 6);
  EXPECT_EQ(grid.margin(0), 2);
  grid.fit(Region<2>::whole_box(), {{6.0 / box_quanta, 4.0 / box_quanta}}, cells_per_cutoff<2>(1.95, 1.95));
  EXPECT_EQ(grid.inner(0), 11);
  EXPECT_EQ(grid.inner(1), 7);
}

template <int D>
void expect_sorted_permutation() {
  const Site<D> site(2.6);
  CellGrid<D> grid;
  grid.fit(site.region, site.length, cells_per_cutoff<D>(3, 3));
  const FluidParticles<D> before = scatter(site, 2000);
  FluidParticles<D> after = before;
  grid.sort(after);
  ASSERT_EQ(after.size(), before.size());
  std::vector<bool> seen(before.size(), false);
  for (std::size_t i = 0; i < after.size(); ++i) {
    const std::size_t origin = after.id[i] - 1000;
    ASSERT_LT(origin, before.size());
    ASSERT_FALSE(seen[origin]);
    seen[origin] = true;
    for (std::size_t f = 0; f < after.field.size(); ++f) ASSERT_EQ(after.field[f][i], before.field[f][origin]);
  }
  std::size_t in_cells = 0;
  Vec<D, int> cell;
  std::size_t cells = 1;
  for (int axis = 0; axis < D; ++axis) cells *= static_cast<std::size_t>(grid.count(axis));
  for (std::size_t c = 0; c < cells; ++c) {
    std::size_t rest = c;
    for (int axis = 0; axis < D; ++axis) {
      cell[axis] = static_cast<int>(rest % static_cast<std::size_t>(grid.count(axis)));
      rest /= static_cast<std::size_t>(grid.count(axis));
    }
    ASSERT_EQ(grid.row(cell) + static_cast<std::size_t>(cell[0]), c);
    ASSERT_LE(grid.start(c), grid.start(c + 1));
    for (std::size_t i = grid.start(c); i < grid.start(c + 1); ++i, ++in_cells)
      for (int axis = 0; axis < D; ++axis) ASSERT_EQ(grid.coordinate(axis, after.x(axis)[i]), cell[axis]);
  }
  EXPECT_EQ(in_cells, after.size());
}

TEST(CellGrid, sort_is_a_permutation_into_cell_order) {
  expect_sorted_permutation<2>();
  expect_sorted_permutation<3>();
}

TEST(CellGrid, sorts_nothing_and_sorts_again) {
  const Site<2> site(2.0);
  CellGrid<2> grid;
  grid.fit(site.region, site.length, cells_per_cutoff<2>(2, 2));
  FluidParticles<2> none;
  grid.sort(none);
  EXPECT_EQ(grid.start(static_cast<std::size_t>(grid.count(0) * grid.count(1))), 0u);
  FluidParticles<2> some = scatter(site, 300);
  grid.sort(some);
  const std::vector<std::uint64_t> order = some.id;
  grid.sort(some);
  EXPECT_EQ(some.id, order);  // stable
}

}  // namespace
}  // namespace mappm
