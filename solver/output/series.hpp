// series.csv: one row a sample, in the units of the scene. Written by the first process; every figure comes from
// integer sums, so the file has the same bytes on any number of processes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "base/group.hpp"
#include "output/columns.hpp"
#include "output/csv_file.hpp"
#include "output/totals.hpp"

namespace mappm {

/// The row of a sample. Columns: step, time; mean velocity of the PPs; superficial velocity (sum of PP velocities times
/// their volume at rest, over the volume of the box); where the scene has solids the mean velocity of the SPs that are
/// not fixed, slip (SPs minus PPs), drag (mean force of the fluid on an SP since the sample before), force of the fluid
/// on all walls; kinetic energy of the PPs, their energy of compression,
/// kinetic energies of the solids; angular momentum about the middle of the box (where particles cross its border it
/// jumps: positions are those in the box); number of PPs; lowest and highest density over rho0; momentum ledger (iota:
/// total, impulse from outside, defect, which is always 0); digest. sampled_step: step of the sample before.
template <int D>
Columns series_columns(const Model<D>& model, const UnitNames& units, const Totals<D>& totals,
                       const Vec<D, Int128>& start_momentum, std::uint64_t sampled_step);

template <int D>
class Series {
 public:
  /// Collective. `resumed_step`: step of the checkpoint from which the run goes on; rows beyond it are dropped.
  /// Throws InputError.
  Series(const std::filesystem::path& folder, const Model<D>& model, const UnitNames& units, const Group& group,
         std::optional<std::uint64_t> resumed_step);

  /// Collective. Adds the row of `totals`. Throws InputError where the file cannot be written.
  void add(const Totals<D>& totals, const Vec<D, Int128>& start_momentum, std::uint64_t sampled_step);

 private:
  const Model<D>& model_;
  UnitNames units_;
  const Group& group_;
  std::optional<CsvFile> file_;  // of the first process
};

}  // namespace mappm
