// What the reader cannot see: whether a scene makes sense as a whole. Private to the builder.
#pragma once

#include <string>
#include <vector>

#include "particles/model.hpp"
#include "physics/step_limit.hpp"
#include "scene/lattice.hpp"
#include "scene/scene.hpp"

namespace mappm {

/// The box against the cutoff, the lattice against the range of numbers.
template <int D>
void check_box(const Scene& scene, const Lattice<D>& lattice);

/// Balls against the box, roughly, before FPs are laid into them: check_solids measures them as they are.
template <int D>
void check_balls(const Scene& scene);

/// Solids against box and cutoff, and against each other.
template <int D>
void check_solids(const Scene& scene, const Model<D>& model);

/// Declared velocities against the sound speed.
template <int D>
void check_velocities(const Scene& scene, const Model<D>& model);

/// Solids must not meet two periodic images of one another, and the box must hold the margin of their copies.
template <int D>
void check_margin(const Scene& scene, const Model<D>& model);

/// The step (s) against its limits (s): refused beyond `refused_step` times the smallest.
void check_step(const Scene& scene, double step, const StepLimits& limits);

/// One line for each way in which the scene lies outside the region in which errors are known.
template <int D>
std::vector<std::string> scene_warnings(const Scene& scene, const Model<D>& model, const Lattice<D>& lattice,
                                        const StepLimits& limits);

/// The largest speed declared for anything in the scene.
double largest_declared_speed(const Scene& scene);

}  // namespace mappm
