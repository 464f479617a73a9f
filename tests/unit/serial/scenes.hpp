// Small scenes for the engines, in rcut, sound speed and PP mass: internal units but for the solids' mass.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "scene/build.hpp"
#include "scene/reader.hpp"

namespace mappm::testing {

/// A scene and what is built of it.
template <int D>
struct Built {
  Scene scene;
  Model<D> model;

  explicit Built(const std::string& text)
      : scene(read_scene_text(text, "test", {})), model(make_model<D>(scene).model) {}

  /// What of the start lies in `region`, without the total of the momentum.
  State<D> state(const Region<D>& region) const { return build_state<D>(scene, model, region); }
  State<D> state() const {
    State<D> whole = state(Region<D>::whole_box());
    whole.start_momentum = momentum_share(whole);
    return whole;
  }
};

/// `text` with its first `from` replaced, which must be there.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

/// The head of every scene: density 1 / spacing^D makes the mass of a PP 1.
inline std::string head(const std::string& box, const std::string& spacing, const std::string& density,
                        const std::string& more = "") {
  return "name = \"test\"\nunits = \"dimensionless\"\n[box]\nsize = " + box +
         "\n[run]\nsteps = 100\n[fluid]\nviscosity = 0.5\nrcut = 1.0\nsound_speed = 1.0\nspacing = " + spacing +
         "\ndensity = " + density + "\n" + more + "\n";
}

/// Free turning discs, and one dumb-bell, driven through each other and against the fluid: every kind of contact, and
/// centres that cross any border, within 200 steps. Domains must be 2.25 wide.
inline std::string dense_discs() {
  return head("[12.0, 10.8]", "0.3", "11.1111111111", "velocity = [0.02, -0.01]") + R"(
[[body]]
shape = "disc"
radius = 1.0
density = 60.0
velocity = [0.17, 0.05]
angular_velocity = 0.1
random = { count = 7, seed = 11, gap = 0.02 }
[[body]]
shape = "disc"
radius = 0.9
density = 50.0
velocity = [-0.16, -0.04]
angular_velocity = -0.1
random = { count = 7, seed = 12, gap = 0.02 }
[[body]]
shape = "composite"
density = 25.0
angular_velocity = 0.12
balls = [{ centre = [0.45, 0.0], radius = 0.5 }, { centre = [-0.45, 0.0], radius = 0.5 }]
random = { count = 2, seed = 13, gap = 0.02 }
[contact]
model = "linear"
stiffness = 80.0
restitution = 0.8
friction = 0.3
[force]
fluid = [0.0, 0.0005]
solid = "balance"
)";
}

/// The discs of `dense_discs` without a fluid.
inline std::string discs_alone() {
  std::string text = replaced(dense_discs(), "viscosity = 0.5", "particles = false");
  text = replaced(text, "velocity = [0.02, -0.01]", "");
  text = replaced(text, "fluid = [0.0, 0.0005]\nsolid = \"balance\"", "");
  return replaced(text, "steps = 100", "steps = 100\nstep = 0.0625");
}

/// Three large discs among small ones of a tenth of their size, which have a single FP. Domains must be 4.25 wide.
inline std::string one_to_ten() {
  return head("[18.0, 17.4]", "0.3", "11.1111111111") + R"(
[[body]]
shape = "disc"
radius = 2.0
density = 15.0
velocity = [0.1, 0.02]
angular_velocity = 0.05
random = { count = 3, seed = 5, gap = 0.05 }
[[body]]
shape = "disc"
radius = 0.2
density = 60.0
velocity = [-0.1, -0.1]
angular_velocity = 0.3
random = { count = 60, seed = 6, gap = 0.02 }
[contact]
model = "linear"
stiffness = 4.0
restitution = 0.9
friction = 0.3
[force]
fluid = [0.001, 0.0]
solid = "balance"
)";
}

/// A fixed and a moving wall with discs that hit both, in the plain method and another kernel.
inline std::string channel() {
  return head("[12.0, 10.8]", "0.3", "11.1111111111", "method = \"classic\"\nkernel = \"lucy\"") + R"(
[[body]]
shape = "wall"
axis = "y"
position = 0.0
thickness = 1.2
[[body]]
shape = "wall"
axis = "y"
position = 5.4
thickness = 1.2
motion = "moving"
velocity = [0.1, 0.0]
[[body]]
shape = "disc"
radius = 0.9
density = 60.0
velocity = [0.05, 0.2]
angular_velocity = 0.1
random = { count = 6, seed = 3, gap = 0.05 }
[[body]]
shape = "disc"
radius = 0.9
density = 30.0
motion = "fixed"
position = [6.0, 9.0]
[contact]
model = "linear"
stiffness = 80.0
restitution = 0.8
friction = 0.3
[force]
fluid = [0.0005, 0.0]
solid = [0.0, -0.001]
)";
}

/// Free turning spheres with Hertz contacts. Domains must be 1.85 wide.
inline std::string spheres() {
  return head("[7.6, 7.6, 7.6]", "0.5", "8.0") + R"(
[[body]]
shape = "sphere"
radius = 0.6
density = 20.0
velocity = [0.1, 0.06, -0.05]
angular_velocity = [0.1, 0.2, -0.1]
random = { count = 20, seed = 1, gap = 0.01 }
[[body]]
shape = "sphere"
radius = 0.55
density = 15.0
velocity = [-0.1, 0.03, 0.08]
angular_velocity = [-0.1, 0.1, 0.2]
random = { count = 20, seed = 2, gap = 0.01 }
[contact]
model = "hertz"
young = 50.0
poisson = 0.25
restitution = 0.8
friction = 0.3
[force]
fluid = [0.0, 0.0, 0.0005]
solid = "balance"
)";
}

/// The PPs of one box, repeated until they fill a larger one, in `larger`. Places are rounded to quanta of another
/// size.
template <int D>
void repeat_fluid(const Built<D>& cell, const Built<D>& larger, const Region<D>& region, State<D>& state) {
  const FluidParticles<D> one = cell.state(Region<D>::whole_box()).fluid;
  Vec<D, int> times;
  int cells = 1;
  for (int axis = 0; axis < D; ++axis)
    cells *= times[axis] = static_cast<int>(std::lround(larger.model.box[axis] / cell.model.box[axis]));
  state.fluid = {};
  for (int n = 0; n < cells; ++n)
    for (std::size_t i = 0; i < one.size(); ++i) {
      Vec<D, double> x;
      for (int axis = 0, rest = n; axis < D; rest /= times[axis++])
        x[axis] = std::floor((one.x(axis)[i] + rest % times[axis] * box_quanta) / times[axis]);
      if (!region.contains(x)) continue;
      state.fluid.id.push_back(static_cast<std::uint64_t>(n) * one.size() + i);
      for (int axis = 0; axis < D; ++axis) {
        state.fluid.x(axis).push_back(x[axis]);
        state.fluid.v(axis).push_back(one.v(axis)[i]);
      }
    }
}

/// Free turning discs, one in each of so many cells side by side, nearer to each other along x than rcut: in a single
/// cell the neighbour is the disc's own image. Domains must be 3 wide.
inline std::string disc_in_each_cell(int along_x, int along_y) {
  return head(fmt::format("[{}.0, {}]", 4 * along_x, 12.5 * along_y), "0.25", "16.0", "velocity = [0.02, 0.01]") +
         fmt::format(R"(
[[body]]
shape = "disc"
radius = 1.75
density = 20.0
velocity = [0.03, -0.02]
angular_velocity = 0.05
array = {{ count = [{}, {}] }}
)",
                     along_x, along_y);
}

/// The same of spheres, near to their neighbours along every axis.
inline std::string sphere_in_each_cell(int along_each) {
  return head(fmt::format("[{0}.0, {0}.0, {0}.0]", 3 * along_each), "0.5", "8.0") + fmt::format(R"(
[[body]]
shape = "sphere"
radius = 1.2
density = 20.0
velocity = [0.03, -0.02, 0.01]
array = {{ count = [{0}, {0}, {0}] }}
)",
                                                                                                along_each);
}

}  // namespace mappm::testing
