// solids.csv: one row per SP and sample, on request. Pieces of walls are left out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "base/group.hpp"
#include "output/columns.hpp"
#include "output/csv_file.hpp"
#include "output/totals.hpp"

namespace mappm {

template <int D>
class SolidSeries {
 public:
  /// Collective. As for Series.
  SolidSeries(const std::filesystem::path& folder, const Model<D>& model, const UnitNames& units, const Group& group,
              std::optional<std::uint64_t> resumed_step);

  /// Collective: gathers the SPs on the first process. Columns: step, time, id, position, velocity, orientation (plane:
  /// cos, sin; space: quaternion w, x, y, z), angular velocity, drag since the sample before. Sorted by id.
  void add(const State<D>& state, std::uint64_t sampled_step);

 private:
  std::vector<double> values_of(const Solid<D>& solid, std::uint64_t steps) const;
  Columns columns(std::uint64_t step, const double* values) const;

  static constexpr int orientations = D == 2 ? 2 : 4;
  static constexpr int value_count = 1 + 3 * D + orientations + angular_components<D>;

  const Model<D>& model_;
  UnitNames units_;
  const Group& group_;
  std::optional<CsvFile> file_;
};

}  // namespace mappm
