// Whether two declarations describe the same scene: a run may be resumed for longer and with other output, but not as
// another scene.
#pragma once

#include <cstdint>
#include <string>

namespace mappm {

/// Hash of a text.
std::uint64_t text_hash(const std::string& text);

/// The first key that two identities, lines "key = value" sorted by key, do not share, with its value here and there,
/// or "not given"; empty where they are equal. `where`: where the second one stands, in words.
std::string first_difference(const std::string& here, const std::string& there,
                             const std::string& where = "the checkpoint");

}  // namespace mappm
