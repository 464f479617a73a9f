// The checkpoints of a run: each is written under a temporary name, synced and renamed; two are kept.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "output/checkpoint.hpp"

namespace mappm {

/// `folder`/checkpoint_SSSSSSSSS.h5, S being the step.
std::filesystem::path checkpoint_path(const std::filesystem::path& folder, std::uint64_t step);

/// Collective. Writes the checkpoint of the step of the state, and then removes all but the newest two
/// files of that kind. Throws InputError where it cannot be completed; those before it are then untouched.
/// Returns the path of the new one.
template <int D>
std::filesystem::path save_checkpoint(const std::filesystem::path& folder, const std::string& scene_text,
                                      const State<D>& state, std::uint64_t sampled_step, const Group& group);

template <int D>
struct FoundCheckpoint {
  Checkpoint<D> checkpoint;
  std::filesystem::path path;
  std::string warning;  // which newer ones were passed over, and why; empty if none
};

/// Collective. Reads the checkpoint to resume from. `from`: a checkpoint, or a folder of checkpoints, or the output
/// folder of a run; of a folder the newest sound one is taken. Throws InputError: for a file that is refused, the
/// message names the newest sound one beside it.
template <int D>
FoundCheckpoint<D> find_checkpoint(const std::filesystem::path& from, const std::string& scene_text,
                                   const Model<D>& model, const Region<D>& region, const Group& group);

/// Name of the folder of checkpoints in the output folder of a run.
inline constexpr const char* checkpoint_folder_name = "checkpoints";

/// Checkpoints in a folder, the last written first.
std::vector<std::filesystem::path> list_checkpoints(const std::filesystem::path& folder);

}  // namespace mappm
