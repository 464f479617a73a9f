#include "output/snapshot.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "output/durable_file.hpp"
#include "output/hdf5_file.hpp"
#include "output/together.hpp"
#include "output/totals.hpp"
#include "physics/state_equation.hpp"

namespace mappm {

namespace {

constexpr std::uint8_t vtk_vertex = 1;
constexpr std::int64_t no_solid = -1;
constexpr std::uint8_t fluid_kind = 0, frozen_kind = 1;

/// Appends a vector with zeros for what the plane lacks.
template <int D>
void append_triple(std::vector<double>& to, const Vec<D, double>& value) {
  for (int axis = 0; axis < 3; ++axis) to.push_back(axis < D ? value[axis < D ? axis : 0] : 0.0);
}

/// Position in scene units of position quanta that may lie outside the box.
template <int D>
Vec<D, double> position_in_scene(const Model<D>& model, const Vec<D, double>& x) {
  Vec<D, double> position;
  for (int axis = 0; axis < D; ++axis)
    position[axis] = wrap_position(x[axis]) * model.pair.length[axis] * model.units.length;
  return position;
}

struct FluidPoints {
  std::vector<double> position, velocity, density, pressure;
  std::vector<std::int64_t> id, solid;
  std::vector<std::uint8_t> kind;

  void reserve(std::size_t count) {
    for (auto* values : {&position, &velocity}) values->reserve(3 * count);
    for (auto* values : {&density, &pressure}) values->reserve(count);
    for (auto* values : {&id, &solid}) values->reserve(count);
    kind.reserve(count);
  }
};

template <int D>
void add_point(const Model<D>& model, const Vec<D, double>& x, const Vec<D, double>& v, double density,
               FluidPoints& points) {
  const UnitScale& scale = model.units;
  double density_scale = scale.mass;
  for (int axis = 0; axis < D; ++axis) density_scale /= scale.length;
  append_triple(points.position, position_in_scene(model, x));
  append_triple(points.velocity, scale.velocity * v);
  points.density.push_back(density * density_scale);
  points.pressure.push_back(pressure(density, model.rest_density, 1.0, model.background) * density_scale *
                            scale.velocity * scale.velocity);
}

template <int D>
FluidPoints fluid_points(const Model<D>& model, const Sample<D>& sample) {
  const State<D>& state = sample.state;
  FluidPoints points;
  points.reserve(state.fluid.size() + sample.density.frozen.size());
  for (std::size_t i = 0; i < state.fluid.size(); ++i) {
    Vec<D, double> x, v;
    for (int axis = 0; axis < D; ++axis) {
      x[axis] = state.fluid.x(axis)[i];
      v[axis] = state.fluid.v(axis)[i];
    }
    add_point(model, x, v, sample.density.fluid[i], points);
    points.id.push_back(static_cast<std::int64_t>(state.fluid.id[i]));
    points.solid.push_back(no_solid);
    points.kind.push_back(fluid_kind);
  }
  for (const FrozenPoint<D>& fp : sample.density.frozen) {
    add_point(model, fp.x, fp.v, fp.density, points);
    points.id.push_back(static_cast<std::int64_t>(fp.index));
    points.solid.push_back(static_cast<std::int64_t>(fp.solid));
    points.kind.push_back(frozen_kind);
  }
  return points;
}

struct SolidPoints {
  std::vector<double> position, radius, velocity, angular_velocity, drag;
  std::vector<std::int64_t> id;
};

template <int D>
SolidPoints solid_points(const Model<D>& model, const State<D>& state, std::uint64_t sampled_step) {
  const UnitScale& scale = model.units;
  SolidPoints points;
  for (const Solid<D>& solid : state.solids) {
    const Shape<D>& shape = model.shapes[solid.shape];
    const RigidVelocity<D> velocity = rigid_velocity(solid, shape);
    const Vec<D, double> drag =
        scale.force() * mean_force(solid.fluid_impulse - solid.sampled_impulse, state.step - sampled_step, model.dt);
    for (const Ball<D>& ball : shape.balls) {
      const Vec<D, double> offset = rotate(solid.orientation, ball.offset);
      Vec<D, double> centre;
      for (int axis = 0; axis < D; ++axis) centre[axis] = solid.x[axis] + offset[axis] / model.pair.length[axis];
      append_triple(points.position, position_in_scene(model, centre));
      points.radius.push_back(ball.radius * scale.length);
      append_triple(points.velocity, scale.velocity * velocity.linear);
      for (int axis = D == 2 ? 0 : 2; axis < 2; ++axis) points.angular_velocity.push_back(0.0);
      for (const double component : velocity.angular.component)
        points.angular_velocity.push_back(component / scale.time());
      append_triple(points.drag, drag);
      points.id.push_back(static_cast<std::int64_t>(solid.id));
    }
  }
  return points;
}

/// A VTKHDF file of points, one vertex cell each; point data follow.
class PointFile {
 public:
  PointFile(const std::filesystem::path& path, const std::vector<double>& positions, double time, std::uint64_t step,
            const Group& group)
      : path_(path), group_(group), file_(partial_name(path).string(), group) {
    file_.make_group("VTKHDF");
    file_.attribute("VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
    file_.text_attribute("VTKHDF", "Type", "UnstructuredGrid");
    const std::uint64_t mine = positions.size() / 3;
    const std::uint64_t before = group.sum_before(mine);
    const std::vector<std::uint64_t> all = counted(mine);
    for (const char* count : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
      file_.rows(std::string("VTKHDF/") + count, once(static_cast<std::int64_t>(all[0])), 0);
    file_.rows("VTKHDF/Points", positions, 3);
    std::vector<std::int64_t> index(mine);
    for (std::uint64_t i = 0; i < mine; ++i) index[i] = static_cast<std::int64_t>(before + i);
    file_.rows("VTKHDF/Connectivity", index, 0);
    if (group.rank() == group.size() - 1) index.push_back(static_cast<std::int64_t>(before + mine));
    file_.rows("VTKHDF/Offsets", index, 0);
    file_.rows("VTKHDF/Types", std::vector<std::uint8_t>(mine, vtk_vertex), 0);
    file_.make_group("VTKHDF/FieldData");
    file_.rows("VTKHDF/FieldData/TimeValue", once(time), 0);
    file_.rows("VTKHDF/FieldData/step", once(static_cast<std::int64_t>(step)), 0);
    file_.make_group("VTKHDF/PointData");
  }
  template <class T>
  void point_data(const std::string& name, const std::vector<T>& values, std::size_t width) {
    file_.rows("VTKHDF/PointData/" + name, values, width);
  }
  void finish() {
    file_.close();
    on_first(group_, [&] { publish(path_); });
  }

 private:
  /// A single value, which the first process gives.
  template <class T>
  std::vector<T> once(T value) const {
    return group_.is_first() ? std::vector<T>{value} : std::vector<T>{};
  }
  std::vector<std::uint64_t> counted(std::uint64_t mine) const {
    std::vector<std::uint64_t> count{mine};
    group_.sum(std::span<std::uint64_t>(count));
    return count;
  }

  std::filesystem::path path_;
  const Group& group_;
  Hdf5Writer file_;
};

/// Writes one file through `fill`; where that fails nothing of it stays behind.
template <class Fill>
void write_points(const std::filesystem::path& path, const Group& group, Fill&& fill) {
  try {
    fill();
  } catch (const InputError&) {
    if (group.is_first()) discard_partial(path);
    throw;
  }
}

}  // namespace

SnapshotPaths::SnapshotPaths(const std::filesystem::path& folder, std::uint64_t step) {
  const std::string ending = fmt::format("_{:09}.vtkhdf", step);
  fluid = folder / ("fluid" + ending);
  solids = folder / ("solids" + ending);
}

template <int D>
void write_snapshot(const std::filesystem::path& folder, const Model<D>& model, const Sample<D>& sample,
                    std::uint64_t sampled_step, const Group& group) {
  const State<D>& state = sample.state;
  on_first(group, [&] { make_folder(folder); });
  const double time = static_cast<double>(state.step) * (model.dt * model.units.time());
  const SnapshotPaths paths(folder, state.step);
  write_points(paths.fluid, group, [&] {
    const FluidPoints points = fluid_points(model, sample);
    PointFile file(paths.fluid, points.position, time, state.step, group);
    file.point_data("velocity", points.velocity, 3);
    file.point_data("density", points.density, 0);
    file.point_data("pressure", points.pressure, 0);
    file.point_data("id", points.id, 0);
    file.point_data("solid", points.solid, 0);
    file.point_data("kind", points.kind, 0);
    file.finish();
  });

  bool any_sp = false;
  for (const Shape<D>& shape : model.shapes) any_sp = any_sp || !is_wall_piece(shape);
  if (!any_sp) return;
  write_points(paths.solids, group, [&] {
    const SolidPoints points = solid_points(model, state, sampled_step);
    PointFile file(paths.solids, points.position, time, state.step, group);
    file.point_data("radius", points.radius, 0);
    file.point_data("velocity", points.velocity, 3);
    file.point_data("angular_velocity", points.angular_velocity, 3);
    file.point_data("drag", points.drag, 3);
    file.point_data("id", points.id, 0);
    file.finish();
  });
}

template void write_snapshot<2>(const std::filesystem::path&, const Model<2>&, const Sample<2>&, std::uint64_t,
                                const Group&);
template void write_snapshot<3>(const std::filesystem::path&, const Model<3>&, const Sample<3>&, std::uint64_t,
                                const Group&);

}  // namespace mappm
