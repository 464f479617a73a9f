// The scene's TOML tree as it stands after the overrides. Private to the reader.
#pragma once

#include <string>
#include <vector>

#include "scene/toml.hpp"

namespace mappm {

/// Parses `text` and applies the overrides "key.path=value". A value that is no TOML value is taken as a string; an
/// override of one of two alternatives (run.step and run.step_factor, say) removes the other. Throws InputError.
toml::table parse_document(const std::string& text, const std::string& file, const std::vector<std::string>& overrides);

/// The tree as TOML with sorted keys, without the table [case].
std::string canonical_text(const toml::table& tree);

/// A node for a message; numbers in as few digits as tell them apart.
std::string node_text(const toml::node& node);

/// The name among `known` that differs from `word` in the fewest letters; empty if none is alike.
std::string nearest_name(const std::string& word, const std::vector<std::string>& known);

}  // namespace mappm
