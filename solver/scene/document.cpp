#include "scene/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <numeric>
#include <sstream>

#include "base/error.hpp"

namespace mappm {

namespace {

/// Keys of which a scene gives one: an override of either replaces the other.
constexpr const char* alternatives[][2] = {
    {"fluid.sound_speed", "fluid.sound_speed_factor"},
    {"run.step", "run.step_factor"},
    {"run.steps", "run.duration"},
};

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> parts;
  std::istringstream stream(path);
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  return parts;
}

[[noreturn]] void fail(const std::string& key, const std::string& value, const std::string& fix) {
  throw InputError("--set", key, value, fix);
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

toml::table parse_value(const std::string& value) {
  try {
    toml::table parsed = toml::parse("value = " + value);
    if (parsed.size() == 1) return parsed;
  } catch (const toml::parse_error&) {  // a bare word
  }
  return toml::table{{"value", value}};
}

toml::node& child(toml::node& parent, const std::string& part, const std::string& path, const std::string& value) {
  if (toml::table* table = parent.as_table()) {
    if (!table->contains(part)) table->insert(part, toml::table{});
    return *table->get(part);
  }
  toml::array* array = parent.as_array();
  if (!array) fail(path, value, fmt::format("\"{}\" stands below a value, not a table; check the path", part));
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error != std::errc{} || end != part.data() + part.size() || index >= array->size())
    fail(path, value, fmt::format("\"{}\" is no entry of a list of {}; entries count from 0", part, array->size()));
  return *array->get(index);
}

void set_value(toml::node& parent, const std::string& part, const std::string& path, const std::string& value) {
  const toml::table parsed = parse_value(value);
  if (toml::table* table = parent.as_table()) {
    parsed.get("value")->visit([&](const auto& node) { table->insert_or_assign(part, node); });
    return;
  }
  child(parent, part, path, value);  // checks the index
  toml::array& array = *parent.as_array();
  const auto element = array.cbegin() + static_cast<std::ptrdiff_t>(std::stoul(part));
  parsed.get("value")->visit([&](const auto& node) { array.replace(element, node); });
}

void erase(toml::table& tree, const std::string& path) {
  const std::vector<std::string> parts = split(path);
  if (toml::table* table = tree[parts[0]].as_table()) table->erase(parts[1]);
}

void apply_override(toml::table& tree, const std::string& text) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos || sign == 0) fail(text, "", "is no override; write --set key.path=value");
  const std::string path = trimmed(text.substr(0, sign));
  const std::string value = trimmed(text.substr(sign + 1));
  const std::vector<std::string> parts = split(path);
  if (parts.empty() || std::count(parts.begin(), parts.end(), "") > 0)
    fail(text, "", "has an empty key; write --set key.path=value");
  toml::node* parent = &tree;
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) parent = &child(*parent, parts[i], path, value);
  set_value(*parent, parts.back(), path, value);
  for (const auto& [one, other] : alternatives) {
    if (path == one) erase(tree, other);
    if (path == other) erase(tree, one);
  }
}

/// Levenshtein's distance.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row[b.size()];
}

}  // namespace

toml::table parse_document(const std::string& text, const std::string& file,
                           const std::vector<std::string>& overrides) {
  toml::table tree;
  try {
    tree = toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}", file, error.source().begin.line), "TOML", "",
                     fmt::format("{}; mend the line", error.description()));
  }
  for (const std::string& override_text : overrides) apply_override(tree, override_text);
  return tree;
}

std::string canonical_text(const toml::table& tree) {
  toml::table scene = tree;
  scene.erase("case");
  std::ostringstream text;
  text << scene << "\n";
  return text.str();
}

std::string node_text(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) {
    const std::string text = fmt::format("{}", number->get());
    return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
  }
  if (const toml::array* array = node.as_array()) {
    std::string entries;
    for (const toml::node& entry : *array) entries += (entries.empty() ? "" : ", ") + node_text(entry);
    return "[" + entries + "]";
  }
  std::ostringstream text;
  node.visit([&](const auto& value) { text << value; });
  return text.str();
}

std::string nearest_name(const std::string& word, const std::vector<std::string>& known) {
  std::string nearest;
  std::size_t smallest = std::max<std::size_t>(2, word.size() / 3);
  for (const std::string& name : known) {
    const std::size_t distance = edit_distance(word, name);
    if (distance > smallest || (distance == smallest && !nearest.empty())) continue;
    smallest = distance;
    nearest = name;
  }
  return nearest;
}

}  // namespace mappm
