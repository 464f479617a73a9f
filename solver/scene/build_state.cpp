#define EIGEN_DONT_VECTORIZE  // the same bits on every machine
#include <Eigen/Dense>

#include <cmath>

#include "scene/build.hpp"
#include "scene/carving.hpp"
#include "scene/lattice.hpp"
#include "scene/solids.hpp"

namespace mappm {

namespace {

template <int D>
NodeRange<D> nodes_inside(const Lattice<D>& lattice, const Region<D>& region) {
  NodeRange<D> range;
  for (int axis = 0; axis < D; ++axis) {
    range.first[axis] = lattice.first_at_or_above(axis, region.low[axis]);
    range.last[axis] = lattice.first_at_or_above(axis, region.high[axis]);
  }
  return range;
}

/// Initial velocity of the fluid, c: uniform but for one component that may vary along one axis.
template <int D>
class InitialVelocity {
 public:
  InitialVelocity(const Scene& scene, const Model<D>& model, const Lattice<D>& lattice, const NodeRange<D>& range) {
    const double unit = model.units.velocity;
    for (int axis = 0; axis < D; ++axis)
      uniform_[axis] = round_to_quantum(scene.fluid.velocity[static_cast<std::size_t>(axis)] / unit, velocity_quantum);
    if (!scene.fluid.wave) return;
    const FluidScene::Wave& wave = *scene.fluid.wave;
    direction_ = wave.direction;
    gradient_ = wave.gradient;
    first_ = range.first[gradient_];
    for (std::uint64_t i = first_; i < range.last[gradient_]; ++i) {
      const double turns = wave.mode * (lattice.position(gradient_, i) / box_quanta);
      const double speed =
          scene.fluid.velocity[static_cast<std::size_t>(direction_)] + wave.amplitude * unit_circle(turns)[1];
      varying_.push_back(round_to_quantum(speed / unit, velocity_quantum));
    }
  }

  double at(int axis, const std::array<std::uint64_t, D>& node) const {
    return axis == direction_ ? varying_[node[gradient_] - first_] : uniform_[axis];
  }

 private:
  Vec<D, double> uniform_;
  int direction_ = -1;  // no wave
  int gradient_ = 0;
  std::uint64_t first_ = 0;
  std::vector<double> varying_;
};

template <int D>
void fill_fluid(const Scene& scene, const Model<D>& model, const Lattice<D>& lattice,
                const std::vector<PlacedSolid<D>>& solids, const Region<D>& region, FluidParticles<D>& fluid) {
  const NodeRange<D> range = nodes_inside(lattice, region);
  if (range.size() == 0) return;
  const std::vector<std::uint64_t> removed =
      solids.empty() ? std::vector<std::uint64_t>{} : Carving<D>(scene, model, lattice, solids).removed(range);
  const InitialVelocity<D> velocity(scene, model, lattice, range);
  const double density = round_to_quantum(model.rest_density, density_quantum);
  fluid.resize(range.size() - removed.size());
  auto next_removed = removed.begin();
  std::size_t particle = 0;
  std::array<std::uint64_t, D> node = range.first;
  while (node[D - 1] < range.last[D - 1]) {
    const std::uint64_t id = lattice.id(node);
    if (next_removed != removed.end() && *next_removed == id) {
      ++next_removed;
    } else {
      fluid.id[particle] = id;
      for (int axis = 0; axis < D; ++axis) {
        fluid.x(axis)[particle] = lattice.position(axis, node[axis]);
        fluid.v(axis)[particle] = velocity.at(axis, node);
      }
      fluid.density()[particle++] = density;
    }
    ++node[0];
    for (int axis = 0; axis + 1 < D && node[axis] == range.last[axis]; ++axis) {
      node[axis] = range.first[axis];
      ++node[axis + 1];
    }
  }
}

/// I omega of a body in its initial orientation, c rcut per PP mass.
template <int D>
AngularVec<D, double> multiply_inertia(const Shape<D>& shape, const AngularVec<D, double>& omega) {
  if constexpr (D == 2) {
    return {{omega[0] / shape.inverse_inertia[0]}};
  } else {
    const Eigen::Matrix3d inverse =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(shape.inverse_inertia.component);
    const Eigen::Vector3d momentum = inverse.inverse() * Eigen::Vector3d(omega[0], omega[1], omega[2]);
    return {{momentum[0], momentum[1], momentum[2]}};
  }
}

SolidMotion solid_motion(Motion motion) {
  switch (motion) {
    case Motion::free:
      return SolidMotion::free;
    case Motion::moving:
      return SolidMotion::moving;
    case Motion::fixed:
      return SolidMotion::fixed;
  }
  return SolidMotion::fixed;
}

template <int D>
Solid<D> make_solid(const Scene& scene, const Model<D>& model, const PlacedSolid<D>& placed, std::uint64_t id) {
  const BodyScene& body = scene.bodies[placed.shape];
  const Shape<D>& shape = model.shapes[placed.shape];
  Solid<D> solid;
  solid.id = id;
  solid.shape = placed.shape;
  solid.group = placed.group;
  solid.motion = solid_motion(body.motion);
  solid.x = placed.x;
  const Triple& velocity = body.velocities[placed.member];
  for (int axis = 0; axis < D; ++axis) {
    const double speed = velocity[static_cast<std::size_t>(axis)] / model.units.velocity;
    solid.momentum[axis] = to_fixed_wide(shape.mass * speed / velocity_quantum);
  }
  if (shape.rotates && !is_wall(body)) {
    const Triple& declared = body.angular_velocities[placed.member];
    AngularVec<D, double> omega;
    for (int i = 0; i < angular_components<D>; ++i)
      omega[i] = declared[static_cast<std::size_t>(D == 2 ? 2 : i)] * model.units.time();
    const AngularVec<D, double> momentum = multiply_inertia(shape, omega);
    for (int i = 0; i < angular_components<D>; ++i)
      solid.angular_momentum[i] = to_fixed_wide(momentum[i] / velocity_quantum);
  }
  solid.density.assign(shape.frozen.size(), round_to_quantum(model.rest_density, density_quantum));
  return solid;
}

}  // namespace

template <int D>
State<D> build_state(const Scene& scene, const Model<D>& model, const Region<D>& region) {
  const Lattice<D> lattice = make_lattice<D>(scene);
  const std::vector<PlacedSolid<D>> solids = place_solids(scene, model, lattice);
  State<D> state;
  if (model.terms.fluid) fill_fluid(scene, model, lattice, solids, region, state.fluid);
  for (std::size_t i = 0; i < solids.size(); ++i)
    if (region.contains(solids[i].x)) state.solids.push_back(make_solid(scene, model, solids[i], i));
  return state;
}

template State<2> build_state<2>(const Scene&, const Model<2>&, const Region<2>&);
template State<3> build_state<3>(const Scene&, const Model<3>&, const Region<3>&);

}  // namespace mappm
