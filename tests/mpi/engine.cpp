// Oracle: the serial engine. Digests must be equal to the last bit, whatever the domains, the threads and the borders.
#include "parallel/engine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "mpi/grids.hpp"
#include "mpi/world.hpp"
#include "serial/engine.hpp"
#include "unit/serial/scenes.hpp"

namespace mappm {
namespace {

using testing::Built;
using testing::total;
using testing::world;

constexpr int every = 10;

/// What a run saw of the scene's life, so that a scene in which nothing happens is noticed.
struct Events {
  std::size_t contacts = 0, changes_of_owner = 0;
  bool turned = false;
};

template <int D>
struct Reference {
  std::vector<std::uint64_t> digests;  // at step 0, 10, 20 ...
  Events events;
};

/// Digests of the serial engine, computed by the first process for all.
template <int D>
Reference<D> run_serial(const Built<D>& built, int steps) {
  Reference<D> reference;
  if (world().is_first()) {
    SerialEngine<D> engine(built.model, built.state(), Neighbours::cells);
    // Which quarter of the box along x and y each solid is in: crossing from one to another crosses some grid's border.
    std::map<std::uint64_t, std::pair<double, double>> quarter;
    const auto look = [&] {
      for (const Solid<D>& solid : engine.state().solids) {
        const std::pair now{std::floor(4.0 * solid.x[0] / box_quanta), std::floor(4.0 * solid.x[1] / box_quanta)};
        const auto [before, added] = quarter.try_emplace(solid.id, now);
        if (!added && before->second != now) ++reference.events.changes_of_owner;
        before->second = now;
        reference.events.turned =
            reference.events.turned || (solid.motion == SolidMotion::free && solid.orientation.component[0] < 0.999);
      }
      reference.digests.push_back(digest_share(engine.state()));
    };
    look();
    for (int step = 1; step <= steps; ++step) {
      engine.step();
      for (const Solid<D>& solid : engine.state().solids) reference.events.contacts += solid.contacts.size();
      if (step % every == 0) look();
    }
    EXPECT_EQ(engine.first_fault().text(), "");
  }
  std::vector<std::uint64_t> shared(static_cast<std::size_t>(steps / every) + 1, 0);
  std::copy(reference.digests.begin(), reference.digests.end(), shared.begin());
  world().sum(std::span(shared));
  reference.digests = shared;
  return reference;
}

/// The total momentum must be its start plus the impulse from outside at every sample, exactly.
template <int D>
void expect_ledger(State<D>& state, const Vec<D, Int128>& start) {
  Vec<D, Int128> error = momentum_share(state) - state.outside_impulse;
  world().sum(std::span<Int128>(error.component));
  EXPECT_TRUE(error == start) << "step " << state.step;
}

template <int D>
void expect_digests(const Built<D>& built, const Domains<D>& domains, const ParallelOptions& options,
                    const std::vector<std::uint64_t>& digests) {
  State<D> share = built.state(domains.region(world().rank()));
  Vec<D, Int128> start = momentum_share(share);
  world().sum(std::span<Int128>(start.component));
  share.start_momentum = start;
  ParallelEngine<D> engine(built.model, domains, world(), std::move(share), options);
  for (std::size_t n = 0; n < digests.size(); ++n) {
    const std::uint64_t digest = total(digest_share(engine.state()));
    EXPECT_EQ(digest, digests[n]) << "step " << n * every;
    if (digest != digests[n]) break;  // on all processes alike
    expect_ledger(engine.state(), start);
    for (int step = 0; step < every && n + 1 < digests.size(); ++step) engine.step();
  }
  EXPECT_EQ(engine.first_fault().text(), "");
}

/// The same without a look at the state before the end: the PPs stay as long as they can. On one process in `ending`
/// and of the steps one in three they are made to end their stay, which is nobody else's concern.
template <int D>
void expect_digest_after_stays(const Built<D>& built, const Domains<D>& domains, int ending,
                               const ParallelOptions& options, const std::vector<std::uint64_t>& digests) {
  ParallelEngine<D> engine(built.model, domains, world(), built.state(domains.region(world().rank())), options);
  const int steps = every * (static_cast<int>(digests.size()) - 1);
  for (int step = 0; step < steps; ++step) {
    if (ending > 0 && world().rank() % ending == 0 && (step + world().rank()) % 3 == 0) engine.state();
    engine.step();
  }
  if (ending == 0 && options.rebalance == 0 && built.model.terms.fluid) {
    // Contacts and the start, when all is set in motion, end stays early: these are most of a short run.
    EXPECT_LT(engine.orderings(), static_cast<unsigned>(steps < 100 ? steps * 9 / 10 : steps * 2 / 3));
  }
  EXPECT_EQ(total(digest_share(engine.state())), digests.back());
  EXPECT_EQ(engine.first_fault().text(), "");
}

/// All grids that this number of processes allows, over all steps; on one of them also two threads, and borders that
/// follow the load.
template <int D>
void expect_bits_of_the_serial_engine(const std::string& scene, int steps) {
  const Built<D> built(scene);
  const Reference<D> reference = run_serial(built, steps);
  if (world().is_first()) {
    EXPECT_GT(reference.events.contacts, 10u);
    EXPECT_GT(reference.events.changes_of_owner, 3u);
    EXPECT_TRUE(reference.events.turned);
    EXPECT_EQ(std::set(reference.digests.begin(), reference.digests.end()).size(), reference.digests.size());
  }
  const std::vector<std::string> grids = testing::all_grids<D>(world().size());
  for (const std::string& grid : grids) {
    SCOPED_TRACE(grid);
    const Domains<D> domains = make_domains<D>(built.model, world().size(), grid);
    expect_digests(built, domains, {}, reference.digests);
    for (const int ending : {0, 2}) expect_digest_after_stays(built, domains, ending, {}, reference.digests);
  }
  const std::string grid = grids[grids.size() / 2];
  SCOPED_TRACE(grid);
  const Domains<D> domains = make_domains<D>(built.model, world().size(), grid);
  {
    SCOPED_TRACE("2 threads");
    const std::vector<std::uint64_t> first(reference.digests.begin(), reference.digests.begin() + 4);
    expect_digests(built, domains, {.threads = 2, .rebalance = 0}, first);
    expect_digest_after_stays(built, domains, 0, {.threads = 2, .rebalance = 0}, first);
  }
  if (world().size() > 1) {
    SCOPED_TRACE("borders that move every 20 steps");
    const std::vector<std::uint64_t> first(reference.digests.begin(), reference.digests.begin() + 10);
    expect_digests(built, testing::uneven(built.model, domains), {.threads = 1, .rebalance = 20}, first);
    expect_digest_after_stays(built, testing::uneven(built.model, domains), 0, {.threads = 1, .rebalance = 20}, first);
  }
}

TEST(ParallelEngine, equals_the_serial_one_with_dense_turning_discs_that_touch_and_cross_borders) {
  expect_bits_of_the_serial_engine<2>(testing::dense_discs(), 200);
}

TEST(ParallelEngine, equals_the_serial_one_with_solids_of_1_to_10_in_size) {
  expect_bits_of_the_serial_engine<2>(testing::one_to_ten(), 200);
}

TEST(ParallelEngine, equals_the_serial_one_with_walls_and_fixed_solids) {
  expect_bits_of_the_serial_engine<2>(testing::channel(), 200);
}

TEST(ParallelEngine, equals_the_serial_one_in_space) { expect_bits_of_the_serial_engine<3>(testing::spheres(), 100); }

/// The scene with pairs in single precision.
std::string in_single(const std::string& scene) {
  return testing::replaced(scene, "viscosity", "precision = \"single\"\nviscosity");
}

TEST(ParallelEngine, equals_the_serial_one_in_single_precision) {
  expect_bits_of_the_serial_engine<2>(in_single(testing::channel()), 200);
  expect_bits_of_the_serial_engine<3>(in_single(testing::spheres()), 100);
}

TEST(ParallelEngine, equals_the_serial_one_where_stays_would_not_pay) {
  const Built<2> built(testing::head("[12.0, 10.8]", "0.3", "11.1111111111",
                                     "wave = { amplitude = 0.4, direction = \"x\", gradient = \"y\" }"));
  SerialEngine<2> serial(built.model, built.state(), Neighbours::cells);
  const Domains<2> domains = make_domains<2>(built.model, world().size(), "");
  ParallelEngine<2> engine(built.model, domains, world(), built.state(domains.region(world().rank())), {});
  constexpr unsigned steps = 30;
  for (unsigned step = 0; step < steps; ++step) {
    serial.step();
    engine.step();
  }
  EXPECT_GT(engine.orderings(), steps - 3);
  EXPECT_EQ(total(digest_share(engine.state())), digest_share(serial.state()));
}

TEST(ParallelEngine, processes_make_their_lists_in_the_same_steps) {
  const Built<2> built(testing::head("[12.0, 10.8]", "0.3", "11.1111111111"));
  const Domains<2> domains = make_domains<2>(built.model, world().size(), "");
  const auto set_in_motion = [&](State<2>&& state) {
    for (std::size_t i = 0; i < state.fluid.size(); ++i) {  // each by itself would keep its lists for its own time
      const double v = 0.0125 / (1.0 + 0.2 * domains.owner(state.fluid.position(i)));  // c: stays last for some steps
      state.fluid.v(0)[i] = std::nearbyint(v / velocity_quantum) * velocity_quantum;
    }
    return std::move(state);
  };
  SerialEngine<2> serial(built.model, set_in_motion(built.state()), Neighbours::cells);
  ParallelEngine<2> engine(built.model, domains, world(), set_in_motion(built.state(domains.region(world().rank()))),
                           {});
  constexpr std::size_t steps = 120;
  std::vector<std::uint64_t> makers(steps, 0);
  for (std::uint64_t& count : makers) {
    const std::uint64_t before = engine.orderings();
    engine.step();
    serial.step();
    count = engine.orderings() - before;
  }
  world().sum(std::span(makers));
  std::vector<double> most{static_cast<double>(engine.orderings())};
  world().maximum(std::span(most));
  const auto anywhere = static_cast<double>(steps) - static_cast<double>(std::ranges::count(makers, 0));
  EXPECT_GT(most[0], 10.0);
  EXPECT_LE(anywhere, 1.1 * most[0]);
  EXPECT_EQ(total(digest_share(engine.state())), digest_share(serial.state()));
}

TEST(ParallelEngine, equals_the_serial_one_with_solids_alone) {
  std::string scene = testing::replaced(testing::spheres(), "viscosity = 0.5", "particles = false");
  scene = testing::replaced(scene, "fluid = [0.0, 0.0, 0.0005]\nsolid = \"balance\"", "solid = [0.0, 0.0, 0.0005]");
  scene = testing::replaced(scene, "steps = 100", "steps = 100\nstep = 0.125");
  expect_bits_of_the_serial_engine<3>(scene, 100);
}

TEST(ParallelEngine, reports_a_value_out_of_range_and_goes_on) {
  const Built<2> built(testing::head("[12.0, 10.8]", "0.3", "11.1111111111"));
  const Domains<2> domains = make_domains<2>(built.model, world().size(), "");
  for (std::size_t k = 0; k < 2 * lane_count; ++k) {  // at every lane, and at the end of a row
    State<2> state = built.state(domains.region(world().rank()));
    if (world().is_first()) state.fluid.v(0)[k] = 3.0;
    const std::string named = "step 0: particle " + std::to_string(state.fluid.id[k]) + ": moves more than rcut/4";
    ParallelEngine<2> engine(built.model, domains, world(), std::move(state), {});
    engine.step();
    const bool reported = engine.first_fault().text().find(named) != std::string::npos;
    EXPECT_EQ(total(reported ? 1 : 0), 1u);
  }
}

TEST(ParallelEngine, reports_a_solid_out_of_range_on_its_owner_and_goes_on) {
  const Built<2> built(testing::discs_alone());
  const Domains<2> domains = make_domains<2>(built.model, world().size(), "");
  State<2> state = built.state(domains.region(world().rank()));
  for (Solid<2>& solid : state.solids)
    if (solid.id == 2) solid.momentum[0] *= 1000;
  ParallelEngine<2> engine(built.model, domains, world(), std::move(state), {});
  for (int step = 0; step < 3; ++step) engine.step();
  const bool reported = engine.first_fault().text().find("step 0: solid 2: a point of it moves more than rcut/4") == 0;
  EXPECT_EQ(total(reported ? 1 : 0), 1u);
  EXPECT_EQ(total(engine.state().solids.size()), 16u);
}

TEST(ParallelEngine, tells_where_its_time_went) {
  const Built<2> built(testing::dense_discs());
  const Domains<2> domains = make_domains<2>(built.model, world().size(), "");
  ParallelEngine<2> engine(built.model, domains, world(), built.state(domains.region(world().rank())), {});
  engine.step();
  std::set<std::string> phases;
  for (const auto& [name, seconds] : engine.phase_seconds()) {
    phases.insert(name);
    EXPECT_GT(seconds, 0.0) << name;
  }
  EXPECT_EQ(phases, (std::set<std::string>{"exchange", "sort", "lists", "densities", "pairs", "frozen_pairs", "solids",
                                           "copies", "integrate"}));
}

}  // namespace
}  // namespace mappm
