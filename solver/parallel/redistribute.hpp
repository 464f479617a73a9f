// A new decomposition: borders moved to the particle load, every particle sent to its new owner.
#pragma once

#include <utility>

#include "parallel/communicator.hpp"
#include "parallel/domains.hpp"

namespace mappm {

/// Domains whose borders share the PPs and FPs of all processes evenly along each axis.
template <int D>
Domains<D> domains_by_load(const Model<D>& model, const Domains<D>& domains, const Communicator& communicator,
                           const State<D>& state);

/// Sends every PP and solid to its owner under `domains`.
template <int D>
void redistribute(const Domains<D>& domains, const Communicator& communicator, State<D>& state);

}  // namespace mappm
