// PPs placed by hand around one border of a region, and messages written by hand.
#include "parallel/residents.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "parallel/communicator.hpp"
#include "unit/serial/scenes.hpp"

namespace mappm {
namespace {

/// Lengths are given in rcut. The region reaches from 4 to 8 along x, and a neighbour lies below it.
class ResidentsTest : public ::testing::Test {
 protected:
  struct PP {
    std::uint64_t id;
    double x, y = 5.0;
  };

  ResidentsTest()
      : built_(testing::head("[12.0, 10.8]", "0.3", "11.1111111111")),
        region_{{{quanta(0, 4.0), 0.0}}, {{quanta(0, 8.0), box_quanta}}},
        below_{{{quanta(0, 0.0), 0.0}}, {{quanta(0, 4.0), box_quanta}}},
        residents_(built_.model, region_, {{widened(built_.model, below_, 1.0 + skin), std::nullopt}}) {}

  double quanta(int axis, double length) const { return std::floor(length / built_.model.pair.length[axis]); }
  double length(int axis, double quanta) const { return quanta * built_.model.pair.length[axis]; }

  void settle(const std::vector<PP>& particles) {
    for (const PP& pp : particles) {
      fluid_.id.push_back(pp.id);
      for (auto& values : fluid_.field) values.push_back(0.0);
      fluid_.x(0).back() = quanta(0, pp.x);
      fluid_.x(1).back() = quanta(1, pp.y);
      fluid_.v(0).back() = 1.0;
    }
    residents_.settle(fluid_, StayLength::several_steps);
  }
  /// Moves an own PP along x, as a step does.
  void move(std::uint32_t i, double x) {
    residents_.schedule().owned_moved(std::abs(x - length(0, fluid_.x(0)[i])));
    fluid_.x(0)[i] = quanta(0, x);
  }
  bool receive(const std::vector<PP>& particles) {
    Buffer buffer;
    put(buffer, static_cast<std::uint64_t>(particles.size()));
    for (const PP& pp : particles) put(buffer, pp.id);
    for (std::size_t field = 0; field < fluid_.field.size(); ++field)
      for (const PP& pp : particles) put(buffer, field == 0 ? quanta(0, pp.x) : field == 1 ? quanta(1, pp.y) : 7.0);
    std::vector<BufferReader> readers{BufferReader(buffer)};
    const bool stay = residents_.schedule().lasts() && residents_.refresh(fluid_, readers);
    EXPECT_TRUE(!stay || readers[0].at_end());
    return stay;
  }
  struct Density {
    std::uint64_t id;
    double value;
  };
  void take(const std::vector<Density>& given, std::vector<double>& density) {
    Buffer buffer;
    put(buffer, static_cast<std::uint64_t>(given.size()));
    for (const Density& one : given) put(buffer, one.id);
    for (const Density& one : given) put(buffer, one.value);
    BufferReader reader(buffer);
    residents_.take_densities(0, reader, density);
    EXPECT_TRUE(reader.at_end());
  }
  std::vector<std::uint64_t> sent() const {
    std::vector<std::uint32_t> chosen;
    residents_.select(fluid_, 0, chosen);
    std::vector<std::uint64_t> ids;
    for (const std::uint32_t i : chosen) ids.push_back(fluid_.id[i]);
    return ids;
  }
  std::vector<std::uint64_t> owned_after_leaving() {
    residents_.leave(fluid_);
    return fluid_.id;
  }

  testing::Built<2> built_;
  Region<2> region_, below_;
  Residents<2> residents_;
  FluidParticles<2> fluid_;
};

using Ids = std::vector<std::uint64_t>;

TEST_F(ResidentsTest, ghosts_are_brought_up_to_date_in_their_places) {
  settle({{1, 6.0}, {2, 4.5}, {3, 3.9}, {4, 3.0}});
  ASSERT_TRUE(receive({{4, 3.02}, {3, 3.91}}));
  EXPECT_EQ(fluid_.x(0)[2], quanta(0, 3.91));
  EXPECT_EQ(fluid_.x(0)[3], quanta(0, 3.02));
  EXPECT_EQ(fluid_.v(0)[3], 7.0);
  EXPECT_EQ(fluid_.v(0)[1], 1.0);
  // Again, in another order and one fewer: 4 has gone far enough away.
  fluid_.x(0)[3] = quanta(0, 2.94);
  ASSERT_TRUE(receive({{3, 3.92}}));
  EXPECT_EQ(fluid_.x(0)[2], quanta(0, 3.92));
  EXPECT_EQ(owned_after_leaving(), (Ids{1, 2}));
}

TEST_F(ResidentsTest, images_of_one_particle_are_told_apart_by_their_places) {
  settle({{1, 6.0}, {3, 3.9, 5.0}, {3, 3.9, -0.5}});
  ASSERT_TRUE(receive({{3, 3.92, -0.49}, {3, 3.92, 5.01}}));
  EXPECT_EQ(fluid_.x(1)[1], quanta(1, 5.01));
  EXPECT_EQ(fluid_.x(1)[2], quanta(1, -0.49));
}

TEST_F(ResidentsTest, densities_of_ghosts_are_taken_by_their_ids) {
  settle({{1, 6.0}, {2, 4.5}, {3, 3.9}, {4, 3.0}});
  std::vector<double> density{10.0, 11.0, 0.0, 0.0};
  take({{4, 14.0}, {3, 13.0}}, density);
  EXPECT_EQ(density, (std::vector<double>{10.0, 11.0, 13.0, 14.0}));
  take({{4, 24.0}, {3, 23.0}}, density);  // in the same order
  EXPECT_EQ(density, (std::vector<double>{10.0, 11.0, 23.0, 24.0}));
  take({{3, 33.0}, {9, 39.0}}, density);  // in another, one fewer, and one that is not here
  EXPECT_EQ(density, (std::vector<double>{10.0, 11.0, 33.0, 24.0}));
}

TEST_F(ResidentsTest, all_images_of_one_particle_have_its_density) {
  settle({{1, 6.0}, {3, 3.9, 5.0}, {3, 3.9, -0.5}});
  std::vector<double> density{10.0, 0.0, 0.0};
  take({{3, 13.0}}, density);
  EXPECT_EQ(density, (std::vector<double>{10.0, 13.0, 13.0}));
}

TEST_F(ResidentsTest, others_are_those_that_lie_outside_the_region_now) {
  settle({{1, 6.0}, {2, 4.01}, {3, 3.99}, {4, 3.5}});
  const auto others = [&] {
    std::vector<std::uint32_t> found = residents_.others();
    std::ranges::sort(found);
    return found;
  };
  EXPECT_EQ(others(), (std::vector<std::uint32_t>{2, 3}));
  move(1, 3.98);
  ASSERT_TRUE(receive({{3, 4.01}, {4, 3.5}}));
  EXPECT_EQ(others(), (std::vector<std::uint32_t>{1, 3}));
}

TEST_F(ResidentsTest, what_is_sent_follows_from_places_and_owners) {
  settle({{1, 7.0}, {2, 5.14}, {3, 5.0}, {4, 4.02}, {5, 3.99}, {6, 3.5}});
  EXPECT_EQ(sent(), (Ids{3, 4}));  // 5 is another's, and all beyond 5.1 are not needed
  move(1, 5.14 - 0.3 * skin);
  EXPECT_EQ(sent(), (Ids{3, 4}));
  fluid_.x(0)[2] = quanta(0, 5.11);  // and 3 no longer
  EXPECT_EQ(sent(), (Ids{4}));
  fluid_.x(0)[1] = quanta(0, 5.09);
  EXPECT_EQ(sent(), (Ids{2, 4}));
}

TEST_F(ResidentsTest, a_particle_changes_its_owner_in_its_place) {
  settle({{1, 6.0}, {2, 4.01}, {3, 3.99}, {4, 3.5}});
  EXPECT_EQ(residents_.near_outside().size(), 1u);
  EXPECT_EQ(residents_.near_outside()[0], 2u);
  move(1, 3.98);  // and is sent to its next owner,
  EXPECT_EQ(sent(), (Ids{2}));
  ASSERT_TRUE(receive({{3, 4.01}, {4, 3.5}}));
  EXPECT_EQ(sent(), (Ids{3}));  // who sends it from now on
  ASSERT_TRUE(receive({{2, 3.97}, {4, 3.5}}));
  EXPECT_EQ(owned_after_leaving(), (Ids{1, 3}));
}

TEST_F(ResidentsTest, a_stay_ends_when_the_own_particles_have_moved_too_far) {
  settle({{1, 6.0}, {4, 3.5}});
  move(0, 6.0 + 0.3 * skin);
  ASSERT_TRUE(receive({{4, 3.5}}));
  move(0, 6.0 + 0.15 * skin);  // back: what counts is the sum
  ASSERT_TRUE(receive({{4, 3.5}}));
  move(0, 6.0 + 0.25 * skin);
  EXPECT_FALSE(residents_.schedule().lasts());
}

TEST_F(ResidentsTest, a_stay_ends_when_ghosts_have_moved_too_far) {
  settle({{1, 6.0}, {4, 3.5}});
  ASSERT_TRUE(receive({{4, 3.5 + 0.4 * skin}}));
  EXPECT_FALSE(receive({{4, 3.5 + 0.55 * skin}}));
}

TEST_F(ResidentsTest, of_a_step_the_largest_displacement_counts_once) {
  settle({{1, 6.0}, {4, 3.5}});
  move(0, 6.0 + 0.3 * skin);
  ASSERT_TRUE(receive({{4, 3.5 + 0.3 * skin}}));
  move(0, 6.0 + 0.4 * skin);
  EXPECT_TRUE(receive({{4, 3.5 + 0.4 * skin}}));
}

/// PPs above the border along y, and their images beyond the other one.
class OwnImages : public ResidentsTest {
 protected:
  OwnImages() : residents_(built_.model, region_, {{widened(built_.model, below(region_), 1.0 + skin), up_}}) {}

  /// PP 3 has none.
  void settle_with_images() {
    settle({{1, 6.0, 0.5}, {2, 6.0, 0.01}, {3, 6.0, 1.0 + 1.2 * skin}, {1, 6.0, 0.5}, {2, 6.0, 0.01}});
    for (const std::uint32_t image : {3u, 4u}) fluid_.x(1)[image] += box_quanta;
    residents_.settle(fluid_, StayLength::several_steps);
  }
  void move_up(std::uint32_t i, double way) {
    fluid_.x(1)[i] += quanta(1, way);
    residents_.schedule().owned_moved(std::abs(way));
  }
  bool stays() {
    std::vector<BufferReader> no_messages;
    EXPECT_TRUE(residents_.schedule().lasts());
    return residents_.refresh(fluid_, no_messages);
  }

  Residents<2> residents_;

 private:
  static constexpr Vec<2, double> up_{{0.0, box_quanta}};
  static Region<2> below(const Region<2>& region) { return {region.low - up_, region.high - up_}; }
};

TEST_F(OwnImages, move_with_their_PPs) {
  settle_with_images();
  move_up(0, 0.2 * skin);
  fluid_.v(1)[0] = 3.0;
  ASSERT_TRUE(stays());
  EXPECT_EQ(fluid_.x(1)[3], fluid_.x(1)[0] + box_quanta);
  EXPECT_EQ(fluid_.v(1)[3], 3.0);
  EXPECT_EQ(fluid_.x(1)[4], fluid_.x(1)[1] + box_quanta);
}

TEST_F(OwnImages, have_the_densities_of_their_PPs) {
  settle_with_images();
  ASSERT_TRUE(stays());
  std::vector<double> density{11.0, 12.0, 13.0, 0.0, 0.0};
  residents_.copy_densities(fluid_, density);
  EXPECT_EQ(density, (std::vector<double>{11.0, 12.0, 13.0, 11.0, 12.0}));
}

TEST_F(OwnImages, are_owned_where_their_PP_has_crossed_the_border) {
  settle_with_images();
  move_up(1, -0.2 * skin);
  ASSERT_TRUE(stays());
  EXPECT_EQ(fluid_.x(1)[4], fluid_.x(1)[1] + box_quanta);
  residents_.leave(fluid_);
  EXPECT_EQ(fluid_.id, (Ids{1, 3, 2}));
}

TEST_F(ResidentsTest, a_stay_ends_when_a_stranger_comes_near) {
  settle({{1, 6.0}, {4, 3.5}});
  EXPECT_TRUE(receive({{4, 3.5}, {9, 4.0 - 1.0 - 0.7 * skin}}));
  EXPECT_FALSE(receive({{4, 3.5}, {9, 4.0 - 1.0 - 0.3 * skin}}));
}

TEST_F(ResidentsTest, a_stay_ends_when_a_ghost_nearby_is_sent_no_more) {
  settle({{1, 6.0}, {4, 4.0 - 1.0 - 0.7 * skin}, {5, 4.0 - 1.0 - 0.4 * skin}});
  EXPECT_TRUE(receive({{5, 4.0 - 1.0 - 0.4 * skin}}));  // 4 may have left the margin by a small step
  EXPECT_FALSE(receive({{4, 4.0 - 1.0 - 0.7 * skin}}));
}

TEST_F(ResidentsTest, a_stay_of_a_single_step_keeps_what_is_owned) {
  settle({{1, 6.0}, {2, 4.01}, {3, 3.99}, {4, 3.5}});
  residents_.leave(fluid_);
  residents_.settle(fluid_, StayLength::single_step);
  EXPECT_FALSE(residents_.schedule().lasts());
  EXPECT_EQ(owned_after_leaving(), (Ids{1, 2}));
}

TEST_F(ResidentsTest, the_end_of_a_stay_is_told_ahead_in_its_second_half) {
  settle({{1, 6.0}});
  double x = 6.0;
  const auto move_on = [&] { move(0, x += 0.105 * 0.5 * skin); };  // nine such steps fit in
  for (std::uint64_t step = 1; step < 5; ++step) {
    move_on();
    EXPECT_EQ(residents_.schedule().plan(step), StaySchedule::never) << step;
    ASSERT_TRUE(receive({}));
  }
  for (std::uint64_t step = 5; step < 10; ++step) {
    move_on();
    EXPECT_EQ(residents_.schedule().plan(step), 10u) << step;
    ASSERT_TRUE(receive({}));
  }
  move_on();
  EXPECT_EQ(residents_.schedule().plan(10), 10u);
  EXPECT_FALSE(residents_.schedule().lasts());
}

TEST_F(ResidentsTest, a_stay_ends_with_that_of_a_neighbour_where_it_has_lasted_half_its_time) {
  const auto end_of_neighbours = [&](std::uint64_t plan, double move_of_a_step) {
    settle({{1, 6.0}});
    double x = 6.0;
    std::uint64_t step = 0;
    do {
      move(0, x += move_of_a_step * 0.5 * skin);
      residents_.schedule().plan(++step);
      residents_.schedule().adopt_plan(step, std::max(step, plan));
    } while (residents_.schedule().lasts() && receive({}));
    residents_.leave(fluid_);
    fluid_ = {};
    return step;
  };
  EXPECT_EQ(end_of_neighbours(7, 0.105), 7u);
  EXPECT_EQ(end_of_neighbours(5, 0.105), 5u);
  EXPECT_EQ(end_of_neighbours(12, 0.105), 10u);
  EXPECT_EQ(end_of_neighbours(3, 0.105), 5u);  // of those who make lists more often every second time
  EXPECT_EQ(end_of_neighbours(2, 0.225), 3u);  // and for less than three steps they do not pay
}

TEST_F(ResidentsTest, the_end_of_a_stay_at_rest_is_not_to_be_seen) {
  settle({{1, 6.0}});
  for (std::uint64_t step = 1; step < 9; ++step) {
    move(0, 6.0);
    EXPECT_EQ(residents_.schedule().plan(step), StaySchedule::never);
    residents_.schedule().adopt_plan(step, step + 1);  // nor does it end with another's
    ASSERT_TRUE(receive({}));
  }
}

TEST_F(ResidentsTest, lists_of_a_single_step_are_nobody_elses_concern) {
  settle({{1, 6.0}});
  residents_.leave(fluid_);
  residents_.settle(fluid_, StayLength::single_step);
  move(0, 6.0 + 0.5 * skin);
  EXPECT_EQ(residents_.schedule().plan(1), StaySchedule::never);
}

TEST_F(ResidentsTest, lists_pay_where_three_steps_like_the_last_fit_into_a_stay) {
  settle({{1, 6.0}});
  EXPECT_TRUE(residents_.schedule().pays());
  move(0, 6.0 + 0.2 * skin);
  EXPECT_TRUE(residents_.schedule().pays());
  move(0, 6.0 + 0.5 * skin);
  EXPECT_FALSE(residents_.schedule().pays());
}

TEST_F(ResidentsTest, lists_do_not_pay_where_something_else_ends_each_stay_at_once) {
  settle({{1, 6.0}});
  std::vector<int> tried;
  for (int n = 0; n < 40; ++n) {
    if (residents_.schedule().pays()) tried.push_back(n);
    residents_.leave(fluid_);
    residents_.settle(fluid_, StayLength::several_steps);
  }
  EXPECT_EQ(tried, (std::vector<int>{0, 1, 16, 32}));
  for (int step = 0; step < 2; ++step) EXPECT_TRUE(receive({}));  // a stay of three steps
  residents_.leave(fluid_);
  EXPECT_TRUE(residents_.schedule().pays());
}

}  // namespace
}  // namespace mappm
