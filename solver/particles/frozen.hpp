// The FPs of a step: placed anew from their solids.
#pragma once

#include <cstdint>
#include <vector>

#include "particles/density_field.hpp"
#include "particles/solid_step.hpp"
#include "physics/state_equation.hpp"
#include "physics/wall.hpp"

namespace mappm {

template <int D>
struct FrozenInStep {
  PlacedFrozen<D> place;
  double density = 0.0;  // PPs per rcut^D, once it is known
  VolumeTerms<double> volume{};
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
    FrozenInStep<D>& fp = to.emplace_back();
    fp.place = placed;
    fp.depth = frozen[k].depth;
    fp.own_density = frozen[k].own_density;
    fp.solid = solid;
    fp.index = k;
  }
}

/// The share of a solid in the density of its FPs is part of its shape, as is that of the other pieces of a wall. Its
/// periodic images are other matter: `images` if the two are images of one solid.
template <int D>
bool give_each_other_density(const Model<D>& model, const Solid<D>& one, const Solid<D>& other, bool images) {
  if (one.group != other.group) return true;
  return images && one.id == other.id && !is_wall_piece(model.shapes[one.shape]);
}

/// beta of the pairs of one FP, as a function of the separation from it; in one number or in lanes.
template <int D, class Real>
class NoSlipFactor {
 public:
  NoSlipFactor(const Model<D>& model, const FrozenInStep<D>& fp)
      : extrapolated_(model.terms.extrapolated),
        depth_(static_cast<Real>(fp.depth)),
        nearest_(static_cast<Real>(model.no_slip_nearest)),
        largest_(static_cast<Real>(model.no_slip_largest)) {
    for (int axis = 0; axis < D; ++axis) normal_[axis] = static_cast<Real>(fp.place.normal[axis]);
  }
  template <class Wide>
  MAPPM_INLINE Wide operator()(const Vec<D, Wide>& r) const {
    if (!extrapolated_) return constant<Wide>(1.0);
    Vec<D, Wide> normal;
    for (int axis = 0; axis < D; ++axis) normal[axis] = Wide(normal_[axis]);
    return no_slip_factor(r, normal, Wide(depth_), nearest_, largest_);
  }

 private:
  bool extrapolated_;
  Vec<D, Real> normal_;
  Real depth_, nearest_, largest_;
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

template <int D>
FrozenPoint<D> point_of(const FrozenInStep<D>& fp, const Solid<D>& solid) {
  return {solid.id, fp.index, fp.place.x, fp.place.v, fp.density};
}

template <int D>
void set_density(const Model<D>& model, FrozenInStep<D>& fp, double density) {
  fp.density = density;
  fp.volume = volume_terms(density, model.rest_density, 1.0, model.background);
}

}  // namespace mappm
