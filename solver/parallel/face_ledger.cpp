#include "parallel/face_ledger.hpp"

#include <algorithm>
#include <map>

namespace mappm {

namespace {

template <int D>
PairPoint<D> point_of(const Model<D>& model, const FluidParticles<D>& fluid, std::span<const double> density,
                      std::size_t i) {
  PairPoint<D> point;
  for (int axis = 0; axis < D; ++axis) {
    point.x[axis] = fluid.x(axis)[i];
    point.v[axis] = fluid.v(axis)[i];
  }
  point.volume = volume_terms(density[i], model.rest_density, 1.0, model.background);
  return point;
}

/// Impulse that PP i receives from j, a PP or an FP.
template <class Kernel, class Numbers, int D, class Beta>
Vec<D, std::int64_t> impulse_of_pair(const Numbers& numbers, const PairPoint<D>& i, const PairPoint<D>& j,
                                     Beta&& beta) {
  const auto pair = pair_of(numbers, i, j, [](double a, double b) { return a - b; });
  const auto r = separation(numbers.law(), pair.d);
  return numbers.sums(fluid_pair<Kernel, false>(numbers.law(), pair, r, cut_distance(dot(r, r)), beta(r))).impulse;
}

template <int D>
void add(Vec<D, Int128>& sum, const Vec<D, std::int64_t>& impulse, int sign) {
  for (int axis = 0; axis < D; ++axis) sum[axis] += sign * static_cast<Int128>(impulse[axis]);
}

}  // namespace

/// Calls visit(j) for every PP, owned or ghost, that may lie within rcut of x.
template <int D>
template <class Visit>
void FaceLedger<D>::for_each_near(const Vec<D, double>& x, Visit&& visit) const {
  Vec<D, int> first, last;
  for (int axis = 0; axis < D; ++axis) {
    const int cell = grid_.coordinate(axis, x[axis]);
    first[axis] = std::max(0, cell - grid_.margin(axis));
    last[axis] = std::min(grid_.count(axis) - 1, cell + grid_.margin(axis));
  }
  Vec<D, int> row = first;
  while (row[D - 1] <= last[D - 1]) {
    const std::size_t cells = grid_.row(row);
    const std::uint32_t begin = grid_.start(cells + static_cast<std::size_t>(first[0]));
    const std::uint32_t end = grid_.start(cells + static_cast<std::size_t>(last[0]) + 1);
    for (std::uint32_t j = begin; j < end; ++j) visit(j);
    for (int axis = 1; axis < D; ++axis) {
      if (++row[axis] <= last[axis] || axis == D - 1) break;
      row[axis] = first[axis];
    }
  }
}

template <int D>
std::vector<FaceImpulse<D>> FaceLedger<D>::faces(const FluidParticles<D>& fluid, std::span<const double> density,
                                                 const std::vector<FrozenInStep<D>>& frozen) const {
  std::map<int, Vec<D, Int128>> from;
  with_pair_numbers(model_, [&]<class Kernel, class Numbers>(Kernel, auto, const Numbers& numbers) {
    using Real = typename Numbers::Real;
    for (std::size_t g = 0; g < fluid.size(); ++g) {
      const PairPoint<D> ghost = point_of(model_, fluid, density, g);
      if (region_.contains(ghost.x)) continue;
      Vec<D, Int128>& sum = from[domains_.owner(ghost.x)];
      for_each_near(ghost.x, [&](std::size_t i) {
        const PairPoint<D> point = point_of(model_, fluid, density, i);
        if (region_.contains(point.x))
          add(sum, impulse_of_pair<Kernel>(numbers, point, ghost, [](const auto&) { return Real(1); }), 1);
      });
    }
    for (const FrozenInStep<D>& fp : frozen) {
      const PairPoint<D> point{fp.place.x, fp.place.v, fp.volume};
      const bool point_is_here = region_.contains(point.x);
      const NoSlipFactor<D, Real> beta(model_, fp);
      for_each_near(point.x, [&](std::size_t i) {
        const PairPoint<D> other = point_of(model_, fluid, density, i);
        if (region_.contains(other.x) == point_is_here) return;
        Vec<D, Int128>& sum = from[domains_.owner(point_is_here ? other.x : point.x)];
        add(sum, impulse_of_pair<Kernel>(numbers, other, point, beta), point_is_here ? -1 : 1);
      });
    }
  });
  std::vector<FaceImpulse<D>> faces;
  for (const auto& [rank, impulse] : from) faces.push_back({rank, impulse});
  return faces;
}

template class FaceLedger<2>;
template class FaceLedger<3>;

}  // namespace mappm
