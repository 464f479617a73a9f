#include "output/run_record.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/numerics_version.hpp"
#include "build_info.hpp"
#include "output/durable_file.hpp"

namespace mappm {

namespace {

std::string host_name() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "unknown";
  return name.data();
}

/// 128-bit integers do not fit a JSON number.
nlohmann::ordered_json decimal_strings(const std::vector<Int128>& values) {
  auto strings = nlohmann::ordered_json::array();
  for (const Int128 value : values) strings.push_back(fmt::format("{}", value));
  return strings;
}

/// The limits that there are, in scene units, and the one that rules; what does not limit is left out.
nlohmann::ordered_json step_limits(const StepLimits& limits) {
  auto json = nlohmann::ordered_json::object();
  if (std::isfinite(limits.ruling().usual)) json["ruling"] = limits.ruling().of;
  for (const StepLimit& limit : limits.all())
    if (std::isfinite(limit.usual))
      json[std::string(limit.of)] = {{"usual", limit.usual}, {"doubtful", limit.doubtful}, {"last", limit.last}};
  return json;
}

}  // namespace

std::vector<std::string> term_names(const Terms& terms) {
  std::vector<std::string> names;
  const auto add = [&](bool active, const char* name) {
    if (active) names.emplace_back(name);
  };
  add(terms.fluid, "fluid");
  add(terms.transport, "transport velocity");
  add(terms.extrapolated, "extrapolated no-slip");
  add(terms.body_force, "body force");
  add(terms.force_field, "field of force");
  add(terms.solids, "solids");
  add(terms.motion, "motion of solids");
  add(terms.rotation, "rotation of solids");
  add(terms.contact, "contact");
  add(terms.single, "single precision of pairs");
  return names;
}

std::string run_record_text(const RunRecord& record) {
  nlohmann::ordered_json json;
  json["program"] = record.program;
  json["version"] = build_info::version;
  json["numerics_version"] = numerics_version;
  json["commit"] = build_info::commit;
  json["compiler"] = build_info::compiler;
  json["flags"] = build_info::flags;
  json["instruction_set"] = record.instruction_set;
  json["host"] = host_name();
  json["date"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  json["scene"] = {{"file", record.scene_file},
                   {"name", record.scene_name},
                   {"text", record.scene_text},
                   {"identity", record.scene_identity}};
  json["terms"] = term_names(record.terms);
  json["warnings"] = record.warnings;
  json["first_step"] = record.first_step;
  json["steps"] = record.step;
  json["time_step"] = record.time_step;
  json["step_limits"] = step_limits(record.limits);
  json["wall_seconds"] = nlohmann::ordered_json::object();
  for (const auto& [phase, seconds] : record.wall_seconds) json["wall_seconds"][phase] = seconds;
  json["exchange"] = {{"neighbours", record.neighbours},
                      {"messages_per_step", record.messages_per_step},
                      {"bytes_per_step", record.bytes_per_step}};
  json["orderings"] = record.orderings;
  json["digest"] = record.digest;
  json["momentum"] = {{"start", decimal_strings(record.start_momentum)},
                      {"end", decimal_strings(record.end_momentum)},
                      {"impulse", decimal_strings(record.outside_impulse)},
                      {"iota", record.iota}};
  json["ranks"] = record.ranks;
  json["domains"] = record.domains;
  json["borders"] = record.borders;
  json["threads"] = record.threads;
  json["particles"] = record.particles;
  json["frozen_particles"] = record.frozen_particles;
  json["solids"] = record.solids;
  json["particle_steps_per_second"] = record.rate;
  json["state"] = record.state;
  if (!record.message.empty()) json["message"] = record.message;
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string recorded_identity(const std::filesystem::path& path) {
  std::ifstream file(path);
  const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
  const nlohmann::json::json_pointer identity("/scene/identity");
  const bool given = json.is_object() && json.contains(identity) && json[identity].is_string();
  return given ? json[identity].get<std::string>() : "";
}

void write_run_record(const std::filesystem::path& path, const RunRecord& record) {
  write_durably(path, run_record_text(record));
}

}  // namespace mappm
