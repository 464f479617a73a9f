// The loops over pairs of the fast engine: one particle against blocks of others, a lane each.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "parallel/pair_blocks.hpp"

namespace mappm {

namespace detail {

/// Sums wrap, whatever stands in lanes that are nobody's.
template <class Sum>
using SumLanes = decltype(load_lanes(static_cast<const Wrapping<Sum>*>(nullptr)));

template <class Sum>
MAPPM_INLINE void add_to(Sum* sums, const SumLanes<Sum>& given) {
  auto* const wrapping = reinterpret_cast<Wrapping<Sum>*>(sums);
  store_lanes(load_lanes(wrapping) + given, wrapping);
}

template <class Sum, int D>
MAPPM_INLINE PairResult<D, Sum> total(const PairResult<D, SumLanes<Sum>>& sums) {
  PairResult<D, Sum> result;
  for (int axis = 0; axis < D; ++axis) {
    result.impulse[axis] = static_cast<Sum>(sum_of_lanes(sums.impulse[axis]));
    result.shift[axis] = static_cast<Sum>(sum_of_lanes(sums.shift[axis]));
  }
  result.shear = static_cast<Sum>(sum_of_lanes(sums.shear));
  result.agitation = static_cast<Sum>(sum_of_lanes(sums.agitation));
  return result;
}

/// Separation of a block of lanes and a centre, from j to i of the law. With `lanes_first` the lanes are i.
template <bool lanes_first, int D, class Numbers>
MAPPM_INLINE Vec<D, typename Numbers::RealLanes> separation_of_block(
    const Numbers& numbers, const PairBlock<D, Numbers>& block, const Vec<D, typename Numbers::Coordinate>& centre) {
  Vec<D, typename Numbers::RealLanes> d;
  for (int axis = 0; axis < D; ++axis) {
    const auto x = load_lanes(block.x[axis]);
    const decltype(x) of_centre(centre[axis]);
    d[axis] = lanes_first ? Numbers::apart(x, of_centre) : Numbers::apart(of_centre, x);
  }
  return separation(numbers.law(), d);
}

/// One block of lanes at the distances `q`.
template <class Kernel, bool transport, bool lanes_first, class Rounding, int D, class Numbers, class RealLanes,
          class Beta, class Sums>
MAPPM_INLINE void pair_block(const Numbers& numbers, PairBlock<D, Numbers>& block, const PairCentre<D, Numbers>& centre,
                             const RealLanes& q, const Beta& beta, Sums& sums) {
  const Vec<D, RealLanes> r = separation_of_block<lanes_first>(numbers, block, centre.x);
  FluidPair<D, RealLanes> pair;
  for (int axis = 0; axis < D; ++axis) {
    const RealLanes v = load_lanes(block.v[axis]);
    pair.v[axis] = lanes_first ? v - RealLanes(centre.v[axis]) : RealLanes(centre.v[axis]) - v;
  }
  pair.v2 = RealLanes(centre.volume.v2) + load_lanes(block.v2);
  pair.pv2 = RealLanes(centre.volume.pv2) + load_lanes(block.pv2);
  const auto given = fluid_pair<Kernel, transport, Rounding>(numbers.law(), pair, r, q, beta(r));
  const auto wrapped = [](const auto& lanes) { return converted<Wrapping<typename Numbers::Sum>>(lanes); };
  for (int axis = 0; axis < D; ++axis) {
    const auto impulse = lanes_first ? wrapped(given.impulse[axis]) : -wrapped(given.impulse[axis]);
    add_to(block.impulse[axis], impulse);
    sums.impulse[axis] -= impulse;
    if constexpr (transport) {
      const auto shift = lanes_first ? wrapped(given.shift[axis]) : -wrapped(given.shift[axis]);
      add_to(block.shift[axis], shift);
      sums.shift[axis] -= shift;
    }
  }
  if constexpr (transport) {
    add_to(block.shear, wrapped(given.shear));
    sums.shear += wrapped(given.shear);
    add_to(block.agitation, wrapped(given.agitation));
    sums.agitation += wrapped(given.agitation);
  }
}

inline constexpr std::size_t roots_ahead = 4;
/// Their distances stay in the nearest cache.
template <class Numbers>
inline constexpr std::size_t blocks_at_once = 4096 / sizeof(typename Numbers::RealLanes);

/// Calls visit(block, distances) for the blocks of each centre, between begin(particle, their number) and
/// end(particle). Of block n, from the given one to centres.back().end, squares(n) are the squared distances. They
/// become distances, and so do `roots_ahead` squares behind the last.
template <class RealLanes, class Centres, class Squares, class Begin, class Visit, class End>
MAPPM_INLINE void for_each_block(const Centres& centres, std::size_t n, const std::uint32_t* blocks, Squares&& squares,
                                 Begin&& begin, Visit&& visit, End&& end) {
  // A root takes as long as half of the rest: it is taken some blocks ahead.
  const auto take_root = [&](std::size_t at) __attribute__((always_inline)) {
    cut_distance(RealLanes(squares(at), std::experimental::vector_aligned))
        .copy_to(squares(at), std::experimental::vector_aligned);
  };
  for (std::size_t at = n; at < n + roots_ahead; ++at) take_root(at);
  for (const auto& centre : centres) {
    begin(centre.particle, centre.end - n);
    for (const std::size_t last = centre.end; n < last; ++n) {
      take_root(n + roots_ahead);
      visit(blocks[n], RealLanes(squares(n), std::experimental::vector_aligned));
    }
    end(centre.particle);
  }
}

}  // namespace detail

/// beta between PPs.
struct UnitFactor {
  template <int D, class Real>
  MAPPM_INLINE Real operator()(const Vec<D, Real>&) const {
    return constant<Real>(1.0);
  }
};

/// The partners of some particles, the centres, as blocks of lanes. Ranges, distances and pairs are worked out for all
/// of them in turn, in loops whose length the processor can guess.
template <int D, class Numbers>
class PartnerLists {
  using Real = typename Numbers::Real;
  using RealLanes = typename Numbers::RealLanes;
  using Position = Vec<D, typename Numbers::Coordinate>;

 public:
  void clear() {
    centres_.clear();
    size_ = 0;
  }
  bool is_full() const { return size_ >= detail::blocks_at_once<Numbers>; }

  /// Adds a particle with its ranges of slots: range(n) for n < count.
  template <class RangeOf>
  MAPPM_INLINE void add(std::uint32_t particle, const Position& x, std::size_t count, RangeOf&& range) {
    make_room(size_ + count * written);
    const auto owner = static_cast<std::uint32_t>(centres_.size());
    const Columns columns = this->columns();
    std::size_t size = size_;
    for (std::size_t n = 0; n < count; ++n) {
      const auto [first, end] = range(n);
      const std::uint32_t blocks = blocks_of(first, end);
      if (blocks > written) [[unlikely]] {
        size_ = size;
        make_room(size + blocks + (count - n) * written);
        return add_rest(particle, x, count, range, n);
      }
      write(columns, size, owner, first / lanes, first, end);
      size += blocks;
    }
    size_ = size;
    centres_.push_back({particle, static_cast<std::uint32_t>(size), x});
  }

  /// Calls visit(particle, partner) for every pair of a centre and a particle in its ranges.
  template <class Visit>
  void for_each_partner(Visit&& visit) const {
    for (std::size_t n = 0; n < size_; ++n)
      for (std::uint32_t lane = 0; lane < lanes; ++lane)
        if (const auto number = static_cast<Real>(lane); number >= first_[n] && number <= last_[n])
          visit(centres_[owner_[n]].particle, block_[n] * lanes + lane);
  }

  /// Works out the distances of all blocks, and drops those that have no partner within rcut.
  template <bool lanes_first>
  MAPPM_INLINE void measure(const Numbers& numbers, const PairBlock<D, Numbers>* blocks) {
    make_room(size_ + detail::roots_ahead);
    const Columns columns = this->columns();
    const Centre* const centres = centres_.data();
    for (std::size_t n = 0; n < size_; ++n) {
      const Vec<D, RealLanes> r =
          detail::separation_of_block<lanes_first>(numbers, blocks[columns.block[n]], centres[columns.owner[n]].x);
      // At least 1 in lanes that are no partners.
      const RealLanes beside = larger(RealLanes(columns.first[n]) - lane_numbers<RealLanes>(),
                                      lane_numbers<RealLanes>() - RealLanes(columns.last[n]));
      const RealLanes square = larger(dot(r, r), beside);
      square.copy_to(columns.distance + n * lanes, std::experimental::vector_aligned);
      columns.used[n] = any_below(square, Real(1)) ? 1 : 0;
    }
    // By itself: in the loop above every load would wait for the address of the store before it.
    std::size_t kept = 0, n = 0;
    for (Centre& centre : centres_) {
      for (; n < centre.end; ++n) {
        columns.block[kept] = columns.block[n];
        columns.from[kept] = static_cast<std::uint32_t>(n);
        kept += columns.used[n];
      }
      centre.end = static_cast<std::uint32_t>(kept);
    }
    for (std::size_t after = 0; after < detail::roots_ahead; ++after)
      columns.from[kept + after] = static_cast<std::uint32_t>(size_);
    size_ = kept;
  }

  /// After `measure`: calls visit(block, distances) for the blocks of each centre, between begin(particle, their
  /// number) and end(particle).
  template <class Begin, class Visit, class End>
  MAPPM_INLINE void for_each_block(Begin&& begin, Visit&& visit, End&& end) {
    const Columns columns = this->columns();
    detail::for_each_block<RealLanes>(
        centres_, 0, columns.block,
        [&](std::size_t n)
            __attribute__((always_inline)) { return columns.distance + std::size_t{columns.from[n]} * lanes; },
        begin, visit, end);
  }

 private:
  static constexpr std::uint32_t lanes = block_lanes<Numbers>;
  static constexpr std::uint32_t written = std::max(8u, lanes);  // blocks at once: longer ranges are rare
  struct Centre {
    std::uint32_t particle, end;  // and where its blocks end
    Position x;
  };
  /// Of each entry its block, its centre, its first and its last lane that is a partner, and distances.
  struct Columns {
    std::uint32_t *block, *owner, *from;
    std::uint8_t* used;
    Real *first, *last, *distance;
  };
  Columns columns() {
    return {block_.data(), owner_.data(), from_.data(), used_.data(), first_.data(), last_.data(), distance_.data()};
  }

  static std::uint32_t blocks_of(std::uint32_t first, std::uint32_t end) {
    return end > first ? (end - 1) / lanes - first / lanes + 1 : 0;
  }
  /// Blocks from `begin` on; those behind the range will be overwritten.
  MAPPM_INLINE static void write(const Columns& columns, std::size_t at, std::uint32_t owner, std::uint32_t begin,
                                 std::uint32_t first, std::uint32_t end) {
    const auto from = static_cast<Real>(static_cast<std::int32_t>(first - begin * lanes));
    const auto to = static_cast<Real>(static_cast<std::int32_t>(end - 1 - begin * lanes));
    for (std::uint32_t n = 0; n < written; ++n) columns.block[at + n] = begin + n;
    for (std::uint32_t n = 0; n < written; ++n) columns.owner[at + n] = owner;
    for (std::uint32_t n = 0; n < written; n += lanes) {
      const RealLanes passed = (lane_numbers<RealLanes>() + static_cast<Real>(n)) * static_cast<Real>(lanes);
      (RealLanes(from) - passed).copy_to(columns.first + at + n, std::experimental::element_aligned);
      (RealLanes(to) - passed).copy_to(columns.last + at + n, std::experimental::element_aligned);
    }
  }
  /// The ranges from number n on, of any length.
  template <class RangeOf>
  [[gnu::noinline]] void add_rest(std::uint32_t particle, const Position& x, std::size_t count, RangeOf&& range,
                                  std::size_t n) {
    const auto owner = static_cast<std::uint32_t>(centres_.size());
    for (; n < count; ++n) {
      const auto [first, end] = range(n);
      const std::uint32_t blocks = blocks_of(first, end);
      make_room(size_ + blocks);
      for (std::uint32_t done = 0; done < blocks; done += written)
        write(columns(), size_ + done, owner, first / lanes + done, first, end);
      size_ += blocks;
    }
    centres_.push_back({particle, static_cast<std::uint32_t>(size_), x});
  }
  void make_room(std::size_t entries) {
    if (block_.size() >= entries + written) [[likely]]
      return;
    block_.resize(entries + written);
    owner_.resize(entries + written);
    from_.resize(entries + written);
    used_.resize(entries + written);
    first_.resize(entries + written);
    last_.resize(entries + written);
    distance_.resize((entries + written) * lanes);
  }

  std::size_t size_ = 0;
  Column<std::uint32_t> block_, owner_, from_;
  Column<std::uint8_t> used_;
  Column<Real> first_, last_, distance_;
  std::vector<Centre> centres_;
};

/// All pairs of the lists: adds to the sums of the partners, and calls receive(particle, sums) with what each centre
/// receives. `walk` calls for_each_block. centre_of(n) gives a PairCentre, beta_of(n) a function of the separation.
/// Zeros are added to lanes beside the partners, and to all of a block the excess of the rounding.
template <class Kernel, bool transport, bool lanes_first, class Rounding, int D, class Numbers, class Walk,
          class CentreOf, class BetaOf, class Receive>
MAPPM_INLINE void sum_blocks(const Numbers& numbers, PairBlock<D, Numbers>* const blocks, Walk&& walk,
                             CentreOf&& centre_of, BetaOf&& beta_of, Receive&& receive) {
  using Sum = typename Numbers::Sum;
  static_assert(Rounding::excess == 0 || !lanes_first, "the signs below");
  PairResult<D, detail::SumLanes<Sum>> sums{};
  PairCentre<D, Numbers> centre;
  std::decay_t<decltype(beta_of(0))> beta = beta_of(0);
  walk(
      [&](std::uint32_t n, std::size_t count) __attribute__((always_inline)) {
        centre = centre_of(n);
        beta = beta_of(n);
        const detail::SumLanes<Sum> excess(static_cast<Wrapping<Sum>>(-Rounding::excess * count));
        for (int axis = 0; axis < D; ++axis) {
          sums.impulse[axis] = excess;
          if constexpr (transport) sums.shift[axis] = excess;
        }
        if constexpr (transport) sums.shear = sums.agitation = excess;
      },
      [&](std::uint32_t block, const typename Numbers::RealLanes& q) __attribute__((always_inline)) {
        detail::pair_block<Kernel, transport, lanes_first, Rounding>(numbers, blocks[block], centre, q, beta, sums);
      },
      [&](std::uint32_t n) __attribute__((always_inline)) { receive(n, detail::total<Sum>(sums)); });
}

/// The densities of all pairs of the lists, in the same way: receive(particle, sum).
template <class Kernel, class Rounding, int D, class Numbers, class Walk, class Receive>
MAPPM_INLINE void sum_densities_of_blocks(const Numbers& numbers, PairBlock<D, Numbers>* const blocks, Walk&& walk,
                                          Receive&& receive) {
  using Sum = typename Numbers::Sum;
  using RealLanes = typename Numbers::RealLanes;
  detail::SumLanes<Sum> sum(0);
  walk(
      [&](std::uint32_t, std::size_t count) __attribute__((always_inline)) {
        sum = detail::SumLanes<Sum>(static_cast<Wrapping<Sum>>(-Rounding::excess * count));
      },
      [&](std::uint32_t block, const RealLanes& q) __attribute__((always_inline)) {
        const auto given = converted<Wrapping<Sum>>(pair_density<Kernel, Rounding, D>(numbers.law(), q));
        detail::add_to(blocks[block].density, given);
        sum += given;
      },
      [&](std::uint32_t n) __attribute__((always_inline)) { receive(n, static_cast<Sum>(sum_of_lanes(sum))); });
}

/// `sum_blocks` over lists of this step. Blocks that lie beyond the cutoff are dropped from them.
template <class Kernel, bool transport, bool lanes_first, int D, class Numbers, class CentreOf, class BetaOf,
          class Receive>
void sum_lists(const Numbers& numbers, PairBlock<D, Numbers>* const blocks, PartnerLists<D, Numbers>& lists,
               CentreOf&& centre_of, BetaOf&& beta_of, Receive&& receive) {
  lists.template measure<lanes_first>(numbers, blocks);
  sum_blocks<Kernel, transport, lanes_first, typename Numbers::Rounding, D>(
      numbers, blocks, [&](auto&&... calls) __attribute__((always_inline)) { lists.for_each_block(calls...); },
      centre_of, beta_of, receive);
}

template <class Kernel, bool lanes_first, int D, class Numbers, class Receive>
void sum_densities_of_lists(const Numbers& numbers, PairBlock<D, Numbers>* const blocks,
                            PartnerLists<D, Numbers>& lists, Receive&& receive) {
  lists.template measure<lanes_first>(numbers, blocks);
  sum_densities_of_blocks<Kernel, typename Numbers::Rounding, D>(
      numbers, blocks, [&](auto&&... calls) __attribute__((always_inline)) { lists.for_each_block(calls...); },
      receive);
}

}  // namespace mappm
