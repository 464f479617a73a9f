// trace.csv: what each partner gave to one PP in one step, on request.
#pragma once

#include <filesystem>
#include <string>

#include "base/group.hpp"
#include "particles/pair_trace.hpp"
#include "particles/state.hpp"

namespace mappm {

/// The table as text, a row a partner, PPs before FPs and each by their number. Columns: step, particle, kind (PP or
/// FP), partner (id of the PP; of an FP "solid:index"), impulse (iota), with `transport` shift (position quanta),
/// density (density quanta): integers as the pair law gave them.
template <int D>
std::string trace_text(const StepTrace<D>& trace, bool transport);

/// Collective. `fluid`: what this process owns. Throws InputError where no process owns a PP of this id.
template <int D>
void check_traced(const FluidParticles<D>& fluid, std::uint64_t particle, const Group& group);

/// Collective. Writes folder/trace.csv by the process that has the trace. Throws InputError where it cannot be written.
template <int D>
void write_trace(const std::filesystem::path& folder, const MaybeTrace<D>& trace, bool transport, const Group& group);

}  // namespace mappm
