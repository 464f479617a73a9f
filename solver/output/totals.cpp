#include "output/totals.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "physics/state_equation.hpp"

namespace mappm {

namespace {

/// Calls visit for every integer that is summed over the group.
template <int D, class Visit>
void visit_sums(Totals<D>& totals, Visit&& visit) {
  visit(totals.fluid_count);
  visit(totals.frozen_count);
  visit(totals.sp_count);
  visit(totals.mobile_count);
  for (Vec<D, Int128>* sum : {&totals.fluid_momentum, &totals.mobile_velocity, &totals.sp_impulse, &totals.wall_impulse,
                              &totals.momentum, &totals.outside_impulse})
    for (Int128& component : sum->component) visit(component);
  visit(totals.fluid_energy);
  visit(totals.solid_energy);
  visit(totals.spin_energy);
  visit(totals.internal_energy);
  for (Int128& component : totals.angular_momentum.component) visit(component);
  visit(totals.digest_sum);
}

/// Position relative to the middle of the box, rcut; the same for a particle and its periodic images.
template <int D>
Vec<D, double> from_middle(const Model<D>& model, const Vec<D, double>& x) {
  Vec<D, double> position;
  for (int axis = 0; axis < D; ++axis)
    position[axis] = (wrap_position(x[axis]) - 0.5 * box_quanta) * model.pair.length[axis];
  return position;
}

/// Angular momentum about the middle of the box of a momentum (PP mass c) at x.
template <int D>
AngularVec<D, Int128> orbital(const Model<D>& model, const Vec<D, double>& x, const Vec<D, double>& momentum) {
  const AngularVec<D, double> value = cross<D, double>(from_middle(model, x), momentum);
  AngularVec<D, Int128> result;
  for (int k = 0; k < angular_components<D>; ++k) result[k] = to_fixed_wide(value[k] / angular_quantum);
  return result;
}

template <int D>
void add_fluid(const Model<D>& model, const FluidParticles<D>& fluid, const std::vector<double>& density,
               Totals<D>& totals) {
  totals.fluid_count = static_cast<Int128>(fluid.size());
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    Vec<D, double> x, v;
    for (int axis = 0; axis < D; ++axis) {
      x[axis] = fluid.x(axis)[i];
      v[axis] = fluid.v(axis)[i];
      totals.fluid_momentum[axis] += static_cast<std::int64_t>(v[axis] / velocity_quantum);
    }
    totals.fluid_energy += to_fixed_wide(0.5 * dot(v, v) / energy_quantum);
    const double compression = internal_energy(density[i], model.rest_density, 1.0, model.background);
    totals.internal_energy += to_fixed_wide(compression / energy_quantum);
    totals.angular_momentum += orbital(model, x, v);
    totals.lowest_density = std::fmin(totals.lowest_density, density[i]);
    totals.highest_density = std::fmax(totals.highest_density, density[i]);
  }
}

template <int D>
void add_solid(const Model<D>& model, const Solid<D>& solid, const Shape<D>& shape, Totals<D>& totals) {
  totals.frozen_count += static_cast<Int128>(shape.frozen.size());
  const Vec<D, Int128> impulse = solid.fluid_impulse - solid.sampled_impulse;
  if (is_wall_piece(shape)) {
    totals.wall_impulse += impulse;
    return;
  }
  totals.sp_count += 1;
  totals.sp_impulse += impulse;
  if (solid.motion == SolidMotion::fixed) return;
  totals.mobile_count += 1;
  const RigidVelocity<D> velocity = rigid_velocity(solid, shape);
  for (int axis = 0; axis < D; ++axis)
    totals.mobile_velocity[axis] += to_fixed_wide(velocity.linear[axis] / mean_velocity_quantum);
  totals.solid_energy += to_fixed_wide(0.5 * shape.mass * dot(velocity.linear, velocity.linear) / energy_quantum);
  Vec<D, double> momentum;
  for (int axis = 0; axis < D; ++axis) momentum[axis] = static_cast<double>(solid.momentum[axis]) * velocity_quantum;
  constexpr Int128 quanta = static_cast<Int128>(velocity_quantum / angular_quantum);
  totals.angular_momentum += orbital(model, solid.x, momentum) + quanta * solid.angular_momentum;
  AngularVec<D, double> angular_momentum;
  for (int k = 0; k < angular_components<D>; ++k)
    angular_momentum[k] = static_cast<double>(solid.angular_momentum[k]) * velocity_quantum;
  totals.spin_energy += to_fixed_wide(0.5 * dot(angular_momentum, velocity.angular) / energy_quantum);
}

}  // namespace

template <int D>
Totals<D> measure(const Model<D>& model, const Sample<D>& sample, const Group& group) {
  const State<D>& state = sample.state;
  Totals<D> totals;
  totals.lowest_density = std::numeric_limits<double>::infinity();
  totals.highest_density = -std::numeric_limits<double>::infinity();
  add_fluid(model, state.fluid, sample.density.fluid, totals);
  for (const Solid<D>& solid : state.solids) add_solid(model, solid, model.shapes[solid.shape], totals);
  totals.momentum = momentum_share(state);
  totals.outside_impulse = state.outside_impulse;
  totals.digest_sum = static_cast<Int128>(digest_share(state));

  std::vector<Int128> sums;
  visit_sums(totals, [&](const Int128& sum) { sums.push_back(sum); });
  group.sum(std::span<Int128>(sums));
  std::size_t next = 0;
  visit_sums(totals, [&](Int128& sum) { sum = sums[next++]; });

  std::array<double, 2> extremes{totals.lowest_density, -totals.highest_density};
  group.minimum(extremes);
  const bool none = totals.fluid_count == 0;
  totals.lowest_density = none ? std::nan("") : extremes[0];
  totals.highest_density = none ? std::nan("") : -extremes[1];
  totals.step = state.step;
  return totals;
}

std::string digest_text(std::uint64_t digest) { return fmt::format("{:016x}", digest); }

template Totals<2> measure<2>(const Model<2>&, const Sample<2>&, const Group&);
template Totals<3> measure<3>(const Model<3>&, const Sample<3>&, const Group&);

}  // namespace mappm
