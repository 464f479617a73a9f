// The ledger of momentum over the faces of a domain: what its particles received in a step from those of each other
// domain. Computed outside the pass, from the same law pair by pair, so that the sums of the pass can be held against
// it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "parallel/domains.hpp"
#include "particles/cell_grid.hpp"
#include "particles/face_impulse.hpp"
#include "particles/frozen.hpp"
#include "particles/model.hpp"

namespace mappm {

template <int D>
class FaceLedger {
 public:
  /// `grid`: the order of the PPs in the step, owned and ghosts.
  FaceLedger(const Model<D>& model, const Domains<D>& domains, const Region<D>& region, const CellGrid<D>& grid)
      : model_(model), domains_(domains), region_(region), grid_(grid) {}

  /// Impulse (iota) that the PPs and FPs in the region received from ghosts, by the rank that owns these, in increasing
  /// order. Across a periodic border that may be the own rank; what it gives itself adds up to zero.
  /// density: of the PPs, PPs per rcut^D.
  std::vector<FaceImpulse<D>> faces(const FluidParticles<D>& fluid, std::span<const double> density,
                                    const std::vector<FrozenInStep<D>>& frozen) const;

 private:
  template <class Visit>
  void for_each_near(const Vec<D, double>& x, Visit&& visit) const;

  const Model<D>& model_;
  const Domains<D>& domains_;
  const Region<D>& region_;
  const CellGrid<D>& grid_;
};

}  // namespace mappm
