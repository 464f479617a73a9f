#include "scene/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/error.hpp"
#include "base/fixed_point.hpp"

namespace mappm {

namespace {

/// Beyond these, products of a few quantities leave the range of a double.
constexpr double largest_number = 1e30, smallest_number = 1e-30;

std::string joined(const std::vector<std::string>& names, const char* quote) {
  std::string text;
  for (const std::string& name : names) text += fmt::format("{}{}{}{}", text.empty() ? "" : ", ", quote, name, quote);
  return text;
}

/// The shortest text that reads back as the same number.
std::string value_text(double value) { return fmt::format("{}", value); }

std::string value_text(const Triple& value, int dimension) {
  std::string text;
  for (int axis = 0; axis < dimension; ++axis)
    text += (axis > 0 ? ", " : "") + value_text(value[static_cast<std::size_t>(axis)]);
  return "[" + text + "]";
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

Fields::Fields(const Source& source, std::string path, const toml::table& table)
    : source_(&source), path_(std::move(path)), table_(&table) {}

std::string Fields::path(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

const toml::node* Fields::find(const std::string& key) const {
  if (!contains(asked_, key)) asked_.push_back(key);
  return table_->get(key);
}

bool Fields::has(const std::string& key) const { return find(key) != nullptr; }

void Fields::fail(const std::string& key, const std::string& fix) const {
  const toml::node* node = table_->get(key);
  const auto line = node ? node->source().begin.line : table_->source().begin.line;
  throw InputError(line > 0 ? fmt::format("{}:{}", source_->file, line) : source_->file, path(key),
                   node && !node->is_table() ? node_text(*node) : "", fix);
}

void Fields::fail_unknown(const std::string& key) const {
  const std::string nearest = nearest_name(key, asked_);
  fail(key, fmt::format("unknown key; {}",
                        nearest.empty() ? "known here: " + joined(asked_, "") : "did you mean \"" + nearest + "\"?"));
}

void Fields::fail_choice(const std::string& key, const std::vector<std::string>& known) const {
  fail(key, "unknown choice; write one of " + joined(known, "\""));
}

const toml::node& Fields::require(const std::string& key) const {
  if (const toml::node* node = find(key)) return *node;
  for (const auto& [other, node] : *table_)  // a misspelt key explains a missing one
    if (const std::string name{other.str()}; !contains(asked_, name) && nearest_name(name, {key}) == key)
      fail_unknown(name);
  fail(key, "missing; add it");
}

void Fields::finish() const {
  for (const auto& [key, node] : *table_)
    if (const std::string name{key.str()}; !contains(asked_, name)) fail_unknown(name);
}

/// A number that is read as another than its digits say is more often a slip than meant.
std::int64_t Fields::integer_of(const toml::value<std::int64_t>& integer, const std::string& key) const {
  if (integer.flags() != toml::value_flags::none) fail(key, "is not decimal; write it in decimal digits");
  return integer.get();
}

double Fields::number_of(const toml::node& node, const std::string& key, Quantity quantity, Sign sign) const {
  double value = 0.0;
  if (const auto* text = node.as_string()) {
    if (source_->units != Units::si)
      fail(key, "text where a number is expected; write a number (units are for scenes with units = \"SI\")");
    try {
      value = value_in_si(text->get(), quantity);
    } catch (const std::invalid_argument& error) {
      fail(key, error.what());
    }
  } else if (const auto* integer = node.as_integer()) {
    value = static_cast<double>(integer_of(*integer, key));
  } else if (const auto* real = node.as_floating_point()) {
    value = real->get();
  } else {
    fail(key, "wrong type; write a number");
  }
  if (!std::isfinite(value)) fail(key, "is not finite; write a finite number");
  if (const double size = std::fabs(value); size > largest_number || (size > 0.0 && size < smallest_number))
    fail(key, fmt::format("must be 0 or lie between {} and {} in size; choose other units", smallest_number,
                          largest_number));
  if (sign == Sign::positive && value <= 0.0) fail(key, "must be positive; write a number above 0");
  if (sign == Sign::not_negative && value < 0.0) fail(key, "must not be negative; write 0 or more");
  return value;
}

double Fields::number(const std::string& key, Quantity quantity, Sign sign) const {
  const double value = number_of(require(key), key, quantity, sign);
  keep(key, value_text(value));
  return value;
}

double Fields::number(const std::string& key, Quantity quantity, Sign sign, double fallback) const {
  if (has(key)) return number(key, quantity, sign);
  keep(key, value_text(fallback));
  return fallback;
}

std::uint64_t Fields::count(const std::string& key, std::optional<std::uint64_t> fallback) const {
  std::uint64_t count = fallback.value_or(0);
  if (!fallback || has(key)) {
    const auto* integer = require(key).as_integer();
    if (!integer)
      fail(key, fmt::format("wrong type; write a whole number without decimal point and leading zeros, at most {:.0f}",
                            exact_quanta));
    const std::int64_t value = integer_of(*integer, key);
    if (value < 0) fail(key, "must not be negative; write 0 or more");
    count = static_cast<std::uint64_t>(value);
  }
  keep(key, std::to_string(count));
  return count;
}

std::uint64_t Fields::steps(const std::string& key, std::optional<std::uint64_t> fallback) const {
  const std::uint64_t steps = count(key, fallback);
  if (steps > last_countable_step)
    fail(key, fmt::format("is more steps than can be counted; write at most {}", last_countable_step));
  return steps;
}

bool Fields::flag(const std::string& key, bool fallback) const {
  bool flag = fallback;
  if (has(key)) {
    const auto* value = require(key).as_boolean();
    if (!value) fail(key, "wrong type; write true or false");
    flag = value->get();
  }
  keep(key, flag ? "true" : "false");
  return flag;
}

bool Fields::is_word(const std::string& key) const {
  const toml::node* node = find(key);
  return node && node->is_string();
}

std::string Fields::word(const std::string& key) const {
  const auto* value = require(key).as_string();
  if (!value) fail(key, "wrong type; write a text in quotes");
  keep(key, value->get());
  return value->get();
}

Triple Fields::triple_of(const toml::node& node, const std::string& key, Quantity quantity) const {
  const toml::array* array = node.as_array();
  const auto dimension = static_cast<std::size_t>(source_->dimension);
  if (!array || array->size() != dimension)
    fail(key, fmt::format("wrong type; write a list of {} numbers, one per axis", dimension));
  Triple triple{};
  for (std::size_t i = 0; i < dimension; ++i) triple[i] = number_of(*array->get(i), key, quantity, Sign::any);
  return triple;
}

Triple Fields::vector(const std::string& key, Quantity quantity) const {
  const Triple value = triple_of(require(key), key, quantity);
  keep(key, value_text(value, source_->dimension));
  return value;
}

Triple Fields::vector(const std::string& key, Quantity quantity, const Triple& fallback) const {
  if (has(key)) return vector(key, quantity);
  keep(key, value_text(fallback, source_->dimension));
  return fallback;
}

std::vector<Triple> Fields::vectors(const std::string& key, Quantity quantity) const {
  const toml::array* array = require(key).as_array();
  if (!array || array->empty()) fail(key, "wrong type; write a list of points [[x, y], ...]");
  std::vector<Triple> triples;
  std::string text;
  for (const toml::node& node : *array) {
    triples.push_back(triple_of(node, key, quantity));
    text += (text.empty() ? "" : ", ") + value_text(triples.back(), source_->dimension);
  }
  keep(key, "[" + text + "]");
  return triples;
}

std::vector<double> Fields::sides(const std::string& key) const {
  const toml::array* array = require(key).as_array();
  if (!array || (array->size() != 2 && array->size() != 3))
    fail(key, "wrong type; write two or three sides, e.g. [1.0, 2.0]");
  std::vector<double> values;
  Triple sides{};
  for (const toml::node& node : *array) {
    sides[values.size()] = number_of(node, key, Quantity::length, Sign::positive);
    values.push_back(sides[values.size()]);
  }
  keep(key, value_text(sides, static_cast<int>(values.size())));
  return values;
}

int Fields::axis(const std::string& key, std::optional<int> fallback) const {
  const Names<int> names{{"x", 0}, {"y", 1}, {"z", 2}};
  const int axis = fallback ? choice(key, names, *fallback) : choice(key, names);
  if (axis >= source_->dimension) fail(key, "the box has no such axis; write \"x\" or \"y\"");
  return axis;
}

std::optional<Fields> Fields::table(const std::string& key) const {
  const toml::node* node = find(key);
  if (!node) return {};
  if (!node->is_table()) fail(key, fmt::format("wrong type; write a table [{}]", path(key)));
  return Fields(*source_, path(key), *node->as_table());
}

Fields Fields::required_table(const std::string& key) const {
  require(key);
  return *table(key);
}

std::vector<Fields> Fields::tables(const std::string& key) const {
  const toml::node* node = find(key);
  if (!node) return {};
  const toml::array* array = node->as_array();
  if (!array) fail(key, fmt::format("wrong type; write a list of tables [[{}]]", path(key)));
  std::vector<Fields> result;
  for (const toml::node& entry : *array) {
    if (!entry.is_table()) fail(key, fmt::format("wrong type; write a list of tables [[{}]]", path(key)));
    result.emplace_back(*source_, fmt::format("{}.{}", path(key), result.size()), *entry.as_table());
  }
  return result;
}

std::vector<Fields> Fields::table_or_tables(const std::string& key) const {
  const toml::node* node = find(key);
  if (node && node->is_array()) return tables(key);
  const std::optional<Fields> one = table(key);
  return one ? std::vector{*one} : std::vector<Fields>{};
}

}  // namespace mappm
