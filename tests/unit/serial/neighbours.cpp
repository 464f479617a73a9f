// Oracle: all pairs.
#include "serial/neighbours.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace mappm {
namespace {

template <int D>
double distance(const Vec<D, double>& box, const Vec<D, double>& a, const Vec<D, double>& b) {
  Vec<D, double> r;
  for (int axis = 0; axis < D; ++axis) r[axis] = nearest_difference(a[axis], b[axis]) * box[axis] / box_quanta;
  return std::sqrt(dot(r, r));
}

/// Points all over the box, a quarter of their coordinates at its ends.
template <int D>
std::vector<Vec<D, double>> scatter(int count) {
  std::mt19937_64 random(4);
  std::vector<Vec<D, double>> points(static_cast<std::size_t>(count));
  const double ends[] = {0.0, 1.0, box_quanta - 1.0, box_quanta / 2.0};
  for (auto& x : points)
    for (int axis = 0; axis < D; ++axis)
      x[axis] = random() % 4 == 0 ? ends[random() % 4] : static_cast<double>(random() >> 12);
  return points;
}

/// Both searches find every point within the cutoff, once each; the cells look at a share of all.
template <int D>
void expect_same_neighbours(const Vec<D, double>& box, double largest_share) {
  const auto points = scatter<D>(600);
  NeighbourSearch<D> cells(box, Neighbours::cells), all(box, Neighbours::all_pairs);
  for (int repeat = 0; repeat < 2; ++repeat) {  // the second time after `clear`
    cells.clear();
    all.clear();
    for (const auto& x : points) {
      cells.add(x);
      all.add(x);
    }
  }
  std::size_t visits = 0;
  for (const auto& x : points) {
    std::multiset<int> near_by_cells, near_by_pairs, near;
    cells.for_each_near(x, [&](int k) {
      ++visits;
      if (distance<D>(box, x, points[static_cast<std::size_t>(k)]) < 1.0) near_by_cells.insert(k);
    });
    all.for_each_near(x, [&](int k) {
      if (distance<D>(box, x, points[static_cast<std::size_t>(k)]) < 1.0) near_by_pairs.insert(k);
    });
    for (int k = 0; k < static_cast<int>(points.size()); ++k)
      if (distance<D>(box, x, points[static_cast<std::size_t>(k)]) < 1.0) near.insert(k);
    ASSERT_EQ(near_by_cells, near);
    ASSERT_EQ(near_by_pairs, near);
  }
  EXPECT_LE(static_cast<double>(visits), largest_share * 600.0 * 600.0);
}

TEST(NeighbourSearch, cells_find_what_all_pairs_find) {
  // Of 7 x 5 cells (7 x 5 x 4) nine (27) are looked at: 26 % (19 %); points at the ends crowd some of them.
  expect_same_neighbours<2>({{7.9, 5.1}}, 0.4);
  expect_same_neighbours<3>({{7.0001, 5.5, 4.99}}, 0.4);
  expect_same_neighbours<2>({{3.0, 3.5}}, 1.0);  // just below three cells on one side
}

TEST(NeighbourSearch, a_box_of_less_than_three_cells_takes_all_pairs) {
  expect_same_neighbours<2>({{2.1, 9.0}}, 1.0);
  expect_same_neighbours<3>({{5.0, 2.5, 5.0}}, 1.0);
}

}  // namespace
}  // namespace mappm
