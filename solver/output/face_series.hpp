// faces.csv: the ledger of momentum between domains, on request; one row per sample, rank and partner.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/group.hpp"
#include "output/csv_file.hpp"
#include "particles/face_impulse.hpp"

namespace mappm {

template <int D>
class FaceSeries {
 public:
  /// Collective. As for Series.
  FaceSeries(const std::filesystem::path& folder, const Group& group, std::optional<std::uint64_t> resumed_step);

  /// Collective: gathers the entries of all processes on the first. Columns: step, rank, partner, impulse (iota, an
  /// integer) that the particles of `rank` received from those of `partner` in the step that ended at `step`.
  void add(std::uint64_t step, const std::vector<FaceImpulse<D>>& faces);

 private:
  const Group& group_;
  std::optional<CsvFile> file_;  // of the first process
};

}  // namespace mappm
