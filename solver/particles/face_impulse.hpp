// The ledger of momentum between domains: what the particles of one received from those of another.
#pragma once

#include "base/fixed_point.hpp"
#include "base/vec.hpp"

namespace mappm {

/// Partner of the entry that holds all that the particles of a domain received.
inline constexpr int all_partners = -1;

/// Impulse (iota) that the PPs and FPs in a domain received in a step from those in the domain of rank `partner`.
template <int D>
struct FaceImpulse {
  int partner = all_partners;
  Vec<D, Int128> impulse{};
};

}  // namespace mappm
