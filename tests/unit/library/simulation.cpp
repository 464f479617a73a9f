// What a program sees that embeds the solver: the engine that the scene's dimension asks for, and errors that stop it.
#include "library/simulation.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/single_group.hpp"
#include "output/totals.hpp"
#include "scene/build.hpp"
#include "scene/reader.hpp"
#include "serial/engine.hpp"

namespace mappm {
namespace {

const std::string discs = "tests/python/scenes/random_discs.toml";

/// The digest after some steps of the engine by itself.
template <int D>
std::string digest_of_engine(const std::string& file, int steps) {
  const Scene scene = read_scene(file, {});
  const BuiltModel<D> built = make_model<D>(scene);
  SerialEngine<D> engine(built.model, build_state<D>(scene, built.model, Region<D>::whole_box()), Neighbours::cells);
  for (int n = 0; n < steps; ++n) engine.step();
  return digest_text(measure(built.model, engine.sample(), SingleGroup()).digest());
}

TEST(Simulation, HasTheDigestOfTheEngineInPlaneAndSpace) {
  Simulation plane(discs), space("cases/crossing_3d/case.toml");
  for (int n = 0; n < 5; ++n) plane.step();
  space.step();
  EXPECT_EQ(plane.digest(), digest_of_engine<2>(discs, 5));
  EXPECT_EQ(space.digest(), digest_of_engine<3>("cases/crossing_3d/case.toml", 1));
}

TEST(Simulation, CountsItsStepsAndParticles) {
  Simulation simulation(discs);
  EXPECT_EQ(simulation.present_step(), 0u);
  simulation.step();
  EXPECT_EQ(simulation.present_step(), 1u);
  EXPECT_GT(simulation.particles(), 800u);  // 24 x 48 nodes, less those in eight discs, and their FPs
  EXPECT_LT(simulation.particles(), 24u * 48u);
}

TEST(Simulation, TakesOverridesAndWarnsOfWhatIsDoubtful) {
  const std::size_t usual = Simulation(discs).warnings().size();
  EXPECT_EQ(Simulation(discs, {"run.step_factor=1.3"}).warnings().size(), usual + 1);  // from 1.44 on sound grows
  EXPECT_NE(Simulation(discs, {"body.0.angular_velocity=0.1"}).digest(), Simulation(discs).digest());
}

TEST(Simulation, RefusesASceneThatIsNotThere) { EXPECT_THROW(Simulation("no/such.toml"), InputError); }

TEST(Simulation, EndsWhereAContactIsTooSoft) {
  Simulation simulation(discs, {"contact.stiffness=1e-6", "body.0.velocity=[0.0,0.0]", "force.fluid=[0.0,-0.2]"});
  EXPECT_THROW(for (int n = 0; n < 3000; ++n) simulation.step(), RangeError);
}

}  // namespace
}  // namespace mappm
