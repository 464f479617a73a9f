#define EIGEN_DONT_VECTORIZE  // the same bits on every machine
#include <Eigen/Dense>

#include <optional>
#include <utility>

#include "scene/build.hpp"
#include "scene/carving.hpp"
#include "scene/disorder.hpp"
#include "scene/lattice.hpp"
#include "scene/solids.hpp"
#include "scene/velocity_field.hpp"

namespace mappm {

namespace {

/// Nodes whose PPs may start inside the region.
template <int D>
NodeRange<D> nodes_of(const Lattice<D>& lattice, const Region<D>& region, const Disorder<D>& disorder) {
  NodeRange<D> range;
  for (int axis = 0; axis < D; ++axis) {
    range.first[axis] = lattice.first_at_or_above(axis, region.low[axis] - disorder.reach(axis));
    range.last[axis] = lattice.first_at_or_above(axis, region.high[axis] + disorder.reach(axis));
  }
  return range;
}

/// Ids of nodes of a range, asked for in ascending order.
class NodeSet {
 public:
  explicit NodeSet(std::vector<std::uint64_t>&& ids) : ids_(std::move(ids)), next_(ids_.begin()) {}
  NodeSet(const NodeSet&) = delete;
  NodeSet& operator=(const NodeSet&) = delete;
  std::size_t size() const { return ids_.size(); }
  bool has(std::uint64_t id) {
    if (next_ == ids_.end() || *next_ != id) return false;
    ++next_;
    return true;
  }

 private:
  std::vector<std::uint64_t> ids_;
  std::vector<std::uint64_t>::const_iterator next_;
};

template <int D>
void fill_fluid(const Scene& scene, const Model<D>& model, const Lattice<D>& lattice,
                const std::vector<PlacedSolid<D>>& solids, const Region<D>& region, FluidParticles<D>& fluid) {
  const Disorder<D> disorder(scene.fluid, lattice);
  const NodeRange<D> range = nodes_of(lattice, region, disorder);
  if (range.size() == 0) return;
  std::optional<Carving<D>> carving;
  if (!solids.empty()) carving.emplace(scene, model, lattice, solids);
  NodeSet removed(carving ? carving->removed(range) : std::vector<std::uint64_t>{});
  NodeSet held(carving && scene.fluid.disorder ? carving->nearer_than(model.spacing, range)
                                               : std::vector<std::uint64_t>{});
  const InitialVelocity<D> velocity(scene.fluid, model.units);
  fluid.resize(range.size() - removed.size());
  std::size_t particle = 0;
  std::array<std::uint64_t, D> node = range.first;
  while (node[D - 1] < range.last[D - 1]) {
    const std::uint64_t id = lattice.id(node);
    const bool displaced = !held.has(id);
    Vec<D, double> x;
    for (int axis = 0; axis < D; ++axis)
      x[axis] = lattice.position(axis, node[axis]) + (displaced ? disorder.displacement(id, axis) : 0.0);
    if (!removed.has(id) && region.contains(x)) {
      const Vec<D, double> v = velocity.at(x);
      fluid.id[particle] = id;
      for (int axis = 0; axis < D; ++axis) {
        fluid.x(axis)[particle] = x[axis];
        fluid.v(axis)[particle] = v[axis];
      }
      ++particle;
    }
    ++node[0];
    for (int axis = 0; axis + 1 < D && node[axis] == range.last[axis]; ++axis) {
      node[axis] = range.first[axis];
      ++node[axis + 1];
    }
  }
  fluid.resize(particle);
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
  const BodyScene& body = scene.bodies[placed.body];
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
