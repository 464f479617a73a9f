// The fields that a scene may declare, of velocity under [fluid] and of acceleration under [force], and the velocity of
// the fluid at the start. Private to reader and builder.
#pragma once

#include <optional>

#include "particles/model.hpp"
#include "scene/fields.hpp"

namespace mappm {

/// The one of the keys `wave`, `vortices` and `abc` that the table has, or none; box: sides. Throws InputError for more
/// than one, for vortices in a box of unequal sides, and for abc in the plane.
std::optional<FlowField> read_flow(const Fields& table, Quantity quantity, const Triple& box);

/// Velocity of the fluid at the start, c: uniform plus the declared field, rounded to its quantum. x: position quanta.
template <int D>
class InitialVelocity {
 public:
  InitialVelocity(const FluidScene& fluid, const UnitScale& units);
  Vec<D, double> at(const Vec<D, double>& x) const { return flow_ ? rounded(flow_at(*flow_, x)) : uniform_; }

 private:
  Vec<D, double> rounded(const Vec<D, double>& varying) const;

  const FluidScene& fluid_;
  double unit_;
  std::optional<FlowField> flow_;
  Vec<D, double> uniform_;
};

}  // namespace mappm
