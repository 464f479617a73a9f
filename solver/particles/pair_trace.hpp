// What each partner gave to one PP in one step, on request: the sums of the pair law taken apart.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "physics/pseudo_particle.hpp"

namespace mappm {

/// What one partner gave: a PP, or an FP of a solid.
template <int D>
struct PartnerTrace {
  bool frozen = false;
  std::uint64_t id = 0;     // of the PP, or of the solid
  std::uint32_t index = 0;  // of the FP in its shape
  NeighbourSums<D> given{};
  std::int64_t density = 0;  // density quanta

  bool any() const {
    return density != 0 || !(given.impulse == Vec<D, std::int64_t>{}) || !(given.shift == Vec<D, std::int64_t>{});
  }
};

/// All partners of one PP in the step from `step` to `step + 1`, in no particular order; those that gave nothing, since
/// they lie beyond the cutoff, are left out.
template <int D>
struct StepTrace {
  std::uint64_t step = 0, particle = 0;
  std::vector<PartnerTrace<D>> partners;
};

/// The trace of the last step, where one was asked for and this process owned the PP.
template <int D>
using MaybeTrace = std::optional<StepTrace<D>>;

}  // namespace mappm
