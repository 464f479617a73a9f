#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "physics/stability.hpp"
#include "physics/step_limit.hpp"
#include "scene/build.hpp"
#include "scene/carving.hpp"
#include "scene/lattice.hpp"
#include "scene/model_checks.hpp"
#include "scene/solids.hpp"

namespace mappm {

namespace {

double norm(const Triple& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/// Geometry and mass, which do not depend on the sound speed.
template <int D>
Model<D> start_model(const Scene& scene, const Lattice<D>& lattice) {
  Model<D> model;
  double node_volume = 1.0;
  for (int axis = 0; axis < D; ++axis) {
    const double side = scene.box[static_cast<std::size_t>(axis)];
    model.box[axis] = side / scene.fluid.cutoff;
    model.pair.length[axis] = model.box[axis] / box_quanta;
    node_volume *= side / static_cast<double>(lattice.count[axis]);
  }
  model.units.length = scene.fluid.cutoff;
  model.units.mass = scene.fluid.density * node_volume;
  model.kernel = scene.fluid.kernel;
  model.rest_density = 1.0 / lattice.cell_volume();
  model.spacing = scene.fluid.spacing / scene.fluid.cutoff;
  model.no_slip_nearest = 0.25 * model.spacing;
  model.relax = scene.run.relax;
  return model;
}

/// What the scene holds of matter, PP masses.
struct Matter {
  std::uint64_t fluid_particles = 0;
  double free_mass = 0.0;
  double lightest = HUGE_VAL;    // free solid, of a composite the share of one ball: all may touch at once
  double lightest_radius = 0.0;  // for contact, rcut
  std::size_t free_solids = 0, ball_solids = 0;
};

template <int D>
Matter count_matter(const Scene& scene, const Model<D>& model, const Lattice<D>& lattice) {
  const std::vector<PlacedSolid<D>> solids = place_solids(scene, model, lattice);
  Matter matter;
  if (scene.fluid.particles) matter.fluid_particles = kept_nodes(lattice, solid_volume(scene, model, solids));
  for (const PlacedSolid<D>& solid : solids) {
    const BodyScene& body = scene.bodies[solid.body];
    if (is_wall(body)) continue;
    ++matter.ball_solids;
    if (body.motion != Motion::free) continue;
    ++matter.free_solids;
    const Shape<D>& shape = model.shapes[solid.shape];
    matter.free_mass += shape.mass;
    const double share = shape.mass / static_cast<double>(shape.balls.size());
    if (share >= matter.lightest) continue;
    matter.lightest = share;
    matter.lightest_radius = shape.balls[0].contact_radius;
  }
  if (scene.fluid.particles && matter.fluid_particles == 0)
    throw InputError(scene.file, "body", "", "the solids fill the box; make them smaller or enlarge box.size");
  return matter;
}

template <int D>
Terms find_terms(const Scene& scene, const Matter& matter) {
  Terms terms;
  terms.fluid = scene.fluid.particles;
  terms.solids = terms.fluid ? !scene.bodies.empty() : matter.ball_solids > 0;
  terms.transport = terms.fluid && scene.fluid.transport;
  terms.extrapolated = terms.fluid && terms.solids && scene.fluid.no_slip == NoSlip::extrapolated;
  terms.single = terms.fluid && scene.fluid.precision == Precision::single;
  terms.body_force = norm(scene.force.fluid) > 0.0 || norm(scene.force.solid) > 0.0;
  terms.force_field = terms.fluid && scene.force.field.has_value();
  bool walls = false;
  for (const BodyScene& body : scene.bodies) {
    terms.motion = terms.motion || body.motion != Motion::fixed;
    terms.rotation = terms.rotation || (body.motion == Motion::free && body.rotates);
    walls = walls || is_wall(body);
  }
  terms.contact =
      scene.contact.model != ContactModel::none && matter.free_solids > 0 && (matter.ball_solids > 1 || walls);
  return terms;
}

/// The largest acceleration of a PP, m/s^2.
double largest_acceleration(const ForceScene& force) {
  return norm(force.fluid) + (force.field ? largest_flow(*force.field) : 0.0);
}

/// Acceleration of the free solids in scene units; under "balance" the one that cancels the force on the fluid.
Triple solid_acceleration(const Scene& scene, const Matter& matter) {
  if (!scene.force.balance) return scene.force.solid;
  if (matter.free_solids == 0 || matter.fluid_particles == 0)
    throw InputError(scene.file, "force.solid", "\"balance\"",
                     "needs a fluid and a free solid; write a list of accelerations");
  Triple balanced{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    balanced[axis] = -scene.force.fluid[axis] * static_cast<double>(matter.fluid_particles) / matter.free_mass;
  return balanced;
}

/// By number, or by the rule of physics/step_limit: R is the smallest ball's radius, L the largest ball's diameter or,
/// without balls, the longest side of the box, g the body force per mass of fluid, on the fluid or on the solids.
double sound_speed(const Scene& scene, const Matter& matter, const Triple& on_solids) {
  const SoundSpeed& declared = scene.fluid.sound_speed;
  if (declared.value) return *declared.value;
  double smallest = 0.0;
  double length = 0.0;
  for (const BodyScene& body : scene.bodies)
    for (const BallScene& ball : body.balls) {
      smallest = smallest > 0.0 ? std::min(smallest, ball.radius) : ball.radius;
      length = std::max(length, 2.0 * ball.radius);
    }
  if (length == 0.0) length = *std::max_element(scene.box.begin(), scene.box.end());
  double g = largest_acceleration(scene.force);
  if (matter.fluid_particles > 0)
    g = std::max(g, norm(on_solids) * matter.free_mass / static_cast<double>(matter.fluid_particles));
  const double nu = scene.fluid.viscosity / scene.fluid.density;
  const double speed = sound_speed_rule(declared.factor, declared.velocity, g, length, nu, smallest);
  if (speed > 0.0) return speed;
  throw InputError(scene.file, "fluid.reference_velocity", "0",
                   "gives no sound speed in a scene without forces; give the largest speed expected");
}

template <int D>
ContactLaw make_contact(const Scene& scene, const UnitScale& units) {
  const ContactScene& contact = scene.contact;
  const double stiffness_unit = units.force() / units.length;
  const double pressure_unit = units.force() / (units.length * units.length);
  return make_contact_law(contact.model == ContactModel::hertz ? ContactKind::hertz : ContactKind::linear,
                          contact.stiffness / stiffness_unit, contact.young / pressure_unit, contact.poisson,
                          contact.restitution, contact.friction);
}

double surface_of(const Ball<2>& ball) { return 2.0 * std::numbers::pi * ball.radius; }
double surface_of(const Ball<3>& ball) { return 4.0 * std::numbers::pi * ball.radius * ball.radius; }

/// At least 1 / I of the axis about which a body turns most easily: the largest sum of a row.
template <int D>
double largest_inverse_inertia(const Shape<D>& shape) {
  constexpr int n = angular_components<D>;
  double largest = 0.0;
  for (int row = 0; row < n; ++row) {
    double sum = 0.0;
    for (int column = 0; column < n; ++column) sum += std::fabs(shape.inverse_inertia[n * row + column]);
    largest = std::max(largest, sum);
  }
  return largest;
}

/// Of the free body that limits most, in scene units. viscosity: nu / (c h).
template <int D>
StepLimit light_limit(const Scene& scene, const Model<D>& model, double viscosity) {
  constexpr double h = 0.5;
  StepLimit shortest{"added mass"};
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].motion != Motion::free) continue;
    const Shape<D>& shape = model.shapes[i];
    DraggedBody body{D, shape.mass};
    double radius = 0.0;
    for (const Ball<D>& ball : shape.balls) {
      body.surface += surface_of(ball);
      radius = std::max(radius, std::sqrt(dot(ball.offset, ball.offset)) + ball.radius);
    }
    if (shape.rotates) body.slowness = 1.0 / (largest_inverse_inertia(shape) * radius * radius);
    const StepLimit limit = light_solid_limit(body, h, 1.0, viscosity * h * model.rest_density, model.rest_density);
    if (limit.last < shortest.last) shortest = limit;
  }
  const double time = model.units.time();
  return {shortest.of, shortest.usual * time, shortest.doubtful * time, shortest.last * time};
}

/// How many walls a PP may touch at once: one, also of balls, or more where walls lie across several axes.
int meeting_walls(const Scene& scene) {
  std::array<bool, 3> across{};
  for (const BodyScene& body : scene.bodies)
    if (is_wall(body)) across[static_cast<std::size_t>(body.axis)] = true;
  return std::max(1, static_cast<int>(std::ranges::count(across, true)));
}

/// Limits in scene units. A contact lasts at least as long as that of two of the lightest solids; under Hertz' law at
/// the largest speed that the scene declares, or at a tenth of the sound speed if it declares none.
template <int D>
StepLimits find_limits(const Scene& scene, const Model<D>& model, const Matter& matter, const Triple& on_solids) {
  double duration = 0.0;
  if (model.terms.contact) {
    const double declared =
        std::max(2.0 * largest_declared_speed(scene), scene.fluid.sound_speed.velocity) / model.units.velocity;
    duration = contact_duration(model.contact, 0.5 * matter.lightest, 0.5 * matter.lightest_radius,
                                declared > 0.0 ? declared : 0.1) *
               model.units.time();
  }
  const double g = std::max(largest_acceleration(scene.force), norm(on_solids));
  const double h = 0.5 * scene.fluid.cutoff;
  StepLimits limits;
  limits.force = force_limit(h, g);
  limits.contact = contact_limit(duration);
  if (!model.terms.fluid) return limits;
  const double reach = 1.0 / model.spacing, shift_rate = model.terms.transport ? scene.fluid.shift_rate : 0.0;
  const double at_walls = model.terms.solids
                              ? wall_friction<D>(model.kernel, reach, scene.fluid.largest_no_slip, meeting_walls(scene))
                              : 1.0;
  const double viscosity = scene.fluid.viscosity / scene.fluid.density / (model.units.velocity * h);
  limits.waves =
      wave_limit(h, model.units.velocity, first_instability<D>(model.kernel, reach, at_walls * viscosity, shift_rate),
                 first_instability<D>(model.kernel, reach, 0.0, shift_rate));
  limits.light_solids = light_limit(scene, model, viscosity);
  return limits;
}

/// a, as the scene gives it. By default it is 5000 nu / (c h), for what the shift stirs up at a wall is damped by
/// viscosity, but at most 160. With more a column of fluid does not come to rest.
template <int D>
double shift_shear(const Scene& scene, const Model<D>& model) {
  if (scene.fluid.shift_shear) return *scene.fluid.shift_shear;
  const double h = 0.5 * scene.fluid.cutoff;
  const double viscosity = scene.fluid.viscosity / scene.fluid.density / (model.units.velocity * h);
  return std::min(160.0, 5000.0 * viscosity);
}

/// Constants of the pair law; they carry the step. shift: u dt with u = kappa c h (V_i^2 + V_j^2) / (2 V_0) G r, of
/// which the law has G dt / iota already.
template <int D>
void fold_pair_law(const Scene& scene, const Lattice<D>& lattice, Model<D>& model) {
  double spacing[D];
  for (int axis = 0; axis < D; ++axis) spacing[axis] = lattice.spacing[axis];
  double outer_moment = 0.0;
  with_pair_law(model, [&](auto kernel, auto) {
    using Kernel = decltype(kernel);
    const KernelScale scale = normalise<D, Kernel>(spacing);
    model.pair.force = scale.gradient * model.dt / velocity_quantum;
    model.pair.weight = scale.weight / density_quantum;
    model.self_density = round_to_quantum(Kernel::self_weight * scale.weight, density_quantum);
    outer_moment = scale.outer_moment;
  });
  constexpr double h = 0.5;
  const double doubled_volume = 2.0 / model.rest_density;
  for (int axis = 0; axis < D; ++axis)
    model.pair.shift[axis] = scene.fluid.shift_rate * h / doubled_volume * velocity_quantum / model.pair.length[axis];
  const double of_rate = shift_shear(scene, model) * h;
  model.shift_shear = of_rate * of_rate * velocity_quantum / (D * outer_moment * doubled_volume * model.dt);
  model.shift_outer = 1.0 / outer_moment;
  model.no_slip_largest = scene.fluid.largest_no_slip;
  const UnitScale& units = model.units;
  model.pair.viscosity =
      scene.fluid.viscosity / scene.fluid.density * model.rest_density / (units.length * units.velocity);
  model.background = scene.fluid.background_pressure * model.rest_density;
}

/// The background pressure holds a lattice together by impulses that cancel, so that sums do not show when one of them
/// leaves the range of a contribution, 8 m c (base/fixed_point.hpp). At rest it may give 1 m c: compression and
/// expansion change that.
template <int D>
void check_background(const Scene& scene, const Model<D>& model) {
  constexpr double largest = 1.0;  // m c
  constexpr int points = 256;
  double gradient = 0.0;
  with_pair_law(model, [&](auto kernel, auto) {
    using Kernel = decltype(kernel);
    for (int k = 1; k <= points; ++k) {
      const double q = static_cast<double>(k) / points;
      gradient = std::max(gradient, q * Kernel::gradient(q));
    }
  });
  const double volume = 1.0 / model.rest_density;
  const double impulse = 2.0 * model.background * volume * volume * gradient * model.pair.force * velocity_quantum;
  if (impulse > largest)
    throw InputError(
        scene.file, "fluid.background_pressure", fmt::format("{}", scene.fluid.background_pressure),
        fmt::format("gives two PPs up to {:.3g} m c in one step, and the range of numbers allows {:g}; lower "
                    "it or the step",
                    impulse, largest));
}

template <int D>
void fold_forces(const Scene& scene, const Matter& matter, Model<D>& model) {
  const double unit = model.units.velocity / model.units.time();
  for (int axis = 0; axis < D; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    model.fluid_kick[axis] = round_to_quantum(scene.force.fluid[a] / unit * model.dt, velocity_quantum);
    model.solid_acceleration[axis] =
        scene.force.balance
            ? -model.fluid_kick[axis] / model.dt * static_cast<double>(matter.fluid_particles) / matter.free_mass
            : scene.force.solid[a] / unit;
  }
  if (!model.terms.force_field) return;
  model.fluid_field = *scene.force.field;
  model.fluid_field.amplitude *= model.dt / unit;
  if (const double gained = largest_flow(model.fluid_field); gained > 1.0)
    throw InputError(scene.file, "force", "",
                     fmt::format("its field gives the fluid {:.3g} times the sound speed in one step; lower the "
                                 "amplitude or run.step",
                                 gained));
}

}  // namespace

template <int D>
BuiltModel<D> make_model(const Scene& scene) {
  const Lattice<D> lattice = make_lattice<D>(scene);
  check_box(scene, lattice);
  check_balls<D>(scene);
  Model<D> model = start_model(scene, lattice);
  model.shapes = make_shapes(scene, model, lattice);
  check_solids(scene, model);
  const Matter matter = count_matter(scene, model, lattice);
  model.terms = find_terms<D>(scene, matter);
  const Triple on_solids = solid_acceleration(scene, matter);
  model.units.velocity = sound_speed(scene, matter, on_solids);
  check_velocities(scene, model);
  model.faces = wall_faces(scene, model);
  if (model.terms.contact) model.contact = make_contact<D>(scene, model.units);
  for (const Shape<D>& shape : model.shapes) {
    model.largest_reach = std::max(model.largest_reach, shape.reach);
    if (model.terms.contact && !shape.balls.empty())
      model.largest_contact_reach = std::max(model.largest_contact_reach, shape.reach);
  }
  check_margin(scene, model);
  const StepLimits limits = find_limits(scene, model, matter, on_solids);
  const double step = scene.run.step > 0.0 ? scene.run.step : scene.run.step_factor * limits.ruling().usual;
  check_step(scene, step, limits);
  model.dt = step / model.units.time();
  if (model.terms.fluid) {
    fold_pair_law(scene, lattice, model);
    check_background(scene, model);
  }
  fold_forces(scene, matter, model);
  BuiltModel<D> built{model, matter.fluid_particles, limits, {}};
  built.warnings = scene_warnings(scene, model, lattice, limits);
  return built;
}

template BuiltModel<2> make_model<2>(const Scene&);
template BuiltModel<3> make_model<3>(const Scene&);

}  // namespace mappm
