// One table of a scene, read key by key with checks of type, unit and sign. A key that nobody has read when the table
// is finished is unknown. Private to the reader.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/document.hpp"
#include "scene/scene.hpp"
#include "scene/units.hpp"

namespace mappm {

enum class Sign { any, not_negative, positive };

/// What all tables of a scene share.
struct Source {
  std::string file;
  Units units = Units::dimensionless;
  int dimension = 2;
  /// What was understood, by path: values in the scene's units, and defaults where a key is not given.
  mutable std::map<std::string, std::string> values = {};
};

class Fields {
 public:
  /// `path`: the table's own key, empty for the root. `table` must outlive this.
  Fields(const Source& source, std::string path, const toml::table& table);

  bool has(const std::string& key) const;

  /// Throws InputError if the key is missing, has another type, a wrong unit or sign, or is not finite.
  double number(const std::string& key, Quantity quantity, Sign sign) const;
  double number(const std::string& key, Quantity quantity, Sign sign, double fallback) const;
  std::uint64_t count(const std::string& key, std::optional<std::uint64_t> fallback = {}) const;
  /// A count of steps, at most `last_countable_step`.
  std::uint64_t steps(const std::string& key, std::optional<std::uint64_t> fallback = {}) const;
  bool flag(const std::string& key, bool fallback) const;
  std::string word(const std::string& key) const;
  bool is_word(const std::string& key) const;  // for a key of two types

  /// As many entries as the scene has dimensions.
  Triple vector(const std::string& key, Quantity quantity) const;
  Triple vector(const std::string& key, Quantity quantity, const Triple& fallback) const;
  std::vector<Triple> vectors(const std::string& key, Quantity quantity) const;
  /// Two or three positive entries: the only key that fixes the dimension.
  std::vector<double> sides(const std::string& key) const;
  int axis(const std::string& key, std::optional<int> fallback = {}) const;

  template <class Choice>
  using Names = std::vector<std::pair<std::string, Choice>>;
  template <class Choice>
  Choice choice(const std::string& key, const Names<Choice>& names) const {
    const std::string given = word(key);
    std::vector<std::string> known;
    for (const auto& [name, value] : names) {
      if (name == given) return value;
      known.push_back(name);
    }
    fail_choice(key, known);
  }
  template <class Choice>
  Choice choice(const std::string& key, const Names<Choice>& names, Choice fallback) const {
    if (has(key)) return choice(key, names);
    for (const auto& [name, value] : names)
      if (value == fallback) keep(key, name);
    return fallback;
  }

  std::optional<Fields> table(const std::string& key) const;
  Fields required_table(const std::string& key) const;
  std::vector<Fields> tables(const std::string& key) const;  // of [[key]]
  std::vector<Fields> table_or_tables(
      const std::string& key) const;  // of [key], which counts as a list of one, or of [[key]]

  /// Throws InputError for the first key that was not asked for, and names the nearest one that was.
  void finish() const;

  /// Throws InputError for `key`: file and line, key, value as written.
  [[noreturn]] void fail(const std::string& key, const std::string& fix) const;

  std::string path(const std::string& key) const;
  const Source& source() const { return *source_; }

 private:
  void keep(const std::string& key, const std::string& value) const { source_->values[path(key)] = value; }
  const toml::node* find(const std::string& key) const;
  const toml::node& require(const std::string& key) const;
  std::int64_t integer_of(const toml::value<std::int64_t>& integer, const std::string& key) const;
  double number_of(const toml::node& node, const std::string& key, Quantity quantity, Sign sign) const;
  Triple triple_of(const toml::node& node, const std::string& key, Quantity quantity) const;
  [[noreturn]] void fail_choice(const std::string& key, const std::vector<std::string>& known) const;
  [[noreturn]] void fail_unknown(const std::string& key) const;

  const Source* source_;
  std::string path_;
  const toml::table* table_;
  mutable std::vector<std::string> asked_;
};

}  // namespace mappm
