// Turns a scene into a Model and particles: made dimensionless once, here.
#pragma once

#include <string>
#include <vector>

#include "particles/model.hpp"
#include "particles/state.hpp"
#include "physics/step_limit.hpp"
#include "scene/scene.hpp"

namespace mappm {

template <int D>
struct BuiltModel {
  Model<D> model;
  std::uint64_t fluid_particles = 0;  // PPs in the whole box
  StepLimits limits;                  // of the step, in scene units
  std::vector<std::string> warnings;  // one line each: scenes outside the mapped region, a step beyond its limit
};

/// Throws InputError for what the reader cannot see: overlapping solids, a solid larger than the box, a box smaller
/// than 2 rcut, a step beyond the last that is stable.
template <int D>
BuiltModel<D> make_model(const Scene& scene);

/// The particles at step 0 inside `region`. The union over any partition of the box is the same set, bit by bit:
/// PP ids are lattice indices, solid ids count from 0 in the order of the scene.
template <int D>
State<D> build_state(const Scene& scene, const Model<D>& model, const Region<D>& region);

}  // namespace mappm
