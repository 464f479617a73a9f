#include "parallel/fluid_pass.hpp"

#include <algorithm>
#include <cmath>

namespace mappm {

namespace {

/// Sums of an owned or ghost PP as the centre of a row, added to the field arrays.
template <int D>
void add_to_fields(const PairFields<D>& fields, std::size_t i, const NeighbourSums<D>& sums, bool transport) {
  for (int axis = 0; axis < D; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    fields.impulse[a][i] += sums.impulse[axis];
    if (transport) fields.shift[a][i] += sums.shift[axis];
  }
  fields.density[i] += sums.density;
}

template <class T>
void fit(std::vector<T>& values, std::size_t count) {
  reserve_tightly(values, count);
  values.resize(count);
}

void clear(std::vector<std::int64_t>& sums, std::size_t count) {
  reserve_tightly(sums, count);
  sums.assign(count, 0);
}

struct UnitFactor {
  template <int D>
  Lanes operator()(const Vec<D, Lanes>&) const {
    return Lanes(1.0);
  }
};

/// beta of the pairs of one FP.
template <int D>
struct NoSlipFactor {
  const Model<D>& model;
  const FrozenInStep<D>& fp;
  Lanes operator()(const Vec<D, Lanes>& r) const {
    if (!model.terms.extrapolated) return Lanes(1.0);
    Vec<D, Lanes> normal;
    for (int axis = 0; axis < D; ++axis) normal[axis] = Lanes(fp.place.normal[axis]);
    return no_slip_factor(r, normal, Lanes(fp.depth), model.no_slip_nearest);
  }
};

}  // namespace

template <int D>
NeighbourSums<D> FluidPass<D>::sums(std::size_t i) const {
  NeighbourSums<D> result;
  for (int axis = 0; axis < D; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    result.impulse[axis] = impulse_[a][i];
    result.shift[axis] = model_.terms.transport ? shift_[a][i] : 0;
  }
  result.density = density_[i];
  return result;
}

template <int D>
void FluidPass<D>::prepare(FluidParticles<D>& fluid) {
  const std::size_t count = fluid.size(), padded = count + lane_count;
  for (auto& values : fluid.field) {
    // Whole lanes are read behind the last particle. They count as beyond the cutoff, but 0 times NaN would not be 0.
    reserve_tightly(values, padded);
    values.resize(padded, 0.0);
    values.resize(count);
  }
  fit(v2_, padded);
  fit(pv2_, padded);
  for (std::size_t i = 0; i < count; ++i) {
    const auto volume = volume_terms(fluid.density()[i], model_.rest_density, 1.0, model_.background);
    v2_[i] = volume.v2;
    pv2_[i] = volume.pv2;
  }
  for (int axis = 0; axis < D; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    clear(impulse_[a], padded);
    if (model_.terms.transport) clear(shift_[a], padded);
  }
  clear(density_, padded);
}

template <int D>
PairFields<D> FluidPass<D>::fields(const FluidParticles<D>& fluid) {
  PairFields<D> fields;
  for (int axis = 0; axis < D; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    fields.x[a] = fluid.x(axis).data();
    fields.v[a] = fluid.v(axis).data();
    fields.impulse[a] = impulse_[a].data();
    fields.shift[a] = shift_[a].data();
  }
  fields.v2 = v2_.data();
  fields.pv2 = pv2_.data();
  fields.density = density_.data();
  return fields;
}

template <int D>
PairCentre<D> FluidPass<D>::centre(const FluidParticles<D>& fluid, std::size_t i) const {
  PairCentre<D> centre;
  for (int axis = 0; axis < D; ++axis) {
    centre.x[axis] = fluid.x(axis)[i];
    centre.v[axis] = fluid.v(axis)[i];
  }
  centre.volume = {v2_[i], pv2_[i]};
  return centre;
}

/// Rows (cells that differ only in x) within the cutoff. `half`: only rows after the own one in memory, and itself.
template <int D>
auto FluidPass<D>::rows_within_cutoff(const CellGrid<D>& grid, bool half) const -> std::vector<RowOffset> {
  std::vector<RowOffset> rows;
  const int k = grid.margin();
  const int slow = D == 3 ? k : 0;
  for (int dz = half ? 0 : -slow; dz <= slow; ++dz)
    for (int dy = half && dz == 0 ? 0 : -k; dy <= k; ++dy) {
      RowOffset row;
      row.cell[1] = dy;
      if constexpr (D == 3) row.cell[2] = dz;
      double square = 1.0;  // of the largest distance along x at which a pair can be within the cutoff
      for (int axis = 1; axis < D; ++axis) {
        const double gap = std::max(0, std::abs(row.cell[axis]) - 1) * grid.width(axis);
        square -= gap * gap;
      }
      if (square <= 0.0) continue;
      row.reach = static_cast<int>(std::ceil(std::sqrt(square) / grid.width(0)));
      rows.push_back(row);
    }
  return rows;
}

/// Calls work(first, last) for bands of planes (cells with one coordinate on the slowest axis). A band writes at most
/// `margin` planes beyond itself, so bands of one parity, each two margins high, run side by side.
template <int D>
template <class Work>
void FluidPass<D>::for_each_band(const CellGrid<D>& grid, Work&& work) const {
  const int planes = grid.count(D - 1);
  if (threads_ == 1) return work(0, planes);
  const int height = std::max(2 * grid.margin(), planes / (4 * threads_) + 1);
  const int bands = (planes + height - 1) / height;
  for (int parity = 0; parity < 2; ++parity) {
#pragma omp parallel for num_threads(threads_) schedule(dynamic)
    for (int band = parity; band < bands; band += 2) work(band * height, std::min(planes, (band + 1) * height));
  }
}

template <int D>
template <class Work>
void FluidPass<D>::for_each_row(const CellGrid<D>& grid, int first_plane, int last_plane, Work&& work) const {
  Vec<D, int> row;
  for (row[D - 1] = first_plane; row[D - 1] < last_plane; ++row[D - 1]) {
    if constexpr (D == 2)
      work(row);
    else
      for (row[1] = 0; row[1] < grid.count(1); ++row[1]) work(row);
  }
}

template <int D>
void FluidPass<D>::sum(FluidParticles<D>& fluid, const CellGrid<D>& grid, const std::vector<FrozenInStep<D>>& frozen,
                       std::vector<NeighbourSums<D>>& frozen_sums) {
  prepare(fluid);
  half_rows_ = rows_within_cutoff(grid, true);
  all_rows_ = rows_within_cutoff(grid, false);
  const PairFields<D> arrays = fields(fluid);
  with_pair_law(model_, [&]<class Kernel, bool transport>(Kernel, std::bool_constant<transport>) {
    for_each_band(grid, [&](int first, int last) {
      for_each_row(grid, first, last,
                   [&](const Vec<D, int>& row) { sum_row<Kernel, transport>(fluid, grid, arrays, row); });
    });
    frozen_sums.assign(frozen.size(), {});
    std::vector<std::vector<std::uint32_t>> by_plane(static_cast<std::size_t>(grid.count(D - 1)));
    for (std::uint32_t k = 0; k < frozen.size(); ++k)
      by_plane[static_cast<std::size_t>(grid.coordinate(D - 1, frozen[k].place.x[D - 1]))].push_back(k);
    for_each_band(grid, [&](int first, int last) {
      for (int plane = first; plane < last; ++plane)
        for (const std::uint32_t k : by_plane[static_cast<std::size_t>(plane)])
          sum_frozen<Kernel, transport>(grid, arrays, frozen[k], frozen_sums[k]);
    });
  });
}

/// All pairs of PPs whose first one lies in this row: calls work(i, for_each_range) for each particle i of the row, in
/// which for_each_range(pair_with) calls pair_with(first, last) for its ranges of partners. A pair of two ghosts is
/// left out.
template <int D>
template <class Work>
void FluidPass<D>::for_each_centre(const CellGrid<D>& grid, const Vec<D, int>& row, Work&& work) const {
  const auto is_inner_row = [&](const Vec<D, int>& at) {
    for (int axis = 1; axis < D; ++axis)
      if (!grid.is_inner(axis, at[axis])) return false;
    return true;
  };
  const int inner_first = grid.margin(), inner_last = grid.margin() + grid.inner(0) - 1;
  const bool inner_row = is_inner_row(row);
  const std::size_t own_row = grid.row(row);
  std::array<std::pair<std::uint32_t, std::uint32_t>, 64> range;
  for (int cell = 0; cell < grid.count(0); ++cell) {
    const std::uint32_t begin = grid.start(own_row + static_cast<std::size_t>(cell));
    const std::uint32_t end = grid.start(own_row + static_cast<std::size_t>(cell) + 1);
    if (begin == end) continue;
    const bool ghost = !inner_row || !grid.is_inner(0, cell);
    std::size_t ranges = 0;
    for (const RowOffset& offset : half_rows_) {
      const Vec<D, int> other = row + offset.cell;
      bool inside = true;
      for (int axis = 1; axis < D; ++axis) inside = inside && other[axis] >= 0 && other[axis] < grid.count(axis);
      if (!inside || (ghost && !is_inner_row(other))) continue;
      const bool same_row = &offset == &half_rows_.front();
      const int first = same_row ? cell : std::max(cell - offset.reach, ghost ? inner_first : 0);
      const int last = std::min(cell + offset.reach, ghost ? inner_last : grid.count(0) - 1);
      const std::size_t cells = grid.row(other);
      range[ranges++] = {grid.start(cells + static_cast<std::size_t>(std::max(first, ghost ? inner_first : 0))),
                         last < first ? 0u : grid.start(cells + static_cast<std::size_t>(last) + 1)};
      if (same_row) range[ranges - 1].first = std::max(range[ranges - 1].first, begin);
    }
    for (std::uint32_t i = begin; i < end; ++i)
      work(
          i, [&](auto&& pair_with) __attribute__((always_inline)) {
            for (std::size_t n = 0; n < ranges; ++n) {
              const std::uint32_t first = range[n].first <= i && i < range[n].second ? i + 1 : range[n].first;
              if (first < range[n].second) pair_with(first, range[n].second);
            }
          });
  }
}

template <int D>
template <class Kernel, bool transport>
void FluidPass<D>::sum_row(const FluidParticles<D>& fluid, const CellGrid<D>& grid, const PairFields<D>& fields,
                           const Vec<D, int>& row) {
  // A call for each particle and range would cost a tenth of the pass, and the compiler would choose it.
  for_each_centre(
      grid, row, [&](std::uint32_t i, const auto& for_each_range_of_i) __attribute__((always_inline)) {
        detail::LaneSums<D> sums{};
        const PairCentre<D> particle = centre(fluid, i);
        for_each_range_of_i([&](std::uint32_t first, std::uint32_t last) __attribute__((always_inline)) {
          pair_row<Kernel, transport, false>(model_.pair, fields, particle, first, last, UnitFactor{}, sums);
        });
        add_to_fields(fields, i, total(sums), transport);
      });
}

/// Calls pair_with(first, last) for the ranges of PPs near one FP.
template <int D>
template <class PairWith>
void FluidPass<D>::for_each_range(const CellGrid<D>& grid, const FrozenInStep<D>& fp, PairWith&& pair_with) const {
  Vec<D, int> cell;
  for (int axis = 0; axis < D; ++axis) cell[axis] = grid.coordinate(axis, fp.place.x[axis]);
  for (const RowOffset& offset : all_rows_) {
    const Vec<D, int> other = cell + offset.cell;
    bool inside = true;
    for (int axis = 1; axis < D; ++axis) inside = inside && other[axis] >= 0 && other[axis] < grid.count(axis);
    if (!inside) continue;
    const std::size_t cells = grid.row(other);
    const int first = std::max(cell[0] - offset.reach, 0);
    const int last = std::min(cell[0] + offset.reach, grid.count(0) - 1);
    const std::uint32_t begin = grid.start(cells + static_cast<std::size_t>(first));
    const std::uint32_t end = grid.start(cells + static_cast<std::size_t>(last) + 1);
    if (begin < end) pair_with(begin, end);
  }
}

/// All PPs near one FP; r of the law points from the FP to the PP.
template <int D>
template <class Kernel, bool transport>
void FluidPass<D>::sum_frozen(const CellGrid<D>& grid, const PairFields<D>& fields, const FrozenInStep<D>& fp,
                              NeighbourSums<D>& sums) const {
  const PairCentre<D> particle{fp.place.x, fp.place.v, fp.volume};
  const NoSlipFactor<D> beta{model_, fp};
  detail::LaneSums<D> lanes{};
  for_each_range(grid, fp, [&](std::uint32_t begin, std::uint32_t end) {
    pair_row<Kernel, transport, true>(model_.pair, fields, particle, begin, end, beta, lanes);
  });
  sums = total(lanes);
}

/// One pair as the pass would compute it, alone: what it adds to the centre and to particle j.
template <int D>
template <class Kernel, bool transport, bool lanes_first, class Beta>
auto FluidPass<D>::sums_of_pair(const FluidParticles<D>& fluid, const PairCentre<D>& centre, std::uint32_t j,
                                const Beta& beta) -> PairSums {
  for (int axis = 0; axis < D; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    impulse_[a][j] = 0;
    if constexpr (transport) shift_[a][j] = 0;
  }
  density_[j] = 0;
  detail::LaneSums<D> lanes{};
  pair_row<Kernel, transport, lanes_first>(model_.pair, fields(fluid), centre, j, j + 1, beta, lanes);
  return {total(lanes), sums(j)};
}

template <int D>
std::optional<std::vector<PartnerTrace<D>>> FluidPass<D>::trace(const FluidParticles<D>& fluid, const CellGrid<D>& grid,
                                                                const std::vector<FrozenInStep<D>>& frozen,
                                                                std::uint64_t particle) const {
  std::vector<PartnerTrace<D>> partners;
  const auto keep = [&](const PartnerTrace<D>& partner) {
    if (partner.any()) partners.push_back(partner);
  };
  const auto is_owned = [&](std::size_t i) {
    for (int axis = 0; axis < D; ++axis)
      if (!grid.is_inner(axis, grid.coordinate(axis, fluid.x(axis)[i]))) return false;
    return true;
  };
  std::uint32_t traced = 0;
  while (traced < fluid.size() && !(fluid.id[traced] == particle && is_owned(traced))) ++traced;
  if (traced == fluid.size()) return std::nullopt;
  FluidPass<D> alone = *this;  // sums elsewhere
  with_pair_law(model_, [&]<class Kernel, bool transport>(Kernel, std::bool_constant<transport>) {
    const auto fluid_pair_sums = [&](std::uint32_t i, std::uint32_t j) {
      return alone.sums_of_pair<Kernel, transport, false>(fluid, centre(fluid, i), j, UnitFactor{});
    };
    for_each_row(grid, 0, grid.count(D - 1), [&](const Vec<D, int>& row) {
      for_each_centre(grid, row, [&](std::uint32_t i, const auto& for_each_range_of_i) {
        for_each_range_of_i([&](std::uint32_t first, std::uint32_t last) {
          for (std::uint32_t j = first; i == traced && j < last; ++j)
            keep({false, fluid.id[j], 0, fluid_pair_sums(i, j).centre});
          if (first <= traced && traced < last) keep({false, fluid.id[i], 0, fluid_pair_sums(i, traced).other});
        });
      });
    });
    for (const FrozenInStep<D>& fp : frozen)
      for_each_range(grid, fp, [&](std::uint32_t first, std::uint32_t last) {
        if (traced < first || last <= traced) return;
        const PairCentre<D> centre_of_fp{fp.place.x, fp.place.v, fp.volume};
        const NoSlipFactor<D> beta{model_, fp};
        keep({true, fp.solid, fp.index,
              alone.sums_of_pair<Kernel, transport, true>(fluid, centre_of_fp, traced, beta).other});
      });
  });
  return partners;
}

template class FluidPass<2>;
template class FluidPass<3>;

}  // namespace mappm
