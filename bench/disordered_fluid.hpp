// A fluid for benchmarks: a square or cubic box of PPs, moved off their lattice by up to a fifth of a spacing, with a
// shear wave. rcut is 3.54 spacings in the plane (39 neighbours), 2.64 in space (77).
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "scene/build.hpp"
#include "scene/reader.hpp"

namespace mappm::bench {

template <int D>
struct DisorderedFluid {
  Scene scene;
  Model<D> model;

  /// `side`: PPs along each axis.
  explicit DisorderedFluid(std::uint64_t side)
      : scene(read_scene_text(text(static_cast<double>(side)), "bench", {})), model(make_model<D>(scene).model) {}

  /// The PPs whose lattice nodes lie in `region`.
  State<D> state(const Region<D>& region) const {
    State<D> state = build_state<D>(scene, model, region);
    for (std::size_t i = 0; i < state.fluid.size(); ++i)
      for (int axis = 0; axis < D; ++axis) {
        const std::uint64_t random = ParticleHash(state.fluid.id[i]).add(static_cast<std::uint64_t>(axis)).value();
        const double share = static_cast<double>(random >> 11) * 0x1p-52 - 1.0;  // in [-1, 1)
        const double moved = 0.2 * share * model.spacing / model.pair.length[axis];
        state.fluid.x(axis)[i] = wrap_position(state.fluid.x(axis)[i] + std::nearbyint(moved));
      }
    return state;
  }

 private:
  static std::string text(double side) {
    return fmt::format(
        "name = \"bench\"\nunits = \"dimensionless\"\n[box]\nsize = [{0}, {0}{1}]\n[run]\nsteps = 1\n[fluid]\n"
        "density = 1.0\nviscosity = 0.1\nspacing = 1.0\nrcut = {2}\nsound_speed = 1.0\n"
        "wave = {{ amplitude = 0.05, direction = \"x\", gradient = \"y\" }}\n",
        side, D == 2 ? "" : fmt::format(", {}", side), D == 2 ? 3.54 : 2.64);
  }
};

/// Distance in rcut, without periodic images.
template <int D>
double distance(const Model<D>& model, const FluidParticles<D>& fluid, std::size_t i, std::size_t j) {
  const Vec<D, double> r = separation(model.pair, fluid.position(i) - fluid.position(j));
  return std::sqrt(dot(r, r));
}

}  // namespace mappm::bench
