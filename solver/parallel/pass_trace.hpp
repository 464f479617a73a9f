// Takes apart what the passes of a step summed for one PP.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "parallel/fluid_pass.hpp"
#include "particles/pair_trace.hpp"

namespace mappm {

/// In the step in which `fluid` was ordered, after all sums: what each partner gave to the PP with this id that lies in
/// the region of the grid, every pair of the pass taken alone; none where there is no such PP. For an FP `id` is the
/// index of its solid in the step.
template <int D, class Numbers>
std::optional<std::vector<PartnerTrace<D>>> trace_partners(const StepSums<D, Numbers, Stage::forces>& sums,
                                                           const FluidParticles<D>& fluid, const CellGrid<D>& grid,
                                                           const std::vector<FrozenInStep<D>>& frozen,
                                                           std::uint64_t particle);

}  // namespace mappm
