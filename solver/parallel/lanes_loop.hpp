// The loops over pairs of the fast engine: one particle against blocks of others, a lane each.
#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include "parallel/pair_blocks.hpp"

namespace mappm {

namespace detail {

MAPPM_INLINE void add_to(std::int64_t* sums, const IntLanes& given) { store_lanes(load_lanes(sums) + given, sums); }

template <int D>
struct LaneSums {
  Vec<D, IntLanes> impulse, shift;
  IntLanes density;
};

template <int D>
MAPPM_INLINE NeighbourSums<D> total(const LaneSums<D>& sums) {
  NeighbourSums<D> result;
  for (int axis = 0; axis < D; ++axis) {
    result.impulse[axis] = sum_of_lanes(sums.impulse[axis]);
    result.shift[axis] = sum_of_lanes(sums.shift[axis]);
  }
  result.density = sum_of_lanes(sums.density);
  return result;
}

/// Separation of a block of lanes and a centre, from j to i of the law. With `lanes_first` the lanes are i.
template <bool lanes_first, int D>
MAPPM_INLINE Vec<D, Lanes> separation_of_block(const PairLaw<D>& law, const PairBlock<D>& block,
                                               const Vec<D, double>& centre) {
  Vec<D, Lanes> d;
  for (int axis = 0; axis < D; ++axis) {
    const Lanes x = load_lanes(block.x[axis]);
    d[axis] = lanes_first ? x - Lanes(centre[axis]) : Lanes(centre[axis]) - x;
  }
  return separation(law, d);
}

/// One block of lanes at the distances `q`.
template <class Kernel, bool transport, bool lanes_first, int D, class Beta>
MAPPM_INLINE void pair_block(const PairLaw<D>& law, PairBlock<D>& block, const PairCentre<D>& centre, const Lanes& q,
                             const Beta& beta, LaneSums<D>& sums) {
  const Vec<D, Lanes> r = separation_of_block<lanes_first>(law, block, centre.x);
  FluidPair<D, Lanes> pair;
  for (int axis = 0; axis < D; ++axis) {
    const Lanes v = load_lanes(block.v[axis]);
    pair.v[axis] = lanes_first ? v - Lanes(centre.v[axis]) : Lanes(centre.v[axis]) - v;
  }
  pair.v2 = Lanes(centre.volume.v2) + load_lanes(block.v2);
  pair.pv2 = Lanes(centre.volume.pv2) + load_lanes(block.pv2);
  const PairResult<D, Lanes> given = fluid_pair<Kernel, transport>(law, pair, r, q, beta(r));
  for (int axis = 0; axis < D; ++axis) {
    const IntLanes impulse = lanes_first ? given.impulse[axis] : -given.impulse[axis];
    add_to(block.impulse[axis], impulse);
    sums.impulse[axis] -= impulse;
    if constexpr (transport) {
      const IntLanes shift = lanes_first ? given.shift[axis] : -given.shift[axis];
      add_to(block.shift[axis], shift);
      sums.shift[axis] -= shift;
    }
  }
  add_to(block.density, given.density);
  sums.density += given.density;
}

}  // namespace detail

/// The partners of some particles, the centres, as blocks of lanes. Ranges, distances and pairs are worked out for all
/// of them in turn, in loops whose length the processor can guess.
template <int D>
class PartnerLists {
 public:
  void clear() {
    centres_.clear();
    size_ = 0;
  }
  bool is_full() const { return size_ >= full; }
  /// Number of blocks: those that hold a partner, and after `measure` those within the cutoff.
  std::size_t size() const { return size_; }

  /// Adds a particle with its ranges of places: range(n) for n < count.
  template <class RangeOf>
  MAPPM_INLINE void add(std::uint32_t particle, const Vec<D, double>& x, std::size_t count, RangeOf&& range) {
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
      write(columns, size, owner, first / lane_count, first, end);
      size += blocks;
    }
    size_ = size;
    centres_.push_back({particle, static_cast<std::uint32_t>(size), x});
  }

  /// Calls visit(particle, partner) for every pair of a centre and a particle in its ranges.
  template <class Visit>
  void for_each_partner(Visit&& visit) const {
    for (std::size_t n = 0; n < size_; ++n)
      for (int lane = 0; lane < lane_count; ++lane)
        if (lane >= first_[n] && lane <= last_[n])
          visit(centres_[owner_[n]].particle, block_[n] * lane_count + static_cast<std::uint32_t>(lane));
  }

  /// Works out the distances of all blocks, and drops those that have no partner within the cutoff.
  template <bool lanes_first>
  MAPPM_INLINE void measure(const PairLaw<D>& law, const PairBlock<D>* blocks) {
    make_room(size_ + ahead);
    const Columns columns = this->columns();
    const Centre* const centres = centres_.data();
    for (std::size_t n = 0; n < size_; ++n) {
      const Vec<D, Lanes> r =
          detail::separation_of_block<lanes_first>(law, blocks[columns.block[n]], centres[columns.owner[n]].x);
      // At least 1 in lanes that are no partners.
      const Lanes beside = larger(Lanes(columns.first[n]) - lane_numbers(), lane_numbers() - Lanes(columns.last[n]));
      const Lanes square = larger(dot(r, r), beside);
      square.copy_to(columns.distance + n * lane_count, std::experimental::vector_aligned);
      columns.used[n] = any_below(square, 1.0) ? 1 : 0;
    }
    // By itself: in the loop above every load would wait for the place of the store before it.
    std::size_t kept = 0, n = 0;
    for (Centre& centre : centres_) {
      for (; n < centre.end; ++n) {
        columns.block[kept] = columns.block[n];
        columns.from[kept] = static_cast<std::uint32_t>(n);
        kept += columns.used[n];
      }
      centre.end = static_cast<std::uint32_t>(kept);
    }
    for (std::size_t after = 0; after < ahead; ++after) columns.from[kept + after] = static_cast<std::uint32_t>(size_);
    size_ = kept;
  }

  /// After `measure`: calls visit(block, distances) for the blocks of each centre, between begin(particle) and
  /// end(particle).
  template <class Begin, class Visit, class End>
  MAPPM_INLINE void for_each_block(Begin&& begin, Visit&& visit, End&& end) {
    const Columns columns = this->columns();
    const auto distances = [&](std::size_t n) __attribute__((always_inline)) {
      return columns.distance + std::size_t{columns.from[n]} * lane_count;
    };
    // A root takes as long as half of the rest: it is taken some blocks ahead.
    const auto take_root = [&](std::size_t n) __attribute__((always_inline)) {
      cut_distance(Lanes(distances(n), std::experimental::vector_aligned))
          .copy_to(distances(n), std::experimental::vector_aligned);
    };
    for (std::size_t n = 0; n < ahead; ++n) take_root(n);
    std::size_t n = 0;
    for (const Centre& centre : centres_) {
      begin(centre.particle);
      for (; n < centre.end; ++n) {
        take_root(n + ahead);
        visit(columns.block[n], Lanes(distances(n), std::experimental::vector_aligned));
      }
      end(centre.particle);
    }
  }

 private:
  static constexpr std::uint32_t written = 8;            // blocks at once: longer ranges are rare
  static constexpr std::size_t full = 512 / lane_count;  // blocks: their distances stay in the nearest cache
  static constexpr std::size_t ahead = 3;
  struct Centre {
    std::uint32_t particle, end;  // and where its blocks end
    Vec<D, double> x;
  };
  /// Of each entry its block, its centre, its first and its last lane that is a partner, and distances.
  struct Columns {
    std::uint32_t *block, *owner, *from;
    std::uint8_t* used;
    double *first, *last, *distance;
  };
  Columns columns() {
    return {block_.data(), owner_.data(), from_.data(), used_.data(), first_.data(), last_.data(), distance_.data()};
  }

  static std::uint32_t blocks_of(std::uint32_t first, std::uint32_t end) {
    return end > first ? (end - 1) / lane_count - first / lane_count + 1 : 0;
  }
  /// Blocks from `begin` on; those behind the range will be overwritten.
  MAPPM_INLINE static void write(const Columns& columns, std::size_t at, std::uint32_t owner, std::uint32_t begin,
                                 std::uint32_t first, std::uint32_t end) {
    const double from = static_cast<std::int32_t>(first - begin * lane_count);
    const double to = static_cast<std::int32_t>(end - 1 - begin * lane_count);
    for (std::uint32_t n = 0; n < written; ++n) columns.block[at + n] = begin + n;
    for (std::uint32_t n = 0; n < written; ++n) columns.owner[at + n] = owner;
    for (std::uint32_t n = 0; n < written; n += lane_count) {
      const Lanes passed = (lane_numbers() + static_cast<double>(n)) * static_cast<double>(lane_count);
      (Lanes(from) - passed).copy_to(columns.first + at + n, std::experimental::element_aligned);
      (Lanes(to) - passed).copy_to(columns.last + at + n, std::experimental::element_aligned);
    }
  }
  /// The ranges from number n on, of any length.
  template <class RangeOf>
  [[gnu::noinline]] void add_rest(std::uint32_t particle, const Vec<D, double>& x, std::size_t count, RangeOf&& range,
                                  std::size_t n) {
    const auto owner = static_cast<std::uint32_t>(centres_.size());
    for (; n < count; ++n) {
      const auto [first, end] = range(n);
      const std::uint32_t blocks = blocks_of(first, end);
      make_room(size_ + blocks);
      for (std::uint32_t done = 0; done < blocks; done += written)
        write(columns(), size_ + done, owner, first / lane_count + done, first, end);
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
    distance_.resize((entries + written) * lane_count);
  }

  std::size_t size_ = 0;
  Column<std::uint32_t> block_, owner_, from_;
  Column<std::uint8_t> used_;
  Column<double> first_, last_, distance_;
  std::vector<Centre> centres_;
};

/// All pairs of the lists: adds to the sums of the partners, and calls receive(particle, sums) with what each centre
/// receives. centre_of(n) gives a PairCentre, beta_of(n) a function of the separation. Zeros are added to lanes beside
/// the partners. Blocks of the lists that lie beyond the cutoff are dropped.
template <class Kernel, bool transport, bool lanes_first, int D, class CentreOf, class BetaOf, class Receive>
void sum_lists(const PairLaw<D>& law, PairBlock<D>* const blocks, PartnerLists<D>& lists, CentreOf&& centre_of,
               BetaOf&& beta_of, Receive&& receive) {
  lists.template measure<lanes_first>(law, blocks);
  detail::LaneSums<D> sums;
  PairCentre<D> centre;
  std::decay_t<decltype(beta_of(0))> beta = beta_of(0);
  lists.for_each_block(
      [&](std::uint32_t n) __attribute__((always_inline)) {
        centre = centre_of(n);
        beta = beta_of(n);
        sums = {};
      },
      [&](std::uint32_t block, const Lanes& q) __attribute__((always_inline)) {
        detail::pair_block<Kernel, transport, lanes_first>(law, blocks[block], centre, q, beta, sums);
      },
      [&](std::uint32_t n) __attribute__((always_inline)) { receive(n, detail::total(sums)); });
}

}  // namespace mappm
