// Oracle: the serial engine, and a cell repeated. Densities are no part of the state, so its digest does not show them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mpi/grids.hpp"
#include "mpi/world.hpp"
#include "parallel/engine.hpp"
#include "serial/engine.hpp"
#include "unit/serial/scenes.hpp"

namespace mappm {
namespace {

using testing::Built;
using testing::total;
using testing::world;

template <int D>
using FrozenById = std::map<std::pair<std::uint64_t, std::uint32_t>, FrozenPoint<D>>;

template <int D>
FrozenById<D> frozen_by_id(const std::vector<FrozenPoint<D>>& points) {
  FrozenById<D> by_id;
  for (const FrozenPoint<D>& fp : points) EXPECT_TRUE(by_id.insert({{fp.solid, fp.index}, fp}).second) << "twice";
  return by_id;
}

template <int D>
Vec<D, double> wrapped(Vec<D, double> x) {
  for (int axis = 0; axis < D; ++axis) x[axis] = wrap_position(x[axis]);
  return x;
}

/// What this process samples is what the serial engine does, and all processes together sample everything once.
template <int D>
void expect_the_same_sample(const Sample<D>& sample, const Sample<D>& expected, const Region<D>& region) {
  std::map<std::uint64_t, double> fluid;
  for (std::size_t i = 0; i < expected.state.fluid.size(); ++i)
    fluid[expected.state.fluid.id[i]] = expected.density.fluid[i];
  EXPECT_EQ(sample.density.fluid.size(), sample.state.fluid.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < sample.density.fluid.size(); ++i)
    different += sample.density.fluid[i] == fluid.at(sample.state.fluid.id[i]) ? 0u : 1u;
  EXPECT_EQ(different, 0u) << "of " << sample.density.fluid.size() << " PPs";
  EXPECT_EQ(total(sample.density.fluid.size()), fluid.size());

  const FrozenById<D> frozen = frozen_by_id(expected.density.frozen);
  for (const FrozenPoint<D>& fp : sample.density.frozen) {
    const FrozenPoint<D>& other = frozen.at({fp.solid, fp.index});
    EXPECT_EQ(fp.density, other.density) << "solid " << fp.solid << ", FP " << fp.index;
    EXPECT_EQ(wrapped(fp.x), wrapped(other.x));
    EXPECT_EQ(fp.v, other.v);
    EXPECT_TRUE(region.contains(fp.x));
  }
  EXPECT_EQ(frozen_by_id(sample.density.frozen).size(), sample.density.frozen.size());
  EXPECT_EQ(total(sample.density.frozen.size()), frozen.size());
}

template <int D>
void expect_samples_of_the_serial_engine(const std::string& scene, const std::vector<std::string>& grids,
                                         int threads = 1) {
  const Built<D> built(scene);
  for (const std::string& grid : grids) {
    SCOPED_TRACE(grid);
    const Domains<D> domains = make_domains<D>(built.model, world().size(), grid);
    SerialEngine<D> serial(built.model, built.state(), Neighbours::cells);
    ParallelEngine<D> engine(built.model, domains, world(), built.state(domains.region(world().rank())),
                             {.threads = threads});
    for (int step = 0; step <= 12; ++step) {
      if (step % 4 == 0)
        expect_the_same_sample(engine.sample(), serial.sample(), engine.domains().region(world().rank()));
      serial.step();
      engine.step();
    }
    EXPECT_EQ(engine.first_fault().text(), "");
    EXPECT_EQ(total(digest_share(engine.state())), digest_share(serial.state()));
  }
}

TEST(ParallelDensities, are_those_of_the_serial_engine_on_any_processes) {
  const auto plane = testing::all_grids<2>(world().size());
  expect_samples_of_the_serial_engine<2>(testing::dense_discs(), plane);
  expect_samples_of_the_serial_engine<2>(testing::channel(), plane);
  expect_samples_of_the_serial_engine<3>(testing::spheres(), testing::all_grids<3>(world().size()));
}

TEST(ParallelDensities, are_those_of_the_serial_engine_in_single_precision_and_with_threads) {
  const auto single = [](const std::string& scene) {
    return testing::replaced(scene, "viscosity", "precision = \"single\"\nviscosity");
  };
  expect_samples_of_the_serial_engine<2>(single(testing::dense_discs()), {""}, 2);
  expect_samples_of_the_serial_engine<3>(single(testing::spheres()), {""}, 2);
}

std::vector<std::string> slabs_along_y() { return {"1x" + std::to_string(world().size())}; }

TEST(ParallelDensities, of_a_body_beside_its_own_image_are_those_of_the_serial_engine) {
  expect_samples_of_the_serial_engine<2>(testing::disc_in_each_cell(1, 1), slabs_along_y());
  if (world().size() == 1) expect_samples_of_the_serial_engine<3>(testing::sphere_in_each_cell(1), {""});
}

TEST(ParallelDensities, of_a_body_beside_its_own_image_are_those_beside_another) {
  const Built<2> cell(testing::disc_in_each_cell(1, 1)), many(testing::disc_in_each_cell(2, 2));
  const auto engine_of = [&](const Built<2>& built) {
    const Domains<2> domains = make_domains<2>(built.model, world().size(), slabs_along_y()[0]);
    const Region<2> region = domains.region(world().rank());
    State<2> start = built.state(region);
    testing::repeat_fluid(cell, built, region, start);
    return ParallelEngine<2>(built.model, domains, world(), std::move(start), {});
  };
  ParallelEngine<2> one = engine_of(cell), repeated = engine_of(many);
  const std::size_t count = cell.model.shapes[0].frozen.size();
  const auto all_densities = [&](ParallelEngine<2>& engine, std::size_t solids) {  // on every process
    std::vector<double> densities(solids * count, -1.0);
    for (const FrozenPoint<2>& fp : engine.sample().density.frozen) densities[fp.solid * count + fp.index] = fp.density;
    world().maximum(densities);
    return densities;
  };
  const std::vector<double> expected = all_densities(one, 1), found = all_densities(repeated, 4);
  for (std::size_t n = 0; n < found.size(); ++n)  // positions are rounded to quanta of another size
    EXPECT_NEAR(found[n], expected[n % count], 1e-11) << "solid " << n / count << ", FP " << n % count;
}

TEST(ParallelDensities, a_sample_changes_nothing) {
  const Built<2> built(testing::dense_discs());
  const Domains<2> domains = make_domains<2>(built.model, world().size(), "");
  const auto make = [&] {
    return ParallelEngine<2>(built.model, domains, world(), built.state(domains.region(world().rank())), {});
  };
  ParallelEngine<2> looked_at = make(), alone = make();
  for (int step = 0; step < 20; ++step) {
    if (step % 3 == 0) looked_at.sample();
    looked_at.step();
    alone.step();
  }
  EXPECT_EQ(total(digest_share(looked_at.state())), total(digest_share(alone.state())));
}

}  // namespace
}  // namespace mappm
