// The loops over pairs of the fast engine: one particle against a contiguous row of others, a lane each.
#pragma once

#include <array>
#include <cstdint>

#include "particles/frozen.hpp"
#include "particles/model.hpp"
#include "physics/wall.hpp"

namespace mappm {

/// Field arrays of the PPs in cell order. All have at least `lane_count` valid entries behind the last particle.
template <int D>
struct PairFields {
  std::array<const double*, D> x, v;
  const double *v2, *pv2;
  std::array<std::int64_t*, D> impulse, shift;
  std::int64_t* density;
};

/// The one particle of a row loop: a PP or an FP.
template <int D>
struct PairCentre {
  Vec<D, double> x, v;
  VolumeTerms<double> volume;
};

namespace detail {

/// Adds `given` to the lanes' sums with the sign of their side of the pair; only the first `count` lanes are stored.
template <bool whole>
MAPPM_INLINE void add_to(std::int64_t* sums, const IntLanes& given, int count) {
  if constexpr (whole)
    store_lanes(load_lanes(sums) + given, sums);
  else
    store_first_lanes(count, load_lanes(sums) + given, sums);
}

template <int D>
struct LaneSums {
  Vec<D, IntLanes> impulse, shift;
  IntLanes density;
};

/// One chunk of lanes, particles j .. j + count - 1. With `lanes_first` the lanes are i of the law and the centre is j.
template <class Kernel, bool transport, bool lanes_first, bool whole, int D, class Beta>
MAPPM_INLINE void pair_chunk(const PairLaw<D>& law, const PairFields<D>& fields, const PairCentre<D>& centre,
                             std::size_t j, int count, const Beta& beta, LaneSums<D>& sums) {
  FluidPair<D, Lanes> pair;
  for (int axis = 0; axis < D; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const Lanes x = load_lanes(fields.x[a] + j), v = load_lanes(fields.v[a] + j);
    pair.d[axis] = lanes_first ? x - Lanes(centre.x[axis]) : Lanes(centre.x[axis]) - x;
    pair.v[axis] = lanes_first ? v - Lanes(centre.v[axis]) : Lanes(centre.v[axis]) - v;
  }
  pair.v2 = Lanes(centre.volume.v2) + load_lanes(fields.v2 + j);
  pair.pv2 = Lanes(centre.volume.pv2) + load_lanes(fields.pv2 + j);
  const Vec<D, Lanes> r = separation(law, pair.d);
  Lanes q = cut_distance(r);
  if constexpr (!whole) q = first_lanes(count, q, 1.0);  // lanes behind the row: as beyond the cutoff
  const PairResult<D, Lanes> given = fluid_pair<Kernel, transport>(law, pair, r, q, beta(r));
  for (int axis = 0; axis < D; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const IntLanes impulse = lanes_first ? given.impulse[axis] : -given.impulse[axis];
    add_to<whole>(fields.impulse[a] + j, impulse, count);
    sums.impulse[axis] -= impulse;
    if constexpr (transport) {
      const IntLanes shift = lanes_first ? given.shift[axis] : -given.shift[axis];
      add_to<whole>(fields.shift[a] + j, shift, count);
      sums.shift[axis] -= shift;
    }
  }
  add_to<whole>(fields.density + j, given.density, count);
  sums.density += given.density;
}

}  // namespace detail

/// Pairs of `centre` with particles [begin, end): adds to their sums, and the opposite to `sums` of the centre.
template <class Kernel, bool transport, bool lanes_first, int D, class Beta>
MAPPM_INLINE void pair_row(const PairLaw<D>& law, const PairFields<D>& fields, const PairCentre<D>& centre,
                           std::size_t begin, std::size_t end, const Beta& beta, detail::LaneSums<D>& sums) {
  std::size_t j = begin;
  for (; j + lane_count <= end; j += lane_count)
    detail::pair_chunk<Kernel, transport, lanes_first, true>(law, fields, centre, j, lane_count, beta, sums);
  if (j < end)
    detail::pair_chunk<Kernel, transport, lanes_first, false>(law, fields, centre, j, static_cast<int>(end - j), beta,
                                                              sums);
}

template <int D>
NeighbourSums<D> total(const detail::LaneSums<D>& sums) {
  NeighbourSums<D> result;
  for (int axis = 0; axis < D; ++axis) {
    result.impulse[axis] = sum_of_lanes(sums.impulse[axis]);
    result.shift[axis] = sum_of_lanes(sums.shift[axis]);
  }
  result.density = sum_of_lanes(sums.density);
  return result;
}

}  // namespace mappm
