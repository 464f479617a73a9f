// Oracles: the digest, which no decomposition may change, and the owners by position.
#include "parallel/redistribute.hpp"

#include <gtest/gtest.h>

#include "mpi/grids.hpp"
#include "mpi/world.hpp"
#include "unit/serial/scenes.hpp"

namespace mappm {
namespace {

using testing::Built;
using testing::total;
using testing::world;

template <int D>
void expect_own_particles(const Region<D>& region, const State<D>& state) {
  for (std::size_t i = 0; i < state.fluid.size(); ++i) {
    Vec<D, double> x;
    for (int axis = 0; axis < D; ++axis) x[axis] = state.fluid.x(axis)[i];
    EXPECT_TRUE(region.contains(x)) << "particle " << state.fluid.id[i];
  }
  for (std::size_t i = 0; i < state.solids.size(); ++i) {
    EXPECT_TRUE(region.contains(state.solids[i].x));
    EXPECT_TRUE(i == 0 || state.solids[i - 1].id < state.solids[i].id);
  }
}

template <int D>
void expect_kept_state(const std::string& scene) {
  const Built<D> built(scene);
  const int rank = world().rank();
  const auto grids = testing::all_grids<D>(world().size());
  const Domains<D> first = make_domains<D>(built.model, world().size(), grids.front());
  State<D> state = built.state(first.region(rank));
  for (Solid<D>& solid : state.solids) solid.contacts = {{solid.id + 1, 2, 3, {{0.25}}}};
  const std::uint64_t digest = total(digest_share(state)), particles = total(state.fluid.size());
  for (const std::string& grid : grids) {
    SCOPED_TRACE(grid);
    const Domains<D> even = make_domains<D>(built.model, world().size(), grid);
    for (const Domains<D>& domains : {even, testing::uneven(built.model, even)}) {
      redistribute(domains, world(), state);
      expect_own_particles(domains.region(rank), state);
      EXPECT_EQ(total(digest_share(state)), digest);
      EXPECT_EQ(total(state.fluid.size()), particles);
    }
  }
}

TEST(Redistribute, keeps_the_state_under_any_domains) {
  expect_kept_state<2>(testing::dense_discs());
  expect_kept_state<2>(testing::channel());
  expect_kept_state<3>(testing::spheres());
}

TEST(Redistribute, one_process_may_hold_everything_at_first) {
  const Built<2> built(testing::dense_discs());
  State<2> state;
  if (world().is_first()) state = built.state();
  const std::uint64_t digest = total(digest_share(state));
  const Domains<2> domains = make_domains<2>(built.model, world().size(), "");
  redistribute(domains, world(), state);
  expect_own_particles(domains.region(world().rank()), state);
  EXPECT_EQ(total(digest_share(state)), digest);
  EXPECT_GT(state.fluid.size(), 0u);
}

TEST(DomainsByLoad, share_an_uneven_fluid_evenly) {
  // Only the PPs of the lower quarter along x and of the upper half along y remain.
  const Built<2> built(testing::head("[48.0, 24.0]", "0.3", "11.1111111111"));
  for (const std::string& grid : testing::all_grids<2>(world().size())) {
    SCOPED_TRACE(grid);
    const Domains<2> even = make_domains<2>(built.model, world().size(), grid);
    Region<2> kept = even.region(world().rank());
    kept.high[0] = std::min(kept.high[0], 0.25 * box_quanta);
    kept.low[1] = std::max(kept.low[1], 0.5 * box_quanta);
    State<2> state;
    if (kept.low[0] < kept.high[0] && kept.low[1] < kept.high[1]) state = built.state(kept);
    const std::uint64_t particles = total(state.fluid.size());
    EXPECT_EQ(particles, 40u * 40u);
    const Domains<2> balanced = domains_by_load(built.model, even, world(), state);
    redistribute(balanced, world(), state);
    // Borders fall between the columns and rows of the lattice: one column or row of 40 more or less on each side.
    const double fair = static_cast<double>(particles) / world().size();
    EXPECT_NEAR(static_cast<double>(state.fluid.size()), fair, 2.0 * 40.0);
  }
}

}  // namespace
}  // namespace mappm
