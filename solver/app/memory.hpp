// The memory that a run needs, estimated before any of it is taken, and what there is of it.
#pragma once

#include <filesystem>
#include <string>

#include "base/group.hpp"
#include "scene/scene.hpp"

namespace mappm {

/// Bytes that an engine keeps for a particle, its samples and snapshots included, as measured: for each, for each axis,
/// and for each neighbour within rcut.
struct ParticleBytes {
  double each = 0.0, an_axis = 0.0, a_neighbour = 0.0;
};

struct MemoryNeed {
  double particles = 0.0;  // PPs and FPs, as many as the lattice has nodes; none where solids are alone
  double bytes = 0.0;      // of all processes together, beside what each has at its start

  /// "0.35 GB"
  std::string text() const;
};

MemoryNeed memory_need(const Scene& scene, const ParticleBytes& bytes);

/// Bytes that this process may still take: what its limits, its control groups and the machine leave it. `processes`
/// share the machine and its groups. `root`: of the folders proc and sys.
double memory_left(int processes, const std::filesystem::path& root = "/");

/// Collective. Throws InputError where a process has not the memory for its share of the need.
void check_memory(const Scene& scene, const MemoryNeed& need, const Group& group);

}  // namespace mappm
