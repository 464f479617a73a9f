#include "scene/reader.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.hpp"
#include "scene/bodies.hpp"
#include "scene/document.hpp"
#include "scene/fields.hpp"
#include "scene/velocity_field.hpp"

namespace mappm {

namespace {

void read_box(const Fields& table, Source& source, Scene& scene) {
  const std::vector<double> sides = table.sides("size");
  scene.dimension = static_cast<int>(sides.size());
  source.dimension = scene.dimension;
  for (std::size_t axis = 0; axis < sides.size(); ++axis) scene.box[axis] = sides[axis];
  table.finish();
}

/// In space drags come out low at the usual resolutions, and lower yet with slower sound or a lower bound of beta.
SoundSpeed read_sound_speed(const Fields& table, int dimension) {
  SoundSpeed speed;
  if (table.has("sound_speed")) {
    speed.value = table.number("sound_speed", Quantity::velocity, Sign::positive);
    if (table.has("sound_speed_factor")) table.fail("sound_speed_factor", "sound_speed is given too; keep one of them");
  } else {
    speed.factor = table.number("sound_speed_factor", Quantity::plain, Sign::positive, dimension == 2 ? 10.0 : 15.0);
    if (!table.has("reference_velocity"))
      table.fail("sound_speed", "missing; give a number, or the rule by reference_velocity and sound_speed_factor");
  }
  speed.velocity = table.number("reference_velocity", Quantity::velocity, Sign::not_negative, 0.0);
  return speed;
}

std::optional<FluidScene::Disorder> read_disorder(const Fields& fluid) {
  const std::optional<Fields> table = fluid.table("disorder");
  if (!table) return {};
  FluidScene::Disorder disorder;
  disorder.amplitude = table->number("amplitude", Quantity::plain, Sign::not_negative);
  if (disorder.amplitude > largest_disorder)
    table->fail("amplitude", fmt::format("must lie in [0, {}]: lattice spacings", largest_disorder));
  disorder.seed = table->count("seed");
  table->finish();
  return disorder;
}

void read_fluid_law(const Fields& table, int dimension, FluidScene& fluid) {
  fluid.method =
      table.choice<Method>("method", {{"classic", Method::classic}, {"transport", Method::transport}}, fluid.method);
  const bool classic = fluid.method == Method::classic;
  fluid.kernel = table.choice<KernelKind>(
      "kernel", {{"wendland-c2", KernelKind::wendland_c2}, {"lucy", KernelKind::lucy}, {"mps", KernelKind::mps}},
      fluid.kernel);
  fluid.no_slip = table.choice<NoSlip>("no_slip", {{"plain", NoSlip::plain}, {"extrapolated", NoSlip::extrapolated}},
                                       classic ? NoSlip::plain : NoSlip::extrapolated);
  fluid.transport = table.flag("transport", !classic);
  fluid.background_pressure = table.number("background_pressure", Quantity::plain, Sign::not_negative, 0.0);
  fluid.shift_rate = table.number("shift_rate", Quantity::plain, Sign::positive, fluid.shift_rate);
  if (table.has("shift_shear")) fluid.shift_shear = table.number("shift_shear", Quantity::plain, Sign::positive);
  for (const char* key : {"shift_rate", "shift_shear"})
    if (!fluid.transport && table.has(key)) table.fail(key, "acts with transport = true only; remove it");
  if (fluid.no_slip == NoSlip::extrapolated) {
    fluid.largest_no_slip =
        table.number("largest_no_slip", Quantity::plain, Sign::positive, dimension == 2 ? 4.0 : 8.0);
    if (fluid.largest_no_slip < 1.0) table.fail("largest_no_slip", "must be at least 1, the factor of a plain wall");
  } else if (table.has("largest_no_slip")) {
    table.fail("largest_no_slip", "acts with no_slip = \"extrapolated\" only; remove it");
  }
  fluid.precision = table.choice<Precision>("precision", {{"double", Precision::full}, {"single", Precision::single}},
                                            fluid.precision);
}

void read_fluid(const Fields& table, const Triple& box, int dimension, FluidScene& fluid) {
  fluid.particles = table.flag("particles", true);
  fluid.density = table.number("density", Quantity::density, Sign::positive);
  fluid.spacing = table.number("spacing", Quantity::length, Sign::positive);
  fluid.cutoff = table.number("rcut", Quantity::length, Sign::positive, 3.0 * fluid.spacing);
  fluid.sound_speed = read_sound_speed(table, dimension);
  if (fluid.particles) {
    fluid.viscosity = table.number("viscosity", Quantity::viscosity, Sign::not_negative);
    read_fluid_law(table, dimension, fluid);
    fluid.velocity = table.vector("velocity", Quantity::velocity, {});
    fluid.flow = read_flow(table, Quantity::velocity, box);
    fluid.disorder = read_disorder(table);
  }
  table.finish();
}

ContactScene read_contact(const Fields& table) {
  ContactScene contact;
  contact.declared = true;
  contact.model = table.choice<ContactModel>(
      "model", {{"none", ContactModel::none}, {"linear", ContactModel::linear}, {"hertz", ContactModel::hertz}});
  if (contact.model == ContactModel::linear)
    contact.stiffness = table.number("stiffness", Quantity::stiffness, Sign::positive);
  if (contact.model == ContactModel::hertz) {
    contact.young = table.number("young", Quantity::pressure, Sign::positive);
    contact.poisson = table.number("poisson", Quantity::plain, Sign::not_negative);
    if (contact.poisson > 0.5) table.fail("poisson", "must lie in [0, 0.5]");
  }
  if (contact.model != ContactModel::none) {
    contact.restitution = table.number("restitution", Quantity::plain, Sign::positive, 1.0);
    if (contact.restitution > 1.0) table.fail("restitution", "must lie in (0, 1]");
    contact.friction = table.number("friction", Quantity::plain, Sign::not_negative, 0.0);
  }
  table.finish();
  return contact;
}

ForceScene read_force(const Fields& table, const Scene& scene) {
  ForceScene force;
  if (scene.fluid.particles) {
    force.fluid = table.vector("fluid", Quantity::acceleration, {});
    force.field = read_flow(table, Quantity::acceleration, scene.box);
    if (force.field && force.field->amplitude == 0.0) force.field.reset();
  }
  if (table.is_word("solid")) {
    if (table.word("solid") != "balance")
      table.fail("solid", "unknown choice; write \"balance\" or a list of accelerations, one per axis");
    if (force.field)
      table.fail("solid", "balances a uniform force only; write a list of accelerations or remove the field of force");
    force.balance = true;
  } else {
    force.solid = table.vector("solid", Quantity::acceleration, {});
  }
  table.finish();
  return force;
}

RunScene read_run(const Fields& table) {
  RunScene run;
  if (table.has("step") && table.has("step_factor")) table.fail("step_factor", "step is given too; keep one of them");
  if (table.has("steps") && table.has("duration")) table.fail("duration", "steps is given too; keep one of them");
  run.step = table.has("step") ? table.number("step", Quantity::time, Sign::positive) : 0.0;
  run.step_factor = table.number("step_factor", Quantity::plain, Sign::positive, 1.0);
  if (table.has("duration"))
    run.duration = table.number("duration", Quantity::time, Sign::positive);
  else
    run.steps = table.steps("steps");
  if (run.duration == 0.0 && run.steps == 0) table.fail("steps", "must be at least 1; write the number of steps");
  run.relax = table.steps("relax", 0);
  table.finish();
  return run;
}

OutputScene read_output(const Fields& table) {
  OutputScene output;
  output.sample = table.steps("sample", output.sample);
  if (output.sample == 0) table.fail("sample", "must be at least 1; write the steps between samples");
  output.snapshot = table.steps("snapshot", 0);
  output.checkpoint = table.steps("checkpoint", 0);
  output.solids = table.flag("solids", false);
  table.finish();
  return output;
}

/// See `Scene::identity`.
std::string identity_of(const Source& source) {
  std::string lines;
  for (const auto& [key, value] : source.values)
    if (!key.starts_with("output.") && key != "run.steps" && key != "run.duration") lines += key + " = " + value + "\n";
  return lines;
}

Scene read_tree(const toml::table& tree, const std::string& file) {
  Scene scene;
  scene.file = file;
  scene.text = canonical_text(tree);
  Source source{file, Units::dimensionless, 2};
  const Fields root(source, "", tree);
  scene.name = root.word("name");
  if (scene.name.empty() || scene.name.find('/') != std::string::npos || scene.name.starts_with('.'))
    root.fail("name", "names the output folder; write a plain name without '/'");
  scene.units = root.choice<Units>("units", {{"SI", Units::si}, {"dimensionless", Units::dimensionless}});
  source.units = scene.units;
  read_box(root.required_table("box"), source, scene);
  read_fluid(root.required_table("fluid"), scene.box, scene.dimension, scene.fluid);
  read_bodies(root.tables("body"), scene);
  if (const auto contact = root.table("contact")) scene.contact = read_contact(*contact);
  if (const auto force = root.table("force")) scene.force = read_force(*force, scene);
  scene.run = read_run(root.required_table("run"));
  if (const auto output = root.table("output")) scene.output = read_output(*output);
  root.has("case");  // for the verification suite, which checks it itself
  root.finish();
  scene.identity = identity_of(source);
  return scene;
}

}  // namespace

Scene read_scene_text(const std::string& text, const std::string& name, const std::vector<std::string>& overrides) {
  return read_tree(parse_document(text, name, overrides), name);
}

std::string scene_file_text(const std::string& path) {
  errno = 0;
  std::ifstream stream(path);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream || text.bad() || std::filesystem::is_directory(path))
    throw InputError(path, "scene", "", "cannot be read; check the path and its permissions");
  return text.str();
}

Scene read_scene(const std::string& path, const std::vector<std::string>& overrides) {
  return read_scene_text(scene_file_text(path), path, overrides);
}

}  // namespace mappm
