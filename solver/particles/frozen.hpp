// The FPs of a step: placed anew from their solids, which carry their state.
#pragma once

#include <cstdint>
#include <vector>

#include "particles/solid_step.hpp"
#include "physics/state_equation.hpp"
#include "physics/wall.hpp"

namespace mappm {

template <int D>
struct FrozenInStep {
  PlacedFrozen<D> place;
  VolumeTerms<double> volume;
  double depth = 0.0;
  double own_density = 0.0;
  std::uint32_t solid = 0;  // index in the list of solids it was placed from
  std::uint32_t index = 0;  // in its shape
};

/// False where no FP of a solid lies in `region`; a copy that is there for its contacts alone has none.
template <int D>
bool may_reach(const Model<D>& model, const Solid<D>& solid, const Region<D>& region) {
  const double reach = (1.0 + 1e-6) * model.shapes[solid.shape].reach;  // rounding hides no FP
  for (int axis = 0; axis < D; ++axis) {
    const double quanta = reach / model.pair.length[axis];
    if (solid.x[axis] + quanta < region.low[axis] || solid.x[axis] - quanta >= region.high[axis]) return false;
  }
  return true;
}

/// Appends the FPs of one solid that lie in `region` (in the frame of the solid's copy).
template <int D>
void place_frozen(const Model<D>& model, const SolidInStep<D>& body, std::uint32_t solid, const Region<D>& region,
                  std::vector<FrozenInStep<D>>& to) {
  if (!may_reach(model, *body.solid, region)) return;
  const auto& frozen = body.shape->frozen;
  for (std::uint32_t k = 0; k < frozen.size(); ++k) {
    const PlacedFrozen<D> placed = place(*body.solid, body.velocity, frozen[k], model.pair.length);
    if (!region.contains(placed.x)) continue;
    const VolumeTerms<double> volume = volume_terms(body.solid->density[k], model.rest_density, 1.0, model.background);
    to.push_back({placed, volume, frozen[k].depth, frozen[k].own_density, solid, k});
  }
}

/// beta of the pairs of one FP, as a function of the separation from it; in one number or in lanes.
template <int D, class Real>
class NoSlipFactor {
 public:
  NoSlipFactor(const Model<D>& model, const FrozenInStep<D>& fp)
      : extrapolated_(model.terms.extrapolated),
        depth_(static_cast<Real>(fp.depth)),
        nearest_(static_cast<Real>(model.no_slip_nearest)) {
    for (int axis = 0; axis < D; ++axis) normal_[axis] = static_cast<Real>(fp.place.normal[axis]);
  }
  template <class Wide>
  MAPPM_INLINE Wide operator()(const Vec<D, Wide>& r) const {
    if (!extrapolated_) return constant<Wide>(1.0);
    Vec<D, Wide> normal;
    for (int axis = 0; axis < D; ++axis) normal[axis] = Wide(normal_[axis]);
    return no_slip_factor(r, normal, Wide(depth_), nearest_);
  }

 private:
  bool extrapolated_;
  Vec<D, Real> normal_;
  Real depth_, nearest_;
};

/// Adds the impulse that one FP received in a step (iota), and its torque, to those of its solid.
template <int D>
void add_frozen_load(const FrozenInStep<D>& fp, const Vec<D, std::int64_t>& impulse, SolidImpulse<D>& to) {
  Vec<D, double> value;
  for (int axis = 0; axis < D; ++axis) {
    to.linear[axis] += impulse[axis];
    value[axis] = static_cast<double>(impulse[axis]);
  }
  to.angular += torque_impulse<D>(fp.place.lever, value);
}

/// Density of an FP for the next step from the sum over PPs and FPs of other solids (density quanta).
template <int D>
double frozen_density(const FrozenInStep<D>& fp, std::int64_t sum) {
  return static_cast<double>(sum) * density_quantum + fp.own_density;
}

}  // namespace mappm
