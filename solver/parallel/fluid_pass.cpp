#include "parallel/fluid_pass.hpp"

#include <omp.h>

#include <algorithm>
#include <array>
#include <limits>

#ifdef MAPPM_FLOATING_SUMS
#include "parallel/floating_lanes.hpp"
#endif

namespace mappm {

template <int D, class Numbers>
MAPPM_INLINE PairCentre<D, Numbers> FluidPass<D, Numbers>::centre(const FrozenInStep<D>& fp) const {
  using Real = typename Numbers::Real;
  Centre centre;
  for (int axis = 0; axis < D; ++axis) {
    centre.x[axis] = numbers_.coordinate(axis, fp.place.x[axis]);
    centre.v[axis] = static_cast<Real>(fp.place.v[axis]);
  }
  centre.volume = {static_cast<Real>(fp.volume.v2), static_cast<Real>(fp.volume.pv2)};
  return centre;
}

template <int D, class Numbers>
int FluidPass<D, Numbers>::band_height(const CellGrid<D>& grid) const {
  const int planes = grid.count(D - 1);
  return threads_ == 1 ? planes : std::max(2 * grid.margin(D - 1), planes / (4 * threads_) + 1);
}

/// Calls work(first, last, search, band) for bands of planes (cells with one coordinate on the slowest axis). What a
/// band writes lies at most `margin` planes beyond itself, so bands of one parity, each two margins high, run side by
/// side.
template <int D, class Numbers>
template <class Work>
void FluidPass<D, Numbers>::for_each_band(const CellGrid<D>& grid, Work&& work) {
  const int planes = grid.count(D - 1), height = band_height(grid), bands = (planes + height - 1) / height;
  searches_.resize(static_cast<std::size_t>(threads_));
  for (int parity = 0; parity < std::min(bands, 2); ++parity) {
#pragma omp parallel for num_threads(threads_) schedule(dynamic) if (threads_ > 1)
    for (int band = parity; band < bands; band += 2)
      work(band * height, std::min(planes, (band + 1) * height),
           searches_[static_cast<std::size_t>(omp_get_thread_num())], static_cast<std::size_t>(band));
  }
}

template <int D, class Numbers>
template <class Work>
void FluidPass<D, Numbers>::for_each_row(const CellGrid<D>& grid, int first_plane, int last_plane, Work&& work) const {
  Vec<D, int> row;
  if constexpr (D == 2) {
    for (row[1] = first_plane; row[1] < last_plane; ++row[1]) work(row);
  } else {
    // In blocks, of which the planes with partners fit a core's own cache.
    constexpr int block = 4;
    for (int first = 0; first < grid.count(1); first += block)
      for (row[2] = first_plane; row[2] < last_plane; ++row[2])
        for (row[1] = first; row[1] < std::min(first + block, grid.count(1)); ++row[1]) work(row);
  }
}

/// Indices of the FPs in each plane of cells, ordered by rows.
template <int D>
std::vector<std::vector<std::uint32_t>> frozen_by_plane(const CellGrid<D>& grid,
                                                        const std::vector<FrozenInStep<D>>& frozen) {
  std::vector<std::vector<std::uint32_t>> by_plane(static_cast<std::size_t>(grid.count(D - 1)));
  for (std::uint32_t k = 0; k < frozen.size(); ++k)
    by_plane[static_cast<std::size_t>(grid.coordinate(D - 1, frozen[k].place.x[D - 1]))].push_back(k);
  if constexpr (D == 3)
    for (auto& plane : by_plane)
      std::ranges::sort(plane, {}, [&](std::uint32_t k) { return grid.coordinate(1, frozen[k].place.x[1]); });
  return by_plane;
}

template <int D, class Numbers>
void FluidPass<D, Numbers>::list(FluidParticles<D>& fluid, const CellGrid<D>& grid, const Region<D>& region,
                                 double reach, std::span<const std::uint32_t> foreign, bool apart) {
  blocks_.fill(model_, numbers_, fluid, grid);
  serves_on_ = reach > 1.0;
  half_rows_ = row_offsets(grid, true);
  all_rows_ = row_offsets(grid, false);
  for (Search& search : searches_) search.measured = 0;
  foreign_.assign(blocks_.size(), 0);
  for (const std::uint32_t i : foreign) foreign_[blocks_.slot(i) / lanes] = 1;
  find_boxes(fluid);
  const std::vector<std::uint8_t> inside = slots_in(fluid, region);  // of each slot
  std::vector<std::uint8_t> reaches_inside(blocks_.size());          // of each block
  for (std::size_t block = 0; block < blocks_.size(); ++block)
    reaches_inside[block] = std::ranges::max(std::span(inside).subspan(block * lanes, lanes));
  const std::vector<std::uint8_t> wide = wide_blocks(fluid);
  const int height = band_height(grid);
  kept_.resize(parts * static_cast<std::size_t>((grid.count(D - 1) + height - 1) / height));
  for_each_band(grid, [&](int first, int last, Search& search, std::size_t band) {
    for (const Part part : {inner, rest}) kept_[parts * band + part].clear();
    for_each_row(grid, first, last, [&](const Vec<D, int>& row) {
      for_each_block_list(
          fluid, grid, row, reach, search, [&](std::uint32_t slot, std::span<const std::uint32_t> near) {
            const auto is_foreign = [&](std::uint32_t other) { return foreign_[other] != 0; };
            const bool alone = apart && foreign_[slot / lanes] == 0 && std::ranges::none_of(near, is_foreign);
            const bool all = inside[slot] != 0;
            const auto is_wide = [&](std::uint32_t other) { return wide[other] != 0 || wide[slot / lanes] != 0; };
            kept_[parts * band + (alone ? inner : rest)].add(
                slot, near, [&](std::uint32_t other) { return all || reaches_inside[other] != 0; }, is_wide,
                [&](std::uint32_t other) { return lanes_near(fluid, slot, other); });
          });
    });
    for (const Part part : {inner, rest}) blocks_.count_contributions(kept_[parts * band + part].blocks());
  });
}

/// The least box around the PPs of each block, rcut.
template <int D, class Numbers>
void FluidPass<D, Numbers>::find_boxes(const FluidParticles<D>& fluid) {
  for (int axis = 0; axis < D; ++axis) {
    Column<double>&low = box_low_[axis], &high = box_high_[axis];
    low.resize(blocks_.size());
    high.resize(blocks_.size());
    for (std::uint32_t block = 0; block < blocks_.size(); ++block) {
      const auto first = fluid.x(axis).begin() + blocks_.held(block).first;
      const auto [least, most] = std::minmax_element(first, first + blocks_.held(block).count);
      low[block] = *least * model_.pair.length[axis];
      high[block] = *most * model_.pair.length[axis];
    }
  }
}

/// Calls work(slot, blocks) for the PPs of this row: the blocks of later slots whose boxes come within the reach
/// (rcut), in rising order.
template <int D, class Numbers>
template <class Work>
void FluidPass<D, Numbers>::for_each_block_list(const FluidParticles<D>& fluid, const CellGrid<D>& grid,
                                                const Vec<D, int>& row, double reach, Search& search, Work&& work) {
  const std::size_t cells = grid.row(row);
  const std::uint32_t gap = blocks_.gap(row[D - 1]);
  const std::uint32_t begin = grid.start(cells) + gap;
  const std::uint32_t end = grid.start(cells + static_cast<std::size_t>(grid.count(0))) + gap;
  if (begin == end) return;
  search.near.fit(grid, blocks_, half_rows_, row, false);
  const double square_of_reach = reach * reach * (1.0 + 1e-6);  // rounding hides no pair
  for (std::uint32_t block_of_centres = begin / lanes; block_of_centres * lanes < end; ++block_of_centres) {
    const std::uint32_t first = std::max(begin, block_of_centres * lanes),
                        last = std::min(end, (block_of_centres + 1) * lanes);
    Region<D> box;
    for (int axis = 0; axis < D; ++axis) {
      const auto x = fluid.x(axis).begin();
      const auto [low, high] = std::minmax_element(x + (first - gap), x + (last - gap));
      box.low[axis] = *low;
      box.high[axis] = *high;
    }
    search.near.find(grid, box);
    Candidates<D>& candidates = search.candidates;
    std::uint32_t count = 0, next = block_of_centres + 1;  // a block on the border of two rows is found in both
    for (std::size_t n = 0; n < search.near.count(); ++n) {
      const auto range = search.near.range(grid, n);
      const std::uint32_t from = std::max(next, range.first / lanes), to = (range.end + lanes - 1) / lanes;
      if (range.end <= range.first || to <= from) continue;
      candidates.make_room(count + to - from);
      for (std::uint32_t block = from; block < to; ++block, ++count) {
        candidates.block[count] = block;
        for (int axis = 0; axis < D; ++axis) {
          candidates.low[axis][count] = box_low_[axis][block];
          candidates.high[axis][count] = box_high_[axis][block];
        }
      }
      next = to;
    }
    candidates.end(count);
    search.measured += std::uint64_t{count} * (last - first);
    if (search.found.size() < count + 1 + lane_count) search.found.resize(count + 1 + lane_count);
    for (std::uint32_t slot = first; slot < last; ++slot) {
      Vec<D, Lanes> x;
      for (int axis = 0; axis < D; ++axis) x[axis] = fluid.x(axis)[slot - gap] * model_.pair.length[axis];
      std::uint32_t* const found = search.found.data();
      std::uint32_t near = 0;
      if (slot % lanes + 1 < blocks_.held(block_of_centres).count) found[near++] = block_of_centres;
      for (std::uint32_t n = 0; n < count; n += lane_count) {
        Lanes square = 0.0;
        for (int axis = 0; axis < D; ++axis) {
          const Lanes low = load_lanes(&candidates.low[axis][n]), high = load_lanes(&candidates.high[axis][n]);
          const Lanes beside = larger(larger(low - x[axis], x[axis] - high), Lanes(0.0));
          square += beside * beside;
        }
        near += store_chosen(square < square_of_reach, &candidates.block[n], found + near);
      }
      work(slot, std::span<const std::uint32_t>(found, near));
    }
  }
}

/// The lanes of a block that are PPs near the one at a slot, and do not only seem so: one a bit.
template <int D, class Numbers>
std::uint16_t FluidPass<D, Numbers>::lanes_near(const FluidParticles<D>& fluid, std::uint32_t slot,
                                                std::uint32_t block) const {
  const Vec<D, double> x = fluid.position(blocks_.held(slot / lanes).first + slot % lanes);
  const auto& held = blocks_.held(block);
  unsigned near = 0;
  for (std::uint32_t lane = 0; lane < held.count; ++lane) {
    const Vec<D, double> d = separation(model_.pair, fluid.position(held.first + lane) - x);
    bool apart = true;
    for (int axis = 0; axis < D; ++axis) apart = apart && std::fabs(d[axis]) <= Numbers::largest_extent;
    near |= apart ? 1u << lane : 0u;
  }
  return static_cast<std::uint16_t>(near);
}

template <int D, class Numbers>
void FluidPass<D, Numbers>::sum_rest_densities(FluidParticles<D>& fluid, const CellGrid<D>& grid) {
  blocks_.refill(numbers_, fluid, [&](std::uint32_t block) { return foreign_[block] != 0; });
  sum_densities_of(rest, grid);
}

template <int D, class Numbers>
void FluidPass<D, Numbers>::sum_densities_of(Part part, const CellGrid<D>& grid) {
  with_pair_law(model_, [&]<class Kernel>(Kernel, auto) {
    for_each_band(grid, [&](int, int, Search& search, std::size_t band) {
      kept_[parts * band + part].template sum_densities<Kernel>(numbers_, blocks_, search.squares);
    });
  });
}

template <int D, class Numbers>
void FluidPass<D, Numbers>::sum_forces_of(Part part, const CellGrid<D>& grid) {
  with_pair_law(model_, [&]<class Kernel, bool transport>(Kernel, std::bool_constant<transport>) {
    for_each_band(grid, [&](int, int, Search& search, std::size_t band) {
      kept_[parts * band + part].template sum<Kernel, transport>(numbers_, blocks_, search.squares);
    });
  });
}

template <int D, class Numbers>
std::optional<std::uint32_t> FluidPass<D, Numbers>::close_densities(std::span<const std::uint32_t> others,
                                                                    std::span<double> density) {
  const auto blocks = static_cast<std::uint32_t>(blocks_.size());
#pragma omp parallel for num_threads(threads_) schedule(static) if (threads_ > 1)
  for (std::uint32_t block = 0; block < blocks; ++block) {
    const auto [first, count] = blocks_.held(block);
    std::uint32_t lane = 0;
    for (; lane + lane_count <= count; lane += lane_count)
      store_lanes(summed_density(numbers_.density(blocks_.density_of_lanes(block * lanes + lane)), model_.self_density),
                  &density[first + lane]);
    for (; lane < count; ++lane)
      density[first + lane] = summed_density(
          static_cast<std::int64_t>(numbers_.density(blocks_.density(block * lanes + lane))), model_.self_density);
  }
  for (const std::uint32_t i : others) density[i] = model_.rest_density;
  set_densities<false>(density);
  const auto wrong = std::ranges::find_if(density, [&](double rho) { return !is_in_range(rho, model_.rest_density); });
  if (wrong == density.end()) return std::nullopt;
  return static_cast<std::uint32_t>(wrong - density.begin());
}

template <int D, class Numbers>
void FluidPass<D, Numbers>::take_densities(std::span<const double> density) {
  set_densities<true>(density);
}

/// Volumes of all PPs, or of those in blocks that hold a foreign one. Lanes of gaps keep theirs.
template <int D, class Numbers>
template <bool foreign_alone>
void FluidPass<D, Numbers>::set_densities(std::span<const double> density) {
  const auto blocks = static_cast<std::uint32_t>(blocks_.size());
#pragma omp parallel for num_threads(threads_) schedule(static) if (threads_ > 1 && !foreign_alone)
  for (std::uint32_t block = 0; block < blocks; ++block) {
    if (foreign_alone && foreign_[block] == 0) continue;
    const auto [first, count] = blocks_.held(block);
    std::uint32_t lane = 0;
    for (; lane + lane_count <= count; lane += lane_count)
      blocks_.set_density(model_, block * lanes + lane, load_lanes(&density[first + lane]));
    for (; lane < count; ++lane) blocks_.set_density(model_, block * lanes + lane, density[first + lane]);
  }
}

/// Whether each block is so wide, or has lanes of a gap, that its lanes must be named; empty where none need be.
template <int D, class Numbers>
std::vector<std::uint8_t> FluidPass<D, Numbers>::wide_blocks(const FluidParticles<D>& fluid) const {
  if (Numbers::largest_extent == std::numeric_limits<double>::infinity()) return {};
  std::vector<std::uint8_t> wide(blocks_.size(), 0);
  for (std::uint32_t block = 0; block < blocks_.size(); ++block) {
    const auto& held = blocks_.held(block);
    if (held.count < lanes) wide[block] = 1;
    for (int axis = 0; axis < D; ++axis) {
      const auto first = fluid.x(axis).begin() + held.first;
      const auto [least, most] = std::minmax_element(first, first + held.count);
      if ((*most - *least) * model_.pair.length[axis] > Numbers::largest_extent) wide[block] = 1;
    }
  }
  return wide;
}

/// Whether each slot holds a PP in `region`.
template <int D, class Numbers>
std::vector<std::uint8_t> FluidPass<D, Numbers>::slots_in(const FluidParticles<D>& fluid,
                                                          const Region<D>& region) const {
  std::vector<std::uint8_t> inside(blocks_.size() * lanes, 0);
  for (std::uint32_t block = 0; block < blocks_.size(); ++block)
    for (std::uint32_t lane = 0; lane < blocks_.held(block).count; ++lane)
      inside[block * lanes + lane] = region.contains(fluid.position(blocks_.held(block).first + lane)) ? 1 : 0;
  return inside;
}

template <int D, class Numbers>
void FluidPass<D, Numbers>::add_frozen_densities(const CellGrid<D>& grid, const std::vector<FrozenInStep<D>>& frozen,
                                                 std::vector<std::int64_t>& sums) {
  sums.assign(frozen.size(), 0);
  with_pair_law(model_, [&]<class Kernel>(Kernel, auto) {
    for_each_frozen_list(grid, frozen, [&](Lists& lists) {
      sum_densities_of_lists<Kernel, true>(numbers_, blocks_.data(), lists, [&](std::uint32_t k, auto sum) {
        sums[k] = static_cast<std::int64_t>(numbers_.density(sum));
      });
    });
  });
}

/// r of the law points from the FP to the PP.
template <int D, class Numbers>
void FluidPass<D, Numbers>::add_frozen(const CellGrid<D>& grid, const std::vector<FrozenInStep<D>>& frozen,
                                       std::vector<NeighbourSums<D>>& frozen_sums) {
  frozen_sums.assign(frozen.size(), {});
  with_pair_law(model_, [&]<class Kernel, bool transport>(Kernel, std::bool_constant<transport>) {
    for_each_frozen_list(grid, frozen, [&](Lists& lists) {
      sum_lists<Kernel, transport, true>(
          numbers_, blocks_.data(), lists, [&](std::uint32_t k) { return centre(frozen[k]); },
          [&](std::uint32_t k) { return NoSlipFactor<D, typename Numbers::Real>(model_, frozen[k]); },
          [&](std::uint32_t k, const auto& sums) { frozen_sums[k] = numbers_.sums(sums); });
    });
  });
}

/// Calls work(lists) with the PPs near some FPs, for all of them.
template <int D, class Numbers>
template <class Work>
void FluidPass<D, Numbers>::for_each_frozen_list(const CellGrid<D>& grid, const std::vector<FrozenInStep<D>>& frozen,
                                                 Work&& work) {
  if (frozen.empty()) return;
  const std::vector<std::vector<std::uint32_t>> by_plane = frozen_by_plane(grid, frozen);
  for_each_band(grid, [&](int first, int last, Search& search, std::size_t) {
    for (int plane = first; plane < last; ++plane)
      for_each_frozen_list(grid, frozen, by_plane[static_cast<std::size_t>(plane)], search, work);
  });
}

/// FPs of a plane of cells, ordered by rows: calls work(lists) with the PPs near some of them.
template <int D, class Numbers>
template <class Work>
void FluidPass<D, Numbers>::for_each_frozen_list(const CellGrid<D>& grid, const std::vector<FrozenInStep<D>>& frozen,
                                                 std::span<const std::uint32_t> chosen, Search& search,
                                                 Work&& work) const {
  NearRows<D>& near = search.near;
  Lists& lists = search.lists;
  Vec<D, int> fitted{};
  for (std::size_t n = 0; n < chosen.size(); ++n) {
    const FrozenInStep<D>& fp = frozen[chosen[n]];
    Vec<D, int> row;
    for (int axis = 1; axis < D; ++axis) row[axis] = grid.coordinate(axis, fp.place.x[axis]);
    if (n == 0 || row != fitted) near.fit(grid, blocks_, all_rows_, row, false);
    fitted = row;
    near.find(grid, {fp.place.x, fp.place.x});
    lists.add(chosen[n], centre(fp).x, near.count(), [&](std::size_t other) { return near.range(grid, other); });
    if (!lists.is_full() && n + 1 < chosen.size()) continue;
    work(lists);
    lists.clear();
  }
}

/// One pair as the pass would compute it, alone: what it adds to the centre and to the PP at a slot.
template <int D, class Numbers>
template <class Kernel, bool transport, bool lanes_first, class Beta>
auto FluidPass<D, Numbers>::sums_of_pair(const Centre& centre, std::uint32_t slot, const Beta& beta) const -> PairSums {
  const std::uint32_t lane = slot % lanes;
  PairBlocks<D, Numbers> alone = blocks_.one(slot);
  Lists partner;
  partner.add(0, centre.x, 1, [&](std::size_t) { return typename NearRows<D>::Range{lane, lane + 1}; });
  PairSums result;
  sum_lists<Kernel, transport, lanes_first>(
      numbers_, alone.data(), partner, [&](std::uint32_t) { return centre; }, [&](std::uint32_t) { return beta; },
      [&](std::uint32_t, const auto& sums) { result.centre = numbers_.sums(sums); });
  result.other = numbers_.sums(alone.sums(lane));
  sum_densities_of_lists<Kernel, lanes_first>(numbers_, alone.data(), partner, [](std::uint32_t, auto) {});
  result.density = static_cast<std::int64_t>(numbers_.density(alone.density(lane)));
  return result;
}

template <int D, class Numbers>
std::optional<std::vector<PartnerTrace<D>>> FluidPass<D, Numbers>::trace(const FluidParticles<D>& fluid,
                                                                         const CellGrid<D>& grid,
                                                                         const std::vector<FrozenInStep<D>>& frozen,
                                                                         std::uint64_t particle) {
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
  const std::uint32_t slot = blocks_.slot(traced);
  constexpr std::uint64_t none = ~std::uint64_t{0};  // lanes of gaps
  std::vector<std::uint64_t> ids(blocks_.size() * lanes, none);
  for (std::uint32_t i = 0; i < fluid.size(); ++i) ids[blocks_.slot(i)] = fluid.id[i];
  Search search;
  with_pair_law(model_, [&]<class Kernel, bool transport>(Kernel, std::bool_constant<transport>) {
    for (const KeptLists<D, Numbers>& lists : kept_)
      lists.for_each_pair([&](std::uint32_t i, std::uint32_t j) {
        if ((i != slot && j != slot) || ids[j] == none) return;
        const PairSums sums = sums_of_pair<Kernel, transport, false>(blocks_.centre(i), j, UnitFactor{});
        keep({false, ids[i == slot ? j : i], 0, i == slot ? sums.centre : sums.other, sums.density});
      });
    for (const auto& plane : frozen_by_plane(grid, frozen))
      for_each_frozen_list(grid, frozen, plane, search, [&](const Lists& lists) {
        lists.for_each_partner([&](std::uint32_t k, std::uint32_t j) {
          const FrozenInStep<D>& fp = frozen[k];
          if (j != slot) return;
          const PairSums sums = sums_of_pair<Kernel, transport, true>(
              centre(fp), slot, NoSlipFactor<D, typename Numbers::Real>(model_, fp));
          keep({true, fp.solid, fp.index, sums.other, sums.density});
        });
      });
  });
  return partners;
}

template class FluidPass<2, DoubleLanes<2>>;
template class FluidPass<3, DoubleLanes<3>>;
template class FluidPass<2, SingleLanes<2>>;
template class FluidPass<3, SingleLanes<3>>;
#ifdef MAPPM_FLOATING_SUMS
template class FluidPass<2, FloatingLanes<2>>;
template class FluidPass<3, FloatingLanes<3>>;
#endif

}  // namespace mappm
