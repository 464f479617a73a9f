// The last bytes of a file tell its length and a hash of its content. A reader looks at them before it hands the file
// to a library that trusts what it reads: HDF5 may crash on a damaged file.
#pragma once

#include <filesystem>

#include "base/group.hpp"

namespace mappm {

/// Collective; each process hashes its share of the file. Ends a complete file with its seal (24 bytes: a mark, the
/// length before it, the hash). Throws InputError where it cannot be written.
void seal_file(const std::filesystem::path& path, const Group& group);

/// Collective. Throws InputError where the file cannot be read, has no seal or another content than was sealed.
void check_seal(const std::filesystem::path& path, const Group& group);

}  // namespace mappm
