// Oracle: brute force over the global state and all its periodic images, which every process can work out for itself.
#include "parallel/halo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <tuple>

#include "mpi/grids.hpp"
#include "mpi/world.hpp"
#include "particles/frozen.hpp"
#include "unit/serial/scenes.hpp"

namespace mappm {
namespace {

using testing::Built;
using testing::world;

/// Moves everything by up to a quarter of rcut, as a step may, and gives every field a value of its own.
template <int D>
void stir(const Model<D>& model, State<D>& state) {
  const auto share = [](std::uint64_t id, int axis) {  // in (-1, 1)
    return static_cast<double>(ParticleHash(id).add(static_cast<std::uint64_t>(axis)).value() >> 12) /
               (0.5 * box_quanta) -
           1.0;
  };
  for (std::size_t i = 0; i < state.fluid.size(); ++i) {
    for (int axis = 0; axis < D; ++axis) {
      const double moved = std::nearbyint(0.25 * share(state.fluid.id[i], axis) / model.pair.length[axis]);
      state.fluid.x(axis)[i] = wrap_position(state.fluid.x(axis)[i] + moved);
      state.fluid.v(axis)[i] = share(state.fluid.id[i], axis + 7);
    }
  }
  for (Solid<D>& solid : state.solids) {
    for (int axis = 0; axis < D; ++axis) {
      const double moved = std::nearbyint(0.25 * share(~solid.id, axis) / model.pair.length[axis]);
      solid.x[axis] = wrap_position(solid.x[axis] + moved);
    }
    solid.contacts = {{solid.id + 1, 2, 3, {{0.25}}}};
    solid.fluid_impulse[0] = static_cast<Int128>(solid.id) << 70;
    solid.sampled_impulse[1] = -5;
  }
}

/// The part of a global state that a process owns by the positions of another state with the same particles.
template <int D>
State<D> share_of(const State<D>& global, const State<D>& positions, const Region<D>& region) {
  State<D> share;
  for (std::size_t i = 0; i < global.fluid.size(); ++i) {
    Vec<D, double> x;
    for (int axis = 0; axis < D; ++axis) x[axis] = positions.fluid.x(axis)[i];
    if (!region.contains(x)) continue;
    share.fluid.id.push_back(global.fluid.id[i]);
    for (std::size_t f = 0; f < global.fluid.field.size(); ++f)
      share.fluid.field[f].push_back(global.fluid.field[f][i]);
  }
  for (std::size_t i = 0; i < global.solids.size(); ++i)
    if (region.contains(positions.solids[i].x)) share.solids.push_back(global.solids[i]);
  return share;
}

/// Calls f(x) for every periodic image of a position that lies in `region`.
template <int D, class F>
void for_each_image(const Vec<D, double>& x, const Region<D>& region, F&& f) {
  for (int n = 0; n < (D == 2 ? 9 : 27); ++n) {
    Vec<D, double> image = x;
    for (int axis = 0, rest = n; axis < D; ++axis, rest /= 3) image[axis] += (rest % 3 - 1) * box_quanta;
    if (region.contains(image)) f(image);
  }
}

template <int D>
using Row = std::vector<double>;  // all fields of a PP at its position in the frame of the region, after its id

template <int D>
std::multiset<Row<D>> rows(const FluidParticles<D>& fluid) {
  std::multiset<Row<D>> set;
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    Row<D> row{static_cast<double>(fluid.id[i])};
    for (const auto& values : fluid.field) row.push_back(values[i]);
    set.insert(row);
  }
  return set;
}

/// Owned PPs and ghosts as brute force finds them.
template <int D>
std::multiset<Row<D>> expected_rows(const State<D>& global, const Region<D>& reach) {
  std::multiset<Row<D>> set;
  for (std::size_t i = 0; i < global.fluid.size(); ++i) {
    Vec<D, double> x;
    for (int axis = 0; axis < D; ++axis) x[axis] = global.fluid.x(axis)[i];
    for_each_image<D>(x, reach, [&](const Vec<D, double>& image) {
      Row<D> row{static_cast<double>(global.fluid.id[i])};
      for (std::size_t f = 0; f < global.fluid.field.size(); ++f)
        row.push_back(f < D ? image[static_cast<int>(f)] : global.fluid.field[f][i]);
      set.insert(row);
    });
  }
  return set;
}

template <int D>
std::multiset<Row<D>> solid_rows(const std::vector<Solid<D>>& solids) {
  std::multiset<Row<D>> set;
  for (const Solid<D>& solid : solids) {
    Row<D> row{static_cast<double>(solid.id)};
    for (int axis = 0; axis < D; ++axis) row.push_back(solid.x[axis]);
    set.insert(row);
  }
  return set;
}

template <int D>
std::multiset<Row<D>> expected_solid_rows(const State<D>& global, const Region<D>& reach, const Region<D>& without) {
  std::multiset<Row<D>> set;
  for (const Solid<D>& solid : global.solids)
    for_each_image<D>(solid.x, reach, [&](const Vec<D, double>& image) {
      if (without.contains(image)) return;
      Row<D> row{static_cast<double>(solid.id)};
      for (int axis = 0; axis < D; ++axis) row.push_back(image[axis]);
      set.insert(row);
    });
  return set;
}

template <int D>
Region<D> nowhere() {
  return {};
}

/// A copy must bring all that its owner knows but contacts.
template <int D>
void expect_true_copy(const Solid<D>& copy, const Solid<D>& original) {
  EXPECT_EQ(copy.shape, original.shape);
  EXPECT_EQ(copy.group, original.group);
  EXPECT_EQ(copy.motion, original.motion);
  EXPECT_TRUE(copy.momentum == original.momentum);
  EXPECT_TRUE(copy.angular_momentum == original.angular_momentum);
  EXPECT_EQ(copy.orientation.component, original.orientation.component);
}

/// Every FP of every solid lies in the region of exactly one process; each adds one to an impulse.
template <int D>
void expect_reports_to_come_home(const Model<D>& model, Halo<D>& halo, const State<D>& state,
                                 const std::vector<Solid<D>>& copies) {
  const auto inside = [&](const Solid<D>& solid) {
    std::vector<FrozenInStep<D>> frozen;
    place_frozen(model, solid_in_step(model, solid), 0, halo.region(), frozen);
    return frozen;
  };
  std::vector<HomeReport<D>> reports(copies.size());
  for (std::size_t c = 0; c < copies.size(); ++c) {
    reports[c].solid = copies[c].id;
    for (const FrozenInStep<D>& fp : inside(copies[c])) {
      reports[c].any = true;
      reports[c].fluid.linear[0] += 1;
      reports[c].fluid.linear[1] += Int128{fp.index} << 70;
      reports[c].fluid.angular[0] -= Int128{1} << 80;
    }
  }
  std::map<std::uint64_t, SolidImpulse<D>> reported;
  for (const Solid<D>& solid : state.solids)
    for (const FrozenInStep<D>& fp : inside(solid)) {
      reported[solid.id].linear[0] += 1;
      reported[solid.id].linear[1] += Int128{fp.index} << 70;
      reported[solid.id].angular[0] -= Int128{1} << 80;
    }
  for (const HomeReport<D>& report : halo.send_home(copies, std::move(reports))) {
    EXPECT_TRUE(std::ranges::any_of(state.solids, [&](const Solid<D>& solid) { return solid.id == report.solid; }))
        << "a report for solid " << report.solid << " came to another process";
    EXPECT_TRUE(report.fluid.linear[0] > 0) << "of no FP none is sent";
    reported[report.solid].linear += report.fluid.linear;
    reported[report.solid].angular += report.fluid.angular;
  }
  for (const Solid<D>& solid : state.solids) {
    const auto count = static_cast<Int128>(model.shapes[solid.shape].frozen.size());
    EXPECT_TRUE(reported[solid.id].linear[0] == count) << "solid " << solid.id;
    EXPECT_TRUE(reported[solid.id].linear[1] == (count * (count - 1) / 2) << 70) << "solid " << solid.id;
    EXPECT_TRUE(reported[solid.id].angular[0] == -(count << 80)) << "solid " << solid.id;
  }
}

/// A density that every process can work out for itself.
double density_of(std::uint64_t id) { return 10.0 + 1e-3 * static_cast<double>(id); }
double density_of(std::uint64_t solid, std::uint32_t index) {
  return 20.0 + static_cast<double>(solid) + 1e-3 * static_cast<double>(index);
}

/// Each process knows the densities of what lies in its region, and learns those of all PPs and FPs within rcut.
template <int D>
void expect_densities_of_ghosts(const Model<D>& model, Halo<D>& halo, const State<D>& state, Residents<D>& residents,
                                const std::vector<Solid<D>>& copies) {
  residents.settle(state.fluid, StayLength::several_steps);
  std::vector<double> density;
  for (std::size_t i = 0; i < state.fluid.size(); ++i)
    density.push_back(halo.region().contains(state.fluid.position(i)) ? density_of(state.fluid.id[i]) : -1.0);
  PlacedSolids<D> solids;
  solids.clear();
  for (const auto& list : {std::cref(state.solids), std::cref(copies)})
    for (const Solid<D>& solid : list.get()) {
      const auto index = static_cast<std::uint32_t>(solids.bodies.size());
      place_frozen(model, solids.bodies.emplace_back(solid_in_step(model, solid)), index, halo.reach(), solids.frozen);
      solids.first.push_back(solids.frozen.size());
    }
  for (FrozenInStep<D>& fp : solids.frozen)
    if (halo.region().contains(fp.place.x))
      set_density(model, fp, density_of(solids.bodies[fp.solid].solid->id, fp.index));
  halo.begin_densities(state.fluid, residents, density, solids);
  halo.end_densities(residents, density, solids);
  for (std::size_t i = 0; i < state.fluid.size(); ++i)
    if (halo.reach().contains(state.fluid.position(i))) {
      EXPECT_EQ(density[i], density_of(state.fluid.id[i])) << "particle " << state.fluid.id[i];
    }
  for (const FrozenInStep<D>& fp : solids.frozen) {
    const std::uint64_t solid = solids.bodies[fp.solid].solid->id;
    EXPECT_EQ(fp.density, density_of(solid, fp.index)) << "solid " << solid << ", FP " << fp.index;
    EXPECT_EQ(fp.volume.v2, 1.0 / fp.density * (1.0 / fp.density));
  }
}

template <int D>
void expect_brute_force_halo(const Built<D>& built, const Domains<D>& domains) {
  const Model<D>& model = built.model;
  const State<D> before = built.state();
  State<D> global = before;
  stir(model, global);
  const Region<D> region = domains.region(world().rank());
  State<D> state = share_of(global, before, region);
  Halo<D> halo(model, domains, world());
  Residents<D> residents(model, region, halo.needed());
  std::vector<Solid<D>> copies;
  PhaseTimes times;
  EXPECT_FALSE(halo.exchange(state, residents, copies, times));

  // A PP that has just changed its owner is not sent on by the former one to where it is not needed.
  const Region<D> reach = widened(model, region, 1.0);
  const auto held = rows(state.fluid), wanted = expected_rows(global, reach),
             wide = expected_rows(global, widened(model, region, 1.0 + skin));
  EXPECT_TRUE(std::includes(held.begin(), held.end(), wanted.begin(), wanted.end()));
  EXPECT_TRUE(std::includes(wide.begin(), wide.end(), held.begin(), held.end()));
  EXPECT_EQ(solid_rows(state.solids), expected_solid_rows(global, region, nowhere<D>()));
  // The margin of the copies has a quarter of rcut to spare, for a solid that has just changed its owner: its former
  // owner does not send it on to where it is not needed.
  const auto copied = solid_rows(copies);
  const double margin = solid_margin(model);
  const auto needed = expected_solid_rows(global, widened(model, region, margin - 0.25), region);
  const auto allowed = expected_solid_rows(global, widened(model, region, margin), region);
  EXPECT_TRUE(std::includes(copied.begin(), copied.end(), needed.begin(), needed.end()));
  EXPECT_TRUE(std::includes(allowed.begin(), allowed.end(), copied.begin(), copied.end()));
  EXPECT_TRUE(std::is_sorted(state.solids.begin(), state.solids.end(),
                             [](const Solid<D>& a, const Solid<D>& b) { return a.id < b.id; }));
  std::map<std::uint64_t, const Solid<D>*> original;
  for (const Solid<D>& solid : global.solids) original[solid.id] = &solid;
  for (const Solid<D>& copy : copies) expect_true_copy(copy, *original.at(copy.id));
  expect_densities_of_ghosts(model, halo, state, residents, copies);
  expect_reports_to_come_home(model, halo, state, copies);

  // Without the ghosts the processes hold the global state: every particle and solid is owned exactly once.
  State<D> owned = share_of(state, state, region);
  EXPECT_EQ(testing::total(owned.fluid.size()), global.fluid.size());
  EXPECT_EQ(testing::total(owned.solids.size()), global.solids.size());
  EXPECT_EQ(testing::total(digest_share(owned)), digest_share(global));
  EXPECT_EQ(halo.traffic().bytes > 0, world().size() > 1);
  EXPECT_EQ(halo.traffic().messages, 3u * static_cast<unsigned>(halo.traffic().neighbours));  // there, densities, home
}

template <int D>
void expect_brute_force_halos(const std::string& scene) {
  const Built<D> built(scene);
  for (const std::string& grid : testing::all_grids<D>(world().size())) {
    SCOPED_TRACE(grid);
    const Domains<D> domains = make_domains<D>(built.model, world().size(), grid);
    expect_brute_force_halo(built, domains);
    if (world().size() > 1) expect_brute_force_halo(built, testing::uneven(built.model, domains));
  }
}

TEST(Halo, owned_ghosts_and_copies_are_those_of_brute_force_in_the_plane) {
  expect_brute_force_halos<2>(testing::dense_discs());
}

TEST(Halo, owned_ghosts_and_copies_are_those_of_brute_force_with_walls) {
  expect_brute_force_halos<2>(testing::channel());
}

TEST(Halo, owned_ghosts_and_copies_are_those_of_brute_force_in_space) {
  expect_brute_force_halos<3>(testing::spheres());
}

/// Of PPs that do not move the whole margin is held.
template <int D>
void expect_whole_margin(const std::string& scene) {
  const Built<D> built(scene);
  const State<D> global = built.state();
  for (const std::string& grid : testing::all_grids<D>(world().size())) {
    const Domains<D> domains = make_domains<D>(built.model, world().size(), grid);
    const Region<D> region = domains.region(world().rank());
    Halo<D> halo(built.model, domains, world());
    Residents<D> residents(built.model, region, halo.needed());
    State<D> state = share_of(global, global, region);
    std::vector<Solid<D>> copies;
    PhaseTimes times;
    halo.exchange(state, residents, copies, times);
    EXPECT_EQ(rows(state.fluid), expected_rows(global, widened(built.model, region, 1.0 + skin))) << grid;
  }
}

TEST(Halo, ghosts_lie_as_far_out_as_lists_reach) {
  expect_whole_margin<2>(testing::dense_discs());
  expect_whole_margin<3>(testing::spheres());
}

TEST(Halo, positions_do_not_drift_through_many_exchanges) {
  const Built<2> built(testing::dense_discs());
  const Domains<2> domains = make_domains<2>(built.model, world().size(), "");
  const Region<2> region = domains.region(world().rank());
  State<2> state = built.state(region);
  const std::uint64_t digest = testing::total(digest_share(state));
  Halo<2> halo(built.model, domains, world());
  Residents<2> residents(built.model, region, halo.needed());
  std::vector<Solid<2>> copies;
  PhaseTimes times;
  for (int n = 0; n < 5; ++n) {
    halo.exchange(state, residents, copies, times);
    state = share_of(state, state, region);
  }
  EXPECT_EQ(testing::total(digest_share(state)), digest);
}

}  // namespace
}  // namespace mappm
