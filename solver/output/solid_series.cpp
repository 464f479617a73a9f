#include "output/solid_series.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "output/together.hpp"

namespace mappm {

namespace {

template <int N, class T>
void append(std::vector<double>& to, const Vec<N, T>& values) {
  to.insert(to.end(), values.component, values.component + N);
}

template <int N>
Vec<N, double> take(const double*& from) {
  Vec<N, double> values;
  for (int k = 0; k < N; ++k) values[k] = *from++;
  return values;
}

}  // namespace

template <int D>
SolidSeries<D>::SolidSeries(const std::filesystem::path& folder, const Model<D>& model, const UnitNames& units,
                            const Group& group, std::optional<std::uint64_t> resumed_step)
    : model_(model), units_(units), group_(group) {
  on_first(group, [&] {
    const std::array<double, value_count> none{};
    file_.emplace(folder / "solids.csv", columns(0, none.data()).header(), resumed_step);
  });
}

template <int D>
std::vector<double> SolidSeries<D>::values_of(const Solid<D>& solid, std::uint64_t steps) const {
  const UnitScale& scale = model_.units;
  const RigidVelocity<D> velocity = rigid_velocity(solid, model_.shapes[solid.shape]);
  Vec<D, double> x;
  for (int axis = 0; axis < D; ++axis) x[axis] = solid.x[axis] * model_.pair.length[axis] * scale.length;
  const Vec<D, double> drag = mean_force(solid.fluid_impulse - solid.sampled_impulse, steps, model_.dt);

  std::vector<double> values{static_cast<double>(solid.id)};
  values.reserve(value_count);
  append(values, x);
  append(values, scale.velocity * velocity.linear);
  append(values, solid.orientation.component);
  append(values, (1.0 / scale.time()) * velocity.angular);
  append(values, scale.force() * drag);
  return values;
}

template <int D>
Columns SolidSeries<D>::columns(std::uint64_t step, const double* values) const {
  Columns columns;
  columns.add("step", "", step);
  columns.add("time", units_.time, static_cast<double>(step) * (model_.dt * model_.units.time()));
  columns.add("id", "", static_cast<std::uint64_t>(*values++));
  columns.add("position", units_.length, take<D>(values));
  columns.add("velocity", units_.velocity, take<D>(values));
  const std::array<const char*, 4> names = D == 2 ? std::array{"cos", "sin", "", ""} : std::array{"w", "x", "y", "z"};
  for (int k = 0; k < orientations; ++k) columns.add(std::string("orientation_") + names[k], "", *values++);
  columns.add("angular_velocity", units_.angular_velocity, take<angular_components<D>>(values));
  columns.add("drag", units_.force, take<D>(values));
  return columns;
}

template <int D>
void SolidSeries<D>::add(const State<D>& state, std::uint64_t sampled_step) {
  std::vector<double> mine;
  for (const Solid<D>& solid : state.solids) {
    if (is_wall_piece(model_.shapes[solid.shape])) continue;
    const std::vector<double> values = values_of(solid, state.step - sampled_step);
    mine.insert(mine.end(), values.begin(), values.end());
  }
  const std::vector<double> all = group_.gather(mine);
  on_first(group_, [&] {
    std::vector<const double*> rows;
    for (std::size_t k = 0; k < all.size(); k += value_count) rows.push_back(all.data() + k);
    std::sort(rows.begin(), rows.end(), [](const double* a, const double* b) { return *a < *b; });
    std::string text;
    for (const double* row : rows) text += columns(state.step, row).row() + '\n';
    file_->add(text);
  });
}

template class SolidSeries<2>;
template class SolidSeries<3>;

}  // namespace mappm
