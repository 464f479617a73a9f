// Any bytes as a scene: the reader, the model and the particles of a small scene. Only InputError may come out, and the
// text that is kept in checkpoints must read as the same scene. Lines "#set KEY=VALUE" act as overrides.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "require.hpp"
#include "scene/build.hpp"
#include "scene/document.hpp"
#include "scene/reader.hpp"

namespace mappm {

namespace {

// A scene may be large and legal; what takes long to build is not built.
constexpr double most_solids = 200.0;
constexpr double most_nodes_plane = 20'000.0, most_nodes_space = 4'000.0;
constexpr const char* name = "fuzz.toml";

std::vector<std::string> overrides_in(const std::string& text) {
  constexpr const char* mark = "#set ";
  std::vector<std::string> overrides;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(mark)) overrides.push_back(line.substr(std::char_traits<char>::length(mark)));
  return overrides;
}

double largest_number(const toml::node& node) {
  double largest = 0.0;
  if (const toml::array* array = node.as_array())
    for (const toml::node& entry : *array) largest = std::max(largest, largest_number(entry));
  if (const auto value = node.value<double>()) largest = std::fabs(*value);
  return largest;
}

/// Whether a key "count" anywhere below asks for many solids.
bool asks_for_many(const toml::node& node) {
  if (const toml::array* array = node.as_array())
    for (const toml::node& entry : *array)
      if (asks_for_many(entry)) return true;
  if (const toml::table* table = node.as_table())
    for (const auto& [key, value] : *table)
      if (asks_for_many(value) || (key.str() == "count" && largest_number(value) > most_solids)) return true;
  return false;
}

bool is_small(const Scene& scene) {
  double nodes = 1.0;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(scene.dimension); ++axis)
    nodes *= std::max(1.0, scene.box[axis] / scene.fluid.spacing);
  return nodes <= (scene.dimension == 2 ? most_nodes_plane : most_nodes_space);
}

template <int D>
void build(const Scene& scene) {
  const BuiltModel<D> built = make_model<D>(scene);
  const State<D> state = build_state<D>(scene, built.model, Region<D>::whole_box());
  require(state.fluid.size() == built.fluid_particles, "as many PPs are built as were counted");
}

void read(const std::string& text) {
  const std::vector<std::string> overrides = overrides_in(text);
  if (asks_for_many(parse_document(text, name, overrides))) return;
  const Scene scene = read_scene_text(text, name, overrides);
  std::string again;
  try {
    again = read_scene_text(scene.text, name, {}).text;
  } catch (const InputError& error) {
    require(false, error.what());
  }
  require(again == scene.text, "the text kept of a scene reads as the same scene");
  if (!is_small(scene)) return;
  if (scene.dimension == 2)
    build<2>(scene);
  else
    build<3>(scene);
}

}  // namespace

}  // namespace mappm

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  try {
    mappm::read(std::string(bytes, bytes + size));
  } catch (const mappm::InputError&) {  // every other exception is a finding
  }
  return 0;
}
