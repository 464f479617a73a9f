#include "parallel/fluid_pass.hpp"

#include <algorithm>

#ifdef MAPPM_FLOATING_SUMS
#include "parallel/floating_lanes.hpp"
#endif

namespace mappm {

template <int D, class Numbers>
void FluidPass<D, Numbers>::list(FluidParticles<D>& fluid, const CellGrid<D>& grid, const Region<D>& region,
                                 double reach, std::span<const std::uint32_t> foreign, bool apart) {
  blocks_.fill(model_, numbers_, fluid, grid);
  serves_on_ = reach > 1.0;
  lists_.make(blocks_, fluid, grid, region, reach, foreign, apart);
}

template <int D, class Numbers>
auto FluidPass<D, Numbers>::sum_inner_densities(const CellGrid<D>& grid) -> Sums<Stage::inner_densities> {
  sum_densities(PairLists<D, Numbers>::inner, grid);
  return Sums<Stage::inner_densities>(*this);
}

template <int D, class Numbers>
void FluidPass<D, Numbers>::refill_foreign(FluidParticles<D>& fluid) {
  blocks_.refill(numbers_, fluid, [&](std::uint32_t block) { return lists_.is_foreign(block); });
}

template <int D, class Numbers>
void FluidPass<D, Numbers>::sum_densities(Part part, const CellGrid<D>& grid) {
  with_pair_law(model_, [&]<class Kernel>(Kernel, auto) {
    bands_.for_each(grid, [&](int, int, std::size_t thread, std::size_t band) {
      lists_.of(part, band).template sum_densities<Kernel>(numbers_, blocks_, scratch_[thread].squares);
    });
  });
}

template <int D, class Numbers>
void FluidPass<D, Numbers>::sum_forces(Part part, const CellGrid<D>& grid) {
  with_pair_law(model_, [&]<class Kernel, bool transport>(Kernel, std::bool_constant<transport>) {
    bands_.for_each(grid, [&](int, int, std::size_t thread, std::size_t band) {
      lists_.of(part, band).template sum<Kernel, transport>(numbers_, blocks_, scratch_[thread].squares);
    });
  });
}

template <int D, class Numbers>
void FluidPass<D, Numbers>::close_densities(std::span<const std::uint32_t> others, std::span<double> density) {
  const auto blocks = static_cast<std::uint32_t>(blocks_.size());
#pragma omp parallel for num_threads(static_cast <int>(bands_.threads())) schedule(static) if (bands_.threads() > 1)
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
#pragma omp parallel for num_threads(static_cast <int>(bands_.threads())) \
    schedule(static) if (bands_.threads() > 1 && !foreign_alone)
  for (std::uint32_t block = 0; block < blocks; ++block) {
    if (foreign_alone && !lists_.is_foreign(block)) continue;
    const auto [first, count] = blocks_.held(block);
    std::uint32_t lane = 0;
    for (; lane + lane_count <= count; lane += lane_count)
      blocks_.set_density(model_, block * lanes + lane, load_lanes(&density[first + lane]));
    for (; lane < count; ++lane) blocks_.set_density(model_, block * lanes + lane, density[first + lane]);
  }
}

/// Calls work(lists) with the PPs near some FPs, for all of them.
template <int D, class Numbers>
template <class Work>
void FluidPass<D, Numbers>::for_each_frozen_list(const CellGrid<D>& grid, const std::vector<FrozenInStep<D>>& frozen,
                                                 Work&& work) {
  if (frozen.empty()) return;
  const std::vector<std::vector<std::uint32_t>> by_plane = frozen_by_plane(grid, frozen);
  const std::vector<Vec<D, int>> rows = row_offsets(grid, false);
  bands_.for_each(grid, [&](int first, int last, std::size_t thread, std::size_t) {
    for (int plane = first; plane < last; ++plane)
      scratch_[thread].frozen.for_each_list(numbers_, blocks_, grid, rows, frozen,
                                            by_plane[static_cast<std::size_t>(plane)], work);
  });
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
void FluidPass<D, Numbers>::add_frozen_forces(const CellGrid<D>& grid, const std::vector<FrozenInStep<D>>& frozen,
                                              std::vector<NeighbourSums<D>>& frozen_sums) {
  frozen_sums.assign(frozen.size(), {});
  with_pair_law(model_, [&]<class Kernel, bool transport>(Kernel, std::bool_constant<transport>) {
    for_each_frozen_list(grid, frozen, [&](Lists& lists) {
      sum_lists<Kernel, transport, true>(
          numbers_, blocks_.data(), lists, [&](std::uint32_t k) { return centre_of<D>(numbers_, frozen[k]); },
          [&](std::uint32_t k) { return NoSlipFactor<D, typename Numbers::Real>(model_, frozen[k]); },
          [&](std::uint32_t k, const auto& sums) { frozen_sums[k] = numbers_.sums(sums); });
    });
  });
}

std::optional<std::uint32_t> find_out_of_range(std::span<const double> density, double rest_density) {
  const auto wrong = std::ranges::find_if(density, [&](double rho) { return !is_in_range(rho, rest_density); });
  if (wrong == density.end()) return std::nullopt;
  return static_cast<std::uint32_t>(wrong - density.begin());
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
