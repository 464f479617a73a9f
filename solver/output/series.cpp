#include "output/series.hpp"

#include "output/together.hpp"

namespace mappm {

namespace {

template <int D>
Vec<D, double> mean(const Vec<D, Int128>& sum, Int128 count, double quantum) {
  Vec<D, double> result;
  if (count == 0) return result;
  for (int axis = 0; axis < D; ++axis)
    result[axis] = static_cast<double>(sum[axis]) * quantum / static_cast<double>(count);
  return result;
}

/// Forces and velocities of the solids.
template <int D>
void add_solid_columns(const Model<D>& model, const UnitNames& units, const Totals<D>& totals, std::uint64_t steps,
                       const Vec<D, double>& fluid_velocity, Columns& columns) {
  const UnitScale& scale = model.units;
  const Vec<D, double> velocity = mean<D>(totals.mobile_velocity, totals.mobile_count, mean_velocity_quantum);
  columns.add("solid_velocity", units.velocity, scale.velocity * velocity);
  columns.add("slip", units.velocity, scale.velocity * (velocity - fluid_velocity));
  const double share = totals.sp_count == 0 ? 0.0 : 1.0 / static_cast<double>(totals.sp_count);
  columns.add("drag", units.force, scale.force() * (share * mean_force(totals.sp_impulse, steps, model.dt)));
  columns.add("wall_force", units.force, scale.force() * mean_force(totals.wall_impulse, steps, model.dt));
}

}  // namespace

template <int D>
Columns series_columns(const Model<D>& model, const UnitNames& units, const Totals<D>& totals,
                       const Vec<D, Int128>& start_momentum, std::uint64_t sampled_step) {
  const UnitScale& scale = model.units;
  Columns columns;
  columns.add("step", "", totals.step);
  columns.add("time", units.time, static_cast<double>(totals.step) * (model.dt * scale.time()));

  const Vec<D, double> velocity = mean<D>(totals.fluid_momentum, totals.fluid_count, velocity_quantum);
  columns.add("fluid_velocity", units.velocity, scale.velocity * velocity);
  double volume = 1.0;
  for (int axis = 0; axis < D; ++axis) volume *= model.box[axis];
  const double fluid_fraction = static_cast<double>(totals.fluid_count) / (model.rest_density * volume);
  columns.add("superficial_velocity", units.velocity, scale.velocity * (fluid_fraction * velocity));
  if (model.terms.solids) add_solid_columns(model, units, totals, totals.step - sampled_step, velocity, columns);

  const double energy = scale.mass * scale.velocity * scale.velocity * energy_quantum;
  columns.add("fluid_energy", units.energy, static_cast<double>(totals.fluid_energy) * energy);
  columns.add("internal_energy", units.energy, static_cast<double>(totals.internal_energy) * energy);
  if (model.terms.solids) {
    columns.add("solid_energy", units.energy, static_cast<double>(totals.solid_energy) * energy);
    columns.add("spin_energy", units.energy, static_cast<double>(totals.spin_energy) * energy);
  }
  AngularVec<D, double> angular_momentum;
  const double angular = scale.mass * scale.velocity * scale.length * angular_quantum;
  for (int k = 0; k < angular_components<D>; ++k)
    angular_momentum[k] = static_cast<double>(totals.angular_momentum[k]) * angular;
  columns.add("angular_momentum", units.angular_momentum, angular_momentum);
  columns.add("fluid_particles", "", static_cast<std::uint64_t>(totals.fluid_count));
  if (model.terms.fluid) {
    columns.add("lowest_density_ratio", "", totals.lowest_density / model.rest_density);
    columns.add("highest_density_ratio", "", totals.highest_density / model.rest_density);
  }
  columns.add("momentum", "", totals.momentum);
  columns.add("impulse", "", totals.outside_impulse);
  columns.add("momentum_defect", "", momentum_defect(totals, start_momentum));
  columns.add("digest", "", digest_text(totals.digest()));
  return columns;
}

template <int D>
Series<D>::Series(const std::filesystem::path& folder, const Model<D>& model, const UnitNames& units,
                  const Group& group, std::optional<std::uint64_t> resumed_step)
    : model_(model), units_(units), group_(group) {
  on_first(group, [&] {
    const std::string header = series_columns(model, units, Totals<D>{}, {}, 0).header();
    file_.emplace(folder / "series.csv", header, resumed_step);
  });
}

template <int D>
void Series<D>::add(const Totals<D>& totals, const Vec<D, Int128>& start_momentum, std::uint64_t sampled_step) {
  on_first(group_,
           [&] { file_->add(series_columns(model_, units_, totals, start_momentum, sampled_step).row() + '\n'); });
}

template Columns series_columns<2>(const Model<2>&, const UnitNames&, const Totals<2>&, const Vec<2, Int128>&,
                                   std::uint64_t);
template Columns series_columns<3>(const Model<3>&, const UnitNames&, const Totals<3>&, const Vec<3, Int128>&,
                                   std::uint64_t);
template class Series<2>;
template class Series<3>;

}  // namespace mappm
