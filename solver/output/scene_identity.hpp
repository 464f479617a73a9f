// Whether two declarations describe the same scene: a run may be resumed for longer and with other output, but not as
// another scene.
#pragma once

#include <cstdint>
#include <string>

namespace mappm {

/// A scene's declaration (TOML as the reader writes it) without what may change when a run is resumed: the table
/// [output], and the keys `steps` and `duration` of [run].
std::string scene_identity(const std::string& text);

/// Hash of a text.
std::uint64_t text_hash(const std::string& text);

/// The first line in which two identities differ, as "A instead of B"; empty where they are equal.
std::string first_difference(const std::string& found, const std::string& expected);

}  // namespace mappm
