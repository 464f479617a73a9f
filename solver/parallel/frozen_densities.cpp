#include "parallel/frozen_densities.hpp"

#include "base/fixed_point.hpp"

namespace mappm {

namespace {

/// Of the search, rcut: a little more, so that rounding never hides a pair within the cutoff.
constexpr double cutoff = 1.0 + 1e-6;

template <int D>
bool nearer_than(const Model<D>& model, const Vec<D, double>& a, const Vec<D, double>& b, double distance) {
  const Vec<D, double> r = separation(model.pair, a - b);
  return dot(r, r) < distance * distance;
}

}  // namespace

/// Every pair once: what it gives is the same for both.
template <int D>
void FrozenDensities<D>::add(const PlacedSolids<D>& solids, const CellLevels<D>& levels,
                             std::vector<std::int64_t>& sums) {
  with_pair_law(model_, [&]<class Kernel, bool transport>(Kernel, std::bool_constant<transport>) {
    for (std::uint32_t a = 0; a < solids.bodies.size(); ++a) {
      if (solids.first[a] == solids.first[a + 1]) continue;
      const SolidInStep<D>& one = solids.bodies[a];
      levels.for_each_near(separation(model_.pair, one.solid->x), one.shape->reach, cutoff, [&](std::uint32_t b) {
        const SolidInStep<D>& other = solids.bodies[b];
        if (b <= a || !give_each_other_density(model_, *one.solid, *other.solid, true)) return;
        const double reach = one.shape->reach + other.shape->reach + cutoff;
        if (!nearer_than(model_, one.solid->x, other.solid->x, reach)) return;
        choose(solids, b, one, others_);
        if (others_.empty()) return;
        choose(solids, a, other, ones_);
        fill_blocks(solids.frozen);
        add_pairs<Kernel>(solids.frozen, sums);
      });
    }
  });
}

/// FPs of a body within reach of another one.
template <int D>
void FrozenDensities<D>::choose(const PlacedSolids<D>& solids, std::size_t body, const SolidInStep<D>& other,
                                std::vector<std::size_t>& chosen) const {
  chosen.clear();
  for (std::size_t k = solids.first[body]; k < solids.first[body + 1]; ++k)
    if (nearer_than(model_, solids.frozen[k].place.x, other.solid->x, other.shape->reach + cutoff)) chosen.push_back(k);
}

/// Lanes behind the last FP lie out of reach.
template <int D>
void FrozenDensities<D>::fill_blocks(const std::vector<FrozenInStep<D>>& frozen) {
  blocks_.resize((others_.size() + lane_count - 1) / lane_count);
  for (std::size_t n = 0; n < blocks_.size() * lane_count; ++n) {
    Block& block = blocks_[n / lane_count];
    const std::size_t lane = n % lane_count;
    for (int axis = 0; axis < D; ++axis)
      block.x[axis][lane] = n < others_.size() ? frozen[others_[n]].place.x[axis] : 4.0 * box_quanta;
    if (lane == 0) block.density = 0;
  }
}

template <int D>
template <class Kernel>
void FrozenDensities<D>::add_pairs(const std::vector<FrozenInStep<D>>& frozen, std::vector<std::int64_t>& sums) {
  for (const std::size_t k : ones_) {
    const PlacedFrozen<D>& one = frozen[k].place;
    IntLanes density = 0;
    for (Block& block : blocks_) {
      Vec<D, Lanes> d;
      for (int axis = 0; axis < D; ++axis) d[axis] = Lanes(one.x[axis]) - load_lanes(block.x[axis]);
      const Vec<D, Lanes> r = separation(model_.pair, d);
      const Lanes square = dot(r, r);
      if (!any_below(square, 1.0)) continue;
      const IntLanes given = pair_density<Kernel>(model_.pair, cut_distance(square));
      density += given;
      block.density += given;
    }
    sums[k] += sum_of_lanes(density);
  }
  for (std::size_t n = 0; n < others_.size(); ++n) sums[others_[n]] += blocks_[n / lane_count].density[n % lane_count];
}

template class FrozenDensities<2>;
template class FrozenDensities<3>;

}  // namespace mappm
