// Snapshots for ParaView and pyvista: VTKHDF files (UnstructuredGrid, version 1.0, one vertex cell a point), in the
// units of the scene. All processes write their points into one file.
#pragma once

#include <cstdint>
#include <filesystem>

#include "base/group.hpp"
#include "particles/density_field.hpp"
#include "particles/model.hpp"

namespace mappm {

/// Name of the folder of snapshots in the output folder of a run.
inline constexpr const char* snapshot_folder_name = "snapshots";

/// Paths of the files of a step: of the fluid, of the SPs.
struct SnapshotPaths {
  SnapshotPaths(const std::filesystem::path& folder, std::uint64_t step);
  std::filesystem::path fluid, solids;
};

/// Bytes of a point of the fluid in its file.
inline constexpr std::uint64_t snapshot_point_bytes = 100;

/// Collective. Writes `folder`/fluid_SSSSSSSSS.vtkhdf and, where the scene has SPs, `folder`/solids_SSSSSSSSS.vtkhdf,
/// S being the step. Throws InputError where they cannot be written.
///
/// fluid:  a point a PP and FP; velocity, density, pressure, id (of a PP; of an FP its index in its solid), kind (0 PP,
///         1 FP), solid (id of the FP's solid; -1 for a PP)
/// solids: a point a ball; radius, velocity and angular_velocity of its SP (the plane's in the last component), id of
///         its SP, drag on its SP (mean since the sample before, of step `sampled_step`)
/// both:   field data TimeValue and step
template <int D>
void write_snapshot(const std::filesystem::path& folder, const Model<D>& model, const Sample<D>& sample,
                    std::uint64_t sampled_step, const Group& group);

}  // namespace mappm
