// Oracles: the regions' own `contains`, the mutual view of neighbours, and borders worked by hand.
#include "parallel/domains.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "base/error.hpp"

namespace mappm {
namespace {

template <int D>
using Cuts = std::array<std::vector<double>, D>;

/// A model of a box with sides in rcut; with solids of this reach, or none.
template <int D>
Model<D> box_model(const Vec<D, double>& box, double reach = 0.0, double contact_reach = 0.0) {
  Model<D> model;
  model.box = box;
  for (int axis = 0; axis < D; ++axis) model.pair.length[axis] = box[axis] / box_quanta;
  model.terms.solids = reach > 0.0;
  model.largest_reach = reach;
  model.largest_contact_reach = contact_reach;
  return model;
}

std::vector<double> fractions(std::initializer_list<double> values) {
  std::vector<double> cuts;
  for (const double value : values) cuts.push_back(std::floor(value * box_quanta));
  return cuts;
}

/// Every position on and beside a border, and random ones, lies in exactly one region: that of its owner.
template <int D>
void expect_partition(const Domains<D>& domains) {
  int product = 1;
  for (int axis = 0; axis < D; ++axis) product *= domains.grid()[axis];
  ASSERT_EQ(domains.count(), product);
  std::array<std::vector<double>, D> positions;
  std::mt19937_64 random(3);
  for (int axis = 0; axis < D; ++axis) {
    auto& values = positions[static_cast<std::size_t>(axis)];
    for (const double cut : domains.cuts()[static_cast<std::size_t>(axis)])
      for (const double x : {cut - 1.0, cut, cut + 1.0})
        if (x >= 0.0 && x < box_quanta) values.push_back(x);
    for (int n = 0; n < 5; ++n) values.push_back(static_cast<double>(random() >> 12));
  }
  for (int n = 0; n < 20000; ++n) {
    Vec<D, double> x;
    for (int axis = 0; axis < D; ++axis) {
      const auto& values = positions[static_cast<std::size_t>(axis)];
      x[axis] = values[random() % values.size()];
    }
    const int owner = domains.owner(x);
    for (int rank = 0; rank < domains.count(); ++rank)
      ASSERT_EQ(domains.region(rank).contains(x), rank == owner) << "rank " << rank;
  }
  double volume = 0.0;
  for (int rank = 0; rank < domains.count(); ++rank) {
    double share = 1.0;
    for (int axis = 0; axis < D; ++axis)
      share *= (domains.region(rank).high[axis] - domains.region(rank).low[axis]) / box_quanta;
    volume += share;
  }
  EXPECT_NEAR(volume, 1.0, 1e-14);  // a product of a few roundings each
}

/// A neighbour's region seen from here is its own region moved by the shift, borders this one, and sees this one back.
template <int D>
void expect_mutual_images(const Domains<D>& domains) {
  for (int rank = 0; rank < domains.count(); ++rank) {
    const std::vector<int> partners = domains.partners(rank);
    ASSERT_TRUE(std::is_sorted(partners.begin(), partners.end()));
    ASSERT_EQ(std::adjacent_find(partners.begin(), partners.end()), partners.end());
    const auto images = domains.images(rank);
    ASSERT_EQ(images.size(), D == 2 ? 8u : 26u);
    for (const Image<D>& image : images) {
      const int other = partners.at(static_cast<std::size_t>(image.partner));
      const Region<D> own = domains.region(rank), theirs = domains.region(other);
      for (int axis = 0; axis < D; ++axis) {
        ASSERT_EQ(image.region.low[axis] + image.shift[axis], theirs.low[axis]);
        ASSERT_EQ(image.region.high[axis] + image.shift[axis], theirs.high[axis]);
        const bool below = image.region.high[axis] == own.low[axis];
        const bool above = image.region.low[axis] == own.high[axis];
        const bool level = image.region.low[axis] == own.low[axis] && image.region.high[axis] == own.high[axis];
        ASSERT_EQ(int{below} + int{above} + int{level}, 1);
      }
      const auto back = domains.partners(other);
      const auto views = domains.images(other);
      ASSERT_TRUE(std::any_of(views.begin(), views.end(), [&](const Image<D>& view) {
        return back[static_cast<std::size_t>(view.partner)] == rank && view.shift == -image.shift;
      }));
    }
  }
}

TEST(Domains, even_grids_partition_the_box_and_see_each_other) {
  const Model<2> plane = box_model<2>({{30.0, 28.0}});
  for (const char* grid : {"1x1", "2x1", "1x3", "3x7", "2x2", "5x4"}) {
    SCOPED_TRACE(grid);
    int processes = 1;
    for (const char* at = grid; *at != '\0'; ++at)
      if (*at != 'x') processes *= *at - '0';
    const Domains<2> domains = make_domains<2>(plane, processes, grid);
    expect_partition(domains);
    expect_mutual_images(domains);
  }
  const Model<3> space = box_model<3>({{9.0, 8.0, 12.0}});
  for (const char* grid : {"1x1x1", "2x1x3", "3x3x3", "1x2x2"}) {
    SCOPED_TRACE(grid);
    int processes = 1;
    for (const char* at = grid; *at != '\0'; ++at)
      if (*at != 'x') processes *= *at - '0';
    const Domains<3> domains = make_domains<3>(space, processes, grid);
    expect_partition(domains);
    expect_mutual_images(domains);
  }
}

TEST(Domains, uneven_cuts_partition_the_box_and_see_each_other) {
  const Domains<2> plane(Cuts<2>{fractions({0.0, 0.1, 0.7, 1.0}), fractions({0.0, 0.333, 1.0})});
  expect_partition(plane);
  expect_mutual_images(plane);
  EXPECT_EQ(plane.region(4).low[0], std::floor(0.1 * box_quanta));  // coordinates (1, 1)
  EXPECT_EQ(plane.region(4).low[1], std::floor(0.333 * box_quanta));
  const Domains<3> space(Cuts<3>{fractions({0.0, 0.6, 1.0}), fractions({0.0, 0.25, 0.5, 1.0}), fractions({0.0, 1.0})});
  expect_partition(space);
  expect_mutual_images(space);
}

TEST(Domains, owner_takes_positions_of_any_frame) {
  const Domains<2> domains(Cuts<2>{fractions({0.0, 0.25, 1.0}), fractions({0.0, 1.0})});
  EXPECT_EQ(domains.owner({{-1.0, 5.0}}), 1);
  EXPECT_EQ(domains.owner({{box_quanta, 5.0}}), 0);
  EXPECT_EQ(domains.owner({{1.25 * box_quanta, -5.0}}), 1);
  EXPECT_EQ(domains.owner({{-box_quanta, 5.0}}), 0);
}

TEST(Domains, slabs_along_the_longest_side_are_the_default) {
  EXPECT_EQ(make_domains<2>(box_model<2>({{30.0, 10.0}}), 4, "").grid(), (Vec<2, int>{{4, 1}}));
  EXPECT_EQ(make_domains<2>(box_model<2>({{10.0, 30.0}}), 4, "").grid(), (Vec<2, int>{{1, 4}}));
  EXPECT_EQ(make_domains<3>(box_model<3>({{10.0, 11.0, 12.0}}), 3, "").grid(), (Vec<3, int>{{1, 1, 3}}));
  EXPECT_EQ(make_domains<2>(box_model<2>({{10.0, 10.0}}), 2, "").grid(), (Vec<2, int>{{1, 2}}));
  EXPECT_EQ(make_domains<3>(box_model<3>({{12.0, 12.0, 10.0}}), 3, "").grid(), (Vec<3, int>{{1, 3, 1}}));
  EXPECT_EQ(make_domains<3>(box_model<3>({{10.0, 11.0, 12.0}}), 12, "2x2x3").grid(), (Vec<3, int>{{2, 2, 3}}));
}

template <int D>
std::string refusal(const Model<D>& model, int processes, const std::string& grid) {
  try {
    make_domains<D>(model, processes, grid);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DomainErrors, a_grid_that_does_not_match_the_processes) {
  EXPECT_EQ(refusal(box_model<2>({{30.0, 30.0}}), 4, "2x3"),
            "command line: --domains = 2x3: 6 domains do not match 4 processes; start mpirun with -np 6");
}

TEST(DomainErrors, bad_syntax) {
  for (const std::string text :
       {"2", "2x", "x2", "2x2x1", "axb", "0x4", "-2x-2", "2 x2y", "2,2", "99999999999x1", "2000000x2000000"})
    EXPECT_EQ(refusal(box_model<2>({{30.0, 30.0}}), 4, text),
              "command line: --domains = " + text + ": expected 2 positive numbers such as 2x4");
  EXPECT_EQ(refusal(box_model<3>({{30.0, 30.0, 30.0}}), 4, "2x2"),
            "command line: --domains = 2x2: expected 3 positive numbers such as 2x2x1");
}

TEST(DomainErrors, more_processes_than_the_cutoff_allows) {
  // 10 rcut in 9 slabs of 1.11; PPs need 1.25, so 8 at most.
  EXPECT_EQ(
      refusal(box_model<2>({{10.0, 4.0}}), 9, ""),
      "command line: --domains = 9 along x: a domain would be 1.11 rcut wide, but the margin of the PPs needs 1.25; "
      "use at most 8 domains along this axis");
  EXPECT_EQ(refusal(box_model<2>({{10.0, 4.0}}), 8, ""), "accepted");
}

TEST(DomainErrors, a_domain_that_the_solids_do_not_fit) {
  // Contacts of solids of radius 2 reach 4: with the quarter that they move, 4.25.
  EXPECT_EQ(
      refusal(box_model<2>({{10.0, 12.0}}, 2.0, 2.0), 4, "1x4"),
      "command line: --domains = 4 along y: a domain would be 3 rcut wide, but a solid (h > 2R) needs 4.25; use at "
      "most 2 domains along this axis");
  EXPECT_EQ(refusal(box_model<2>({{10.0, 12.0}}, 2.0, 2.0), 2, "1x2"), "accepted");
}

TEST(SolidMargin, by_hand) {
  EXPECT_EQ(solid_margin(box_model<2>({{9.0, 9.0}})), 0.0);
  EXPECT_EQ(solid_margin(box_model<2>({{9.0, 9.0}}, 0.5, 0.5)), 1.75);  // its FPs and their neighbours: R + rcut
  EXPECT_EQ(solid_margin(box_model<2>({{9.0, 9.0}}, 3.0, 3.0)), 6.25);  // contacts: 2 R
  EXPECT_EQ(solid_margin(box_model<2>({{9.0, 9.0}}, 3.0, 0.0)), 4.25);  // a wall's pieces have none
}

TEST(Balanced, by_hand) {
  // Half of 12 particles lie in the first of four bins: the cut goes to its end.
  const Model<2> model = box_model<2>({{8.0, 16.0}});
  const Domains<2> even = make_domains<2>(model, 2, "2x1");
  const std::vector<std::uint64_t> flat(4, 3);
  EXPECT_EQ((balanced<2>(model, even, {std::vector<std::uint64_t>{6, 2, 2, 2}, flat}).cuts()[0]),
            (std::vector<double>{0.0, 0.25 * box_quanta, box_quanta}));
  // Half of 8 lies 2/4 into the second bin: 1/4 + 1/8.
  EXPECT_EQ((balanced<2>(model, even, {std::vector<std::uint64_t>{2, 4, 1, 1}, flat}).cuts()[0]),
            (std::vector<double>{0.0, 0.375 * box_quanta, box_quanta}));
  const auto unchanged = balanced<2>(model, even, {flat, flat}).cuts();
  EXPECT_EQ(unchanged, even.cuts());
}

TEST(Balanced, three_domains_and_an_empty_stretch) {
  // 12 particles, 4 a domain: the first four bins hold 4, so the cuts fall at its end and at that of the sixth.
  const Model<2> model = box_model<2>({{16.0, 16.0}});
  const Domains<2> even = make_domains<2>(model, 3, "1x3");
  const std::vector<std::uint64_t> bins{1, 1, 1, 1, 2, 2, 1, 3};
  const auto cuts = balanced<2>(model, even, {bins, bins}).cuts();
  EXPECT_EQ(cuts[1], (std::vector<double>{0.0, 0.5 * box_quanta, 0.75 * box_quanta, box_quanta}));
  EXPECT_EQ(cuts[0], even.cuts()[0]);
}

TEST(Balanced, keeps_the_smallest_allowed_domain) {
  // All particles at the end: the last domain shrinks to 1.25 rcut of 8 only.
  const Model<2> model = box_model<2>({{8.0, 16.0}});
  const Domains<2> even = make_domains<2>(model, 2, "2x1");
  const std::vector<std::uint64_t> flat(4, 3);
  const double smallest = 1.25 / 8.0 * box_quanta;
  EXPECT_EQ((balanced<2>(model, even, {std::vector<std::uint64_t>{0, 0, 0, 0, 0, 0, 0, 9}, flat}).cuts()[0][1]),
            box_quanta - smallest);
  EXPECT_EQ((balanced<2>(model, even, {std::vector<std::uint64_t>{9, 0, 0, 0, 0, 0, 0, 0}, flat}).cuts()[0][1]),
            smallest);
  // No particles at all: as small as allowed, and still a partition.
  expect_partition(balanced<2>(model, even, {std::vector<std::uint64_t>(8, 0), flat}));
}

}  // namespace
}  // namespace mappm
