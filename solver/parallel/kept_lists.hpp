// Lists of pairs of PPs that serve for several steps: while the PPs keep their slots, only distances are worked out
// anew.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "parallel/lanes_loop.hpp"

namespace mappm {

/// Of each centre, a slot, the blocks that hold partners. All lanes of a block count unless some are named; in the
/// centre's own block only those behind it.
template <int D, class Numbers>
class KeptLists {
  using Real = typename Numbers::Real;
  using RealLanes = typename Numbers::RealLanes;

 public:
  void clear() {
    centres_.clear();
    blocks_.clear();
    named_.clear();
  }

  /// Adds those of the `near` blocks of a centre that are `chosen`; none occurs twice. Where `named`, only some lanes
  /// of them count, one a bit: partners(block).
  template <class Chosen, class NamedBlocks, class LanesOf>
  MAPPM_INLINE void add(std::uint32_t slot, std::span<const std::uint32_t> near, const Chosen& chosen,
                        const NamedBlocks& named, const LanesOf& partners) {
    const std::size_t first = blocks_.size();
    reserve_tightly(blocks_, first + near.size());
    blocks_.resize(first + near.size());
    std::size_t end = first;
    for (const std::uint32_t one : near) {
      if (!chosen(one)) continue;
      if (Numbers::largest_extent != std::numeric_limits<double>::infinity() && named(one)) {
        const std::uint16_t lanes_of_one = partners(one);
        if (lanes_of_one == 0) continue;
        named_.push_back({static_cast<std::uint32_t>(end), lanes_of_one});
      }
      blocks_[end++] = one;
    }
    blocks_.resize(end);
    if (end > first) centres_.push_back({slot, static_cast<std::uint32_t>(end)});
  }

  /// All pairs, with the excess of Numbers::ListRounding on what blocks receive; `squares` is scratch of the caller's
  /// thread.
  template <class Kernel, bool transport>
  void sum(const Numbers& numbers, PairBlocks<D, Numbers>& blocks, Column<Real>& squares) const {
    for_each_walk(
        numbers, blocks.data(), squares, [&](auto&& walk) __attribute__((always_inline)) {
          sum_blocks<Kernel, transport, false, typename Numbers::ListRounding, D>(
              numbers, blocks.data(), walk, [&](std::uint32_t slot) { return blocks.centre(slot); },
              [](std::uint32_t) { return UnitFactor{}; },
              [&](std::uint32_t slot, const auto& sums) { blocks.add(slot, sums); });
        });
  }
  /// The same of the densities.
  template <class Kernel>
  void sum_densities(const Numbers& numbers, PairBlocks<D, Numbers>& blocks, Column<Real>& squares) const {
    for_each_walk(
        numbers, blocks.data(), squares, [&](auto&& walk) __attribute__((always_inline)) {
          sum_densities_of_blocks<Kernel, typename Numbers::ListRounding, D>(
              numbers, blocks.data(), walk, [&](std::uint32_t slot, auto sum) { blocks.add_density(slot, sum); });
        });
  }
  /// Calls visit(slot, partner) for every pair that the lists hold, within the cutoff or not.
  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    std::size_t n = 0;
    auto named = named_.begin();
    for (const Centre& centre : centres_)
      for (; n < centre.end; ++n) {
        unsigned partners = ~0u;
        if (named != named_.end() && named->entry == n) partners = (named++)->partners;
        for (std::uint32_t lane = 0; lane < lanes; ++lane) {
          const std::uint32_t partner = blocks_[n] * lanes + lane;
          const bool same = blocks_[n] == centre.particle / lanes;
          if ((partners >> lane & 1) != 0 && (!same || partner > centre.particle)) visit(centre.particle, partner);
        }
      }
  }

  struct Centre {
    std::uint32_t particle, end;  // the slot of the centre, and where its blocks end
  };
  /// Calls visit(centres, base) for all centres, some at once. Block n of theirs, n >= base, has its squared distances
  /// in `squares`, entry n - base.
  template <class Visit>
  void for_each_chunk(const Numbers& numbers, const PairBlock<D, Numbers>* blocks, Column<Real>& squares,
                      Visit&& visit) const {
    std::size_t base = 0;
    auto named = named_.begin();
    for (std::size_t first = 0; first < centres_.size();) {
      std::size_t last = first + 1;
      while (last < centres_.size() && centres_[last].end - base <= detail::blocks_at_once<Numbers>) ++last;
      const std::span chunk = std::span(centres_).subspan(first, last - first);
      const std::size_t room = (chunk.back().end - base + detail::roots_ahead) * lanes;
      if (squares.size() < room) squares.resize(room);
      measure(numbers, blocks, chunk, base, named, squares.data());
      visit(chunk, base);
      base = chunk.back().end;
      first = last;
    }
  }

  /// Of all centres in turn.
  std::span<const std::uint32_t> blocks() const { return blocks_; }

 private:
  static constexpr std::uint32_t lanes = block_lanes<Numbers>;
  /// Calls use(walk) for some centres at once; walk(begin, visit, end) goes through their blocks (`for_each_block`).
  template <class Use>
  MAPPM_INLINE void for_each_walk(const Numbers& numbers, const PairBlock<D, Numbers>* blocks, Column<Real>& squares,
                                  Use&& use) const {
    for_each_chunk(
        numbers, blocks,
        squares, [&](std::span<const Centre> centres, std::size_t base) __attribute__((always_inline)) {
          Real* const distances = squares.data();
          use([&](auto&&... calls) __attribute__((always_inline)) {
            detail::for_each_block<RealLanes>(
                centres, base, blocks_.data(), [ distances, base ](std::size_t n) __attribute__((always_inline)) {
                  return distances + (n - base) * lanes;
                },
                calls...);
          });
        });
  }
  struct NamedLanes {
    std::uint32_t entry;  // in blocks_
    std::uint16_t partners;
  };
  using Named = typename std::vector<NamedLanes>::const_iterator;

  /// Squared distances of the blocks of some centres, at least 1 in lanes that are no partners. `named`: the first
  /// entry of theirs with named lanes.
  void measure(const Numbers& numbers, const PairBlock<D, Numbers>* blocks, std::span<const Centre> centres,
               std::size_t base, Named& named, Real* squares) const {
    std::size_t n = base;
    const Numbers same = numbers;  // as far as the compiler sees, what is stored below could change another's
    const std::uint32_t* const entries = blocks_.data();
    for (const Centre& centre : centres) {
      const std::uint32_t centre_block = centre.particle / lanes, lane = centre.particle % lanes;
      Vec<D, typename Numbers::Coordinate> x;
      for (int axis = 0; axis < D; ++axis) x[axis] = blocks[centre_block].x[axis][lane];
      const std::size_t first = n;
      for (const std::size_t end = centre.end; n < end; ++n) {
        const Vec<D, RealLanes> r = detail::separation_of_block<false>(same, blocks[entries[n]], x);
        dot(r, r).copy_to(squares + (n - base) * lanes, std::experimental::vector_aligned);
      }
      if (blocks_[first] == centre_block) {
        Real* const of_centre = squares + (first - base) * lanes;
        const RealLanes beside = RealLanes(static_cast<Real>(lane + 1)) - lane_numbers<RealLanes>();
        larger(RealLanes(of_centre, std::experimental::vector_aligned), beside)
            .copy_to(of_centre, std::experimental::vector_aligned);
      }
      for (; named != named_.end() && named->entry < centre.end; ++named)
        for (std::uint32_t k = 0; k < lanes; ++k)
          if ((named->partners >> k & 1) == 0) squares[(named->entry - base) * lanes + k] = Real(1);
    }
  }

  std::vector<Centre> centres_;
  Column<std::uint32_t> blocks_;
  std::vector<NamedLanes> named_;  // in the order of the entries
};

}  // namespace mappm
