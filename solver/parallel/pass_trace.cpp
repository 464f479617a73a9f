#include "parallel/pass_trace.hpp"

namespace mappm {

namespace {

template <int D>
struct PairSums {
  NeighbourSums<D> centre, other;
  std::int64_t density;
};

/// One pair as the pass would compute it, alone: what it adds to the centre and to the PP at a slot.
template <class Kernel, bool transport, bool lanes_first, int D, class Numbers, class Beta>
PairSums<D> sums_of_pair(const FluidPass<D, Numbers>& pass, const PairCentre<D, Numbers>& centre, std::uint32_t slot,
                         const Beta& beta) {
  const Numbers& numbers = pass.numbers();
  const std::uint32_t lane = slot % block_lanes<Numbers>;
  PairBlocks<D, Numbers> alone = pass.blocks().one(slot);
  PartnerLists<D, Numbers> partner;
  partner.add(0, centre.x, 1, [&](std::size_t) { return typename NearRows<D>::Range{lane, lane + 1}; });
  PairSums<D> result;
  sum_lists<Kernel, transport, lanes_first>(
      numbers, alone.data(), partner, [&](std::uint32_t) { return centre; }, [&](std::uint32_t) { return beta; },
      [&](std::uint32_t, const auto& sums) { result.centre = numbers.sums(sums); });
  result.other = numbers.sums(alone.sums(lane));
  sum_densities_of_lists<Kernel, lanes_first>(numbers, alone.data(), partner, [](std::uint32_t, auto) {});
  result.density = static_cast<std::int64_t>(numbers.density(alone.density(lane)));
  return result;
}

/// The index of the PP with this id that lies in the region of the grid; the number of all where there is none.
template <int D>
std::uint32_t index_of(const FluidParticles<D>& fluid, const CellGrid<D>& grid, std::uint64_t particle) {
  const auto is_owned = [&](std::size_t i) {
    for (int axis = 0; axis < D; ++axis)
      if (!grid.is_inner(axis, grid.coordinate(axis, fluid.x(axis)[i]))) return false;
    return true;
  };
  std::uint32_t i = 0;
  while (i < fluid.size() && !(fluid.id[i] == particle && is_owned(i))) ++i;
  return i;
}

}  // namespace

template <int D, class Numbers>
std::optional<std::vector<PartnerTrace<D>>> trace_partners(const StepSums<D, Numbers, Stage::forces>& sums,
                                                           const FluidParticles<D>& fluid, const CellGrid<D>& grid,
                                                           const std::vector<FrozenInStep<D>>& frozen,
                                                           std::uint64_t particle) {
  const FluidPass<D, Numbers>& pass = sums.pass();
  const PairBlocks<D, Numbers>& blocks = pass.blocks();
  const std::uint32_t traced = index_of(fluid, grid, particle);
  if (traced == fluid.size()) return std::nullopt;
  std::vector<PartnerTrace<D>> partners;
  const auto keep = [&](const PartnerTrace<D>& partner) {
    if (partner.any()) partners.push_back(partner);
  };
  const std::uint32_t slot = blocks.slot(traced);
  constexpr std::uint64_t none = ~std::uint64_t{0};  // lanes of gaps
  std::vector<std::uint64_t> ids(blocks.size() * block_lanes<Numbers>, none);
  for (std::uint32_t i = 0; i < fluid.size(); ++i) ids[blocks.slot(i)] = fluid.id[i];
  FrozenSearch<D, Numbers> search;
  const std::vector<Vec<D, int>> rows = row_offsets(grid, false);
  with_pair_law(pass.model(), [&]<class Kernel, bool transport>(Kernel, std::bool_constant<transport>) {
    for (const KeptLists<D, Numbers>& lists : pass.lists().all())
      lists.for_each_pair([&](std::uint32_t i, std::uint32_t j) {
        if ((i != slot && j != slot) || ids[j] == none) return;
        const auto pair = sums_of_pair<Kernel, transport, false>(pass, blocks.centre(i), j, UnitFactor{});
        keep({false, ids[i == slot ? j : i], 0, i == slot ? pair.centre : pair.other, pair.density});
      });
    for (const auto& plane : frozen_by_plane(grid, frozen))
      search.for_each_list(pass.numbers(), blocks, grid, rows, frozen, plane, [&](const auto& lists) {
        lists.for_each_partner([&](std::uint32_t k, std::uint32_t j) {
          const FrozenInStep<D>& fp = frozen[k];
          if (j != slot) return;
          const auto pair = sums_of_pair<Kernel, transport, true>(
              pass, centre_of<D>(pass.numbers(), fp), slot, NoSlipFactor<D, typename Numbers::Real>(pass.model(), fp));
          keep({true, fp.solid, fp.index, pair.other, pair.density});
        });
      });
  });
  return partners;
}

#define MAPPM_INSTANTIATE(D, Numbers)                                                              \
  template std::optional<std::vector<PartnerTrace<D>>> trace_partners(                             \
      const StepSums<D, Numbers<D>, Stage::forces>&, const FluidParticles<D>&, const CellGrid<D>&, \
      const std::vector<FrozenInStep<D>>&, std::uint64_t);
MAPPM_INSTANTIATE(2, DoubleLanes)
MAPPM_INSTANTIATE(3, DoubleLanes)
MAPPM_INSTANTIATE(2, SingleLanes)
MAPPM_INSTANTIATE(3, SingleLanes)
#undef MAPPM_INSTANTIATE

}  // namespace mappm
