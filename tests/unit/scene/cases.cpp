// Every declared case can be read and built, and lies inside the mapped region.
#include <filesystem>
#include <fstream>
#include <iterator>

#include "unit/scene/scene_setup.hpp"

namespace mappm::test {
namespace {

/// A case of bits alone may be too coarse to measure anything: it is run in many ways, and should be small.
bool compares_bits(const std::filesystem::path& file) {
  std::ifstream stream(file);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return text.find("[case.equivalence]") != std::string::npos && text.find("[[case.observable]]") == std::string::npos;
}

template <int D>
void expect_buildable(const Scene& scene) {
  const BuiltModel<D> built = make_model<D>(scene);
  if (compares_bits(scene.file)) return;
  for (const std::string& warning : built.warnings) ADD_FAILURE() << scene.file << ": " << warning;
}

TEST(SceneCases, AllAreReadAndBuiltWithoutWarnings) {
  std::size_t count = 0;
  for (const auto& folder : std::filesystem::directory_iterator("cases")) {
    const std::filesystem::path file = folder.path() / "case.toml";
    if (!std::filesystem::exists(file)) continue;
    ++count;
    SCOPED_TRACE(file.string());
    const Scene scene = read_scene(file.string(), {});
    EXPECT_EQ(scene.name, folder.path().filename().string());
    scene.dimension == 2 ? expect_buildable<2>(scene) : expect_buildable<3>(scene);
  }
  EXPECT_GE(count, 9u);
}

/// Table 1 of the paper: 1024 solids of mass 92622.5, a solids fraction of 0.1307, and
/// (177 * 2816 - 1024 pi 4.5^2) * 12.83 = 5.559 million PPs, counted by parts of the box.
TEST(SceneCases, ThePapersSceneHasThePapersNumbers) {
  const Scene scene = read_scene("cases/gas_solid_paper/case.toml", {});
  const BuiltModel<2> built = make_model<2>(scene);
  const Model<2>& model = built.model;
  const double pi = 3.14159265358979323846;
  const double area = 177.0 * 2816.0;
  const double solids = 1024.0 * pi * 20.25;
  EXPECT_NEAR(solids / area, 0.1307, 5e-5);
  EXPECT_NEAR(static_cast<double>(built.fluid_particles), (area - solids) * 12.83, 500.0);  // the lattice fits the box
  EXPECT_NEAR(model.units.mass, 1.0, 1e-4);
  EXPECT_NEAR(model.shapes[0].mass * model.units.mass, 92622.5, 0.5);
  EXPECT_NEAR(model.units.velocity, 2.93e-4, 1e-9);
  EXPECT_NEAR(model.pair.viscosity, 4.11e-5 / 12.83 * 12.83 / 2.93e-4, 1e-4);
  EXPECT_EQ(scene.bodies[0].positions[0], (Triple{177.0 / 16.0, 11.0, 0.0}));

  std::uint64_t count = 0;
  std::size_t found = 0;
  for (int part = 0; part < 16; ++part) {
    Region<2> region = Region<2>::whole_box();
    region.low[1] = part * box_quanta / 16.0;
    region.high[1] = (part + 1) * box_quanta / 16.0;
    const State<2> state = build_state(scene, model, region);
    count += state.fluid.size();
    found += state.solids.size();
  }
  EXPECT_EQ(count, built.fluid_particles);
  EXPECT_EQ(found, 1024u);
}

}  // namespace
}  // namespace mappm::test
