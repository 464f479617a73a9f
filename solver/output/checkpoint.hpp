// The whole integer state in one HDF5 file, written and read by any number of processes.
//
// A seal follows the HDF5 file (file_seal.hpp); HDF5 itself does not mind it.
//
//   /            attributes: format, version, dimension, scene_hash, step, sampled_step, digest, ledger_hash,
//                start_momentum, outside_impulse (low and high word an axis)
//   /scene       the identity of the scene (scene/scene.hpp), a byte a letter
//   /fluid/id, /fluid/x_x ..., v_x ..., density     a row a PP: position quanta, velocity and density as counts of
//   quanta /solids/words      a row of 64-bit words a solid (see solid_words.hpp) /solids/density    of the FPs, one
//   solid's after the other's: counts of density quanta /solids/contacts   a row of words a contact, one solid's after
//   the other's
#pragma once

#include <cstdint>
#include <string>

#include "base/group.hpp"
#include "particles/model.hpp"
#include "particles/state.hpp"

namespace mappm {

/// The state, and the step of the last sample, up to which impulses have been written to the series.
template <int D>
struct Checkpoint {
  State<D> state;
  std::uint64_t sampled_step = 0;
};

/// Length of a checkpoint of so many PPs and solids, without contacts and headers.
template <int D>
std::uint64_t checkpoint_bytes(std::uint64_t fluid_particles, std::uint64_t solids);

/// Collective. `scene_text`: the identity of the scene, lines "key = value". Throws InputError where the file cannot be
/// completed.
template <int D>
void write_checkpoint(const std::string& path, const std::string& scene_text, const State<D>& state,
                      std::uint64_t sampled_step, const Group& group);

/// Collective. What of the checkpoint lies in `region`; the regions of the group must fill the box. The impulse from
/// outside is held by the first process. Throws InputError if the file is damaged, of another format or another scene.
template <int D>
Checkpoint<D> read_checkpoint(const std::string& path, const std::string& scene_text, const Model<D>& model,
                              const Region<D>& region, const Group& group);

}  // namespace mappm
