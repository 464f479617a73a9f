#include "scene/model_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "scene/obstacles.hpp"
#include "scene/solids.hpp"

namespace mappm {

namespace {

/// More PPs than this within rcut^D, and a density leaves the range of its fixed-point numbers when it doubles.
constexpr double most_dense = 0.5 * exact_quanta * density_quantum;

/// PP masses: the momentum of a heavier solid at the sound speed, and sums of such, could leave their 128 bits.
constexpr double heaviest_solid = 0x1p52;

/// Resolutions and Mach numbers at which drags were measured against known values.
constexpr double least_support = 2.5, most_support = 4.5, least_radius = 4.0, largest_mach = 0.101;

double norm(const Triple& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

std::string step_key(const Scene& scene) { return scene.run.step > 0.0 ? "run.step" : "run.step_factor"; }

/// How to come down to a step.
std::string lower_step(const Scene& scene, double step, const StepLimits& limits) {
  if (scene.run.step > 0.0) return fmt::format("lower it to {:.6g} or less", step);
  return fmt::format("lower it to {:.3g} or less", std::floor(1000.0 * step / limits.ruling().usual) / 1000.0);
}

double declared_step(const Scene& scene) { return scene.run.step > 0.0 ? scene.run.step : scene.run.step_factor; }

}  // namespace

double largest_declared_speed(const Scene& scene) {
  double largest = norm(scene.fluid.velocity) + (scene.fluid.flow ? largest_flow(*scene.fluid.flow) : 0.0);
  for (const BodyScene& body : scene.bodies)
    for (const Triple& velocity : body.velocities) largest = std::max(largest, norm(velocity));
  return largest;
}

namespace {

/// A solid sees another through one periodic image only if both together reach less than half a box.
template <int D>
void check_images(const Scene& scene, const Model<D>& model) {
  std::vector<double> reaches;  // of every solid that touches others, rcut
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (!is_wall(scene.bodies[i]))
      reaches.insert(reaches.end(), scene.bodies[i].positions.size(), model.shapes[i].reach);
  std::sort(reaches.rbegin(), reaches.rend());
  const double side = *std::min_element(scene.box.begin(), scene.box.begin() + D);
  if (reaches.size() > 1 && (reaches[0] + reaches[1]) * scene.fluid.cutoff > 0.5 * side)
    throw InputError(
        scene.file, "box.size", fmt::format("{}", side),
        fmt::format("the two largest solids could touch through two periodic images; with [contact] it must "
                    "be at least {:.6g}",
                    2.0 * (reaches[0] + reaches[1]) * scene.fluid.cutoff));
}

}  // namespace

template <int D>
void check_margin(const Scene& scene, const Model<D>& model) {
  if (model.terms.contact) {
    check_images(scene, model);
    if (const BodyScene* wall = limited_wall(scene))
      throw InputError(scene.file, wall->key + ".extent", "",
                       "contact of solids knows no limited walls; remove extent or [contact]");
  }
  const double needed = solid_margin(model) * scene.fluid.cutoff;
  for (int axis = 0; axis < D; ++axis)
    if (const double side = scene.box[static_cast<std::size_t>(axis)]; side < needed)
      throw InputError(
          scene.file, "box.size", fmt::format("{}", side),
          fmt::format("too small for its solids and the reach of their forces; it must be at least {:.6g}{}", needed,
                      scene.fluid.particles ? "" : ", or fluid.rcut smaller"));
}

template <int D>
void check_box(const Scene& scene, const Lattice<D>& lattice) {
  double nodes = 1.0;
  for (int axis = 0; axis < D; ++axis) {
    const double side = scene.box[static_cast<std::size_t>(axis)];
    nodes *= static_cast<double>(lattice.count[axis]);
    if (side < 2.0 * (1.0 + 1e-9) * scene.fluid.cutoff)
      throw InputError(scene.file, "box.size", fmt::format("{}", side),
                       fmt::format("must be longer than 2 rcut = {}; enlarge the box or lower fluid.rcut or "
                                   "fluid.spacing",
                                   2.0 * scene.fluid.cutoff));
  }
  if (!scene.fluid.particles) return;
  if (scene.fluid.cutoff <= scene.fluid.spacing)
    throw InputError(scene.file, "fluid.rcut", fmt::format("{}", scene.fluid.cutoff),
                     fmt::format("must exceed fluid.spacing = {}; 3 spacings are usual", scene.fluid.spacing));
  const double density = 1.0 / lattice.cell_volume();
  if (density > most_dense)
    throw InputError(scene.file, "fluid.rcut", fmt::format("{}", scene.fluid.cutoff),
                     fmt::format("makes {:.4g} PPs in a cube of rcut, more than {}; lower it to about 3 spacings",
                                 density, most_dense));
  if (nodes > 0x1p50)
    throw InputError(scene.file, "fluid.spacing", fmt::format("{}", scene.fluid.spacing),
                     "makes more PPs than can be numbered; enlarge it");
}

namespace {

/// `what`: the solid, or more, that is `width` wide.
void check_width(const Scene& scene, const BodyScene& body, const char* what, double width, double side) {
  if (width > side)
    throw InputError(scene.file, body.key, "",
                     fmt::format("{} is {:.6g} wide, more than the box side {}; make it smaller or enlarge box.size",
                                 what, width, side));
}

}  // namespace

template <int D>
void check_balls(const Scene& scene) {
  for (const BodyScene& body : scene.bodies)
    for (const BallScene& ball : body.balls)
      for (std::size_t axis = 0; axis < D; ++axis) {
        const double radius = std::max(ball.radius, ball.contact_radius);
        check_width(scene, body, "the solid", 2.0 * radius, scene.box[axis]);
        check_width(scene, body, "the solid with the origin of its frame", std::fabs(ball.centre[axis]) + radius,
                    scene.box[axis]);
      }
}

template <int D>
void check_solids(const Scene& scene, const Model<D>& model) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const BodyScene& body = scene.bodies[i];
    if (is_wall(body)) {
      if (scene.fluid.particles && body.thickness < scene.fluid.cutoff)
        throw InputError(
            scene.file, body.key + ".thickness", fmt::format("{}", body.thickness),
            fmt::format("the fluid sees through a wall thinner than rcut = {}; make it thicker", scene.fluid.cutoff));
      continue;
    }
    if (model.shapes[i].mass > heaviest_solid)
      throw InputError(scene.file, body.key + ".density", fmt::format("{}", body.density),
                       fmt::format("a solid has the mass of {:.3g} PPs, more than {:.3g}; lower it or enlarge "
                                   "fluid.spacing",
                                   model.shapes[i].mass, heaviest_solid));
    const double width = 2.0 * model.shapes[i].reach * scene.fluid.cutoff;
    for (std::size_t axis = 0; axis < D; ++axis) check_width(scene, body, "the solid", width, scene.box[axis]);
  }
  check_overlaps(scene);
}

/// Without fluid the sound speed is but a unit.
template <int D>
void check_velocities(const Scene& scene, const Model<D>& model) {
  if (!scene.fluid.particles) return;
  const double sound_speed = model.units.velocity;
  double speed = largest_declared_speed(scene);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    for (std::size_t n = 0; n < scene.bodies[i].angular_velocities.size(); ++n)
      speed = std::max(speed, norm(scene.bodies[i].velocities[n]) + norm(scene.bodies[i].angular_velocities[n]) *
                                                                        model.shapes[i].reach * scene.fluid.cutoff);
  if (speed >= sound_speed)
    throw InputError(scene.file, "fluid.sound_speed", fmt::format("{:.6g}", sound_speed),
                     fmt::format("is not above the largest declared speed {:.6g}; ten times that is usual", speed));
}

void check_step(const Scene& scene, double step, const StepLimits& limits) {
  if (!std::isfinite(step))
    throw InputError(scene.file, "run.step", "", "missing: nothing in this scene limits the step; give it");
  const StepLimit last = limits.first(&StepLimit::last);
  if (step > last.last)
    throw InputError(scene.file, step_key(scene), fmt::format("{}", declared_step(scene)),
                     fmt::format("the step {:.6g} is longer than {:.6g}, the last that {} allows; {}", step, last.last,
                                 last.of, lower_step(scene, limits.first(&StepLimit::doubtful).doubtful, limits)));
}

template <int D>
std::vector<std::string> scene_warnings(const Scene& scene, const Model<D>& model, const Lattice<D>& lattice,
                                        const StepLimits& limits) {
  std::vector<std::string> lines;
  const double step = model.dt * model.units.time();
  const StepLimit doubtful = limits.first(&StepLimit::doubtful);
  if (step > (1.0 + 1e-9) * doubtful.doubtful)
    lines.push_back(
        fmt::format("{} = {}: the step {:.6g} is near {:.6g}, the last that {} allows: results may be wrong "
                    "without any sign; {}",
                    step_key(scene), declared_step(scene), step, doubtful.last, doubtful.of,
                    lower_step(scene, doubtful.doubtful, limits)));
  const bool meeting = std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                     [](const BodyScene& body) { return body.motion == Motion::free; }) > 0 &&
                       (scene.bodies.size() > 1 || scene.bodies[0].positions.size() > 1);
  if (meeting && !model.terms.contact && !scene.contact.declared)
    lines.push_back("[contact] is missing: solids that meet pass through each other; model = \"none\" says so");
  if (!model.terms.fluid) return lines;

  const double support = 1.0 / model.spacing;
  if (support < least_support || support > most_support)
    lines.push_back(fmt::format("fluid.rcut: {:.3g} spacings; errors are known for {} to {}", support, least_support,
                                most_support));
  // A stream in which nothing stands is a matter of the frame.
  const double stream = scene.bodies.empty() ? norm(scene.fluid.velocity) : 0.0;
  const double speed = std::max(largest_declared_speed(scene) - stream, scene.fluid.sound_speed.velocity);
  if (speed > largest_mach * model.units.velocity)
    lines.push_back(
        fmt::format("fluid.sound_speed: {:.6g} is less than ten times the speed {:.6g}: the fluid is "
                    "compressible",
                    model.units.velocity, speed));
  if (scene.fluid.background_pressure > 0.0)
    lines.push_back(fmt::format("fluid.background_pressure = {}: stiffens the particle lattice; drags are too large",
                                scene.fluid.background_pressure));
  for (const BodyScene& body : scene.bodies) {
    for (const BallScene& ball : body.balls)
      if (ball.radius < least_radius * scene.fluid.spacing)
        lines.push_back(fmt::format("{}.radius: {:.3g} spacings; below {} the drag is wrong by 6 % and more", body.key,
                                    ball.radius / scene.fluid.spacing, least_radius));
    const double cell = lattice.spacing[body.axis] * scene.fluid.cutoff;
    if (is_wall(body) && !fits_lattice(scene, body))
      lines.push_back(
          fmt::format("{}: position and thickness are not whole multiples of the lattice spacing {:.6g}: "
                      "the fluid starts with an uneven row",
                      body.key, cell));
  }
  return lines;
}

template void check_margin(const Scene&, const Model<2>&);
template void check_margin(const Scene&, const Model<3>&);
template void check_velocities(const Scene&, const Model<2>&);
template void check_velocities(const Scene&, const Model<3>&);
template void check_box(const Scene&, const Lattice<2>&);
template void check_box(const Scene&, const Lattice<3>&);
template void check_balls<2>(const Scene&);
template void check_balls<3>(const Scene&);
template void check_solids(const Scene&, const Model<2>&);
template void check_solids(const Scene&, const Model<3>&);
template std::vector<std::string> scene_warnings(const Scene&, const Model<2>&, const Lattice<2>&, const StepLimits&);
template std::vector<std::string> scene_warnings(const Scene&, const Model<3>&, const Lattice<3>&, const StepLimits&);

}  // namespace mappm
