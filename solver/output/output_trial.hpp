// What can fail at the end of a run is tried at its start: the paths of its last files, the permissions, the room.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/group.hpp"

namespace mappm {

/// A file that a run will write, and how long it will be.
struct ExpectedFile {
  std::filesystem::path path;
  std::uint64_t bytes = 0;  // of its content
};

/// Collective. Makes the files half written, by all processes together, asks the disk for the room of all at once, and
/// removes them and the folders made for them. Throws InputError, naming the file that could not be written.
void try_output(const std::vector<ExpectedFile>& files, const Group& group);

}  // namespace mappm
