// The grids of domains that a number of processes allows, and domains of uneven size.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "parallel/domains.hpp"

namespace mappm::testing {

/// "4x1", "2x2", "1x4" and so on: every way to write `processes` as a product of D factors.
template <int D>
std::vector<std::string> all_grids(int processes) {
  std::vector<std::string> grids;
  for (int x = 1; x <= processes; ++x) {
    if (processes % x != 0) continue;
    const int rest = processes / x;
    if constexpr (D == 2)
      grids.push_back(std::to_string(x) + "x" + std::to_string(rest));
    else
      for (const std::string& grid : all_grids<2>(rest)) grids.push_back(std::to_string(x) + "x" + grid);
  }
  return grids;
}

/// The same grid with borders moved: the domains grow along each axis from the smallest one allowed.
template <int D>
Domains<D> uneven(const Model<D>& model, const Domains<D>& even) {
  auto cuts = even.cuts();
  for (int axis = 0; axis < D; ++axis) {
    auto& borders = cuts[static_cast<std::size_t>(axis)];
    const double smallest = std::ceil(std::max(1.25, solid_margin(model)) / model.pair.length[axis]);
    for (std::size_t n = 1; n + 1 < borders.size(); ++n) borders[n] = borders[n - 1] + smallest + 17.0;
  }
  return Domains<D>(std::move(cuts));
}

}  // namespace mappm::testing
