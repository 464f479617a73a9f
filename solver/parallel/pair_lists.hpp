// Finds the pairs of PPs that the pair passes sum, at the start of a stay or in a step of its own.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "parallel/bands.hpp"
#include "parallel/kept_lists.hpp"
#include "parallel/near_rows.hpp"
#include "particles/cell_grid.hpp"
#include "particles/model.hpp"

namespace mappm {

/// Blocks near one block, with their boxes (rcut), side by side.
template <int D>
struct Candidates {
  std::vector<std::uint32_t> block;
  std::array<Column<double>, D> low, high;

  void make_room(std::size_t count) {
    if (block.size() >= count + lane_count) [[likely]]
      return;
    block.resize(2 * count + lane_count);
    for (auto& values : low) values.resize(block.size());
    for (auto& values : high) values.resize(block.size());
  }
  /// What is read behind the last one lies far away.
  void end(std::size_t count) {
    make_room(count);
    for (std::size_t n = count; n < count + lane_count; ++n) low[0][n] = std::numeric_limits<double>::max();
  }
};

template <int D, class Numbers>
class PairLists {
 public:
  /// Pairs that have nothing to do with foreign PPs, and the others.
  enum Part : std::size_t { inner, rest, parts };

  PairLists(const Model<D>& model, const Bands<D>& bands) : model_(model), bands_(bands) {}

  /// As FluidPass::list. `blocks` hold the PPs in the order of the grid, and hear what will be added to them.
  void make(PairBlocks<D, Numbers>& blocks, const FluidParticles<D>& fluid, const CellGrid<D>& grid,
            const Region<D>& region, double reach, std::span<const std::uint32_t> foreign, bool apart);

  const KeptLists<D, Numbers>& of(Part part, std::size_t band) const { return kept_[parts * band + part]; }
  /// Of each band one for each part.
  const std::vector<KeptLists<D, Numbers>>& all() const { return kept_; }
  /// Whether a block holds a foreign PP.
  bool is_foreign(std::uint32_t block) const { return foreign_[block] != 0; }
  /// Distances from boxes that `make` worked out.
  std::uint64_t measured() const {
    std::uint64_t sum = 0;
    for (const Search& search : searches_) sum += search.measured;
    return sum;
  }

 private:
  using Blocks = PairBlocks<D, Numbers>;
  static constexpr std::uint32_t lanes = block_lanes<Numbers>;
  /// What a thread searches with.
  struct Search {
    NearRows<D> near;
    Candidates<D> candidates;
    std::vector<std::uint32_t> found;  // near one PP
    std::uint64_t measured = 0;
  };
  /// Of each slot: whether it holds a PP in the region; of each block: whether any does, and whether its lanes must be
  /// named.
  struct Marks {
    std::vector<std::uint8_t> inside, reaches_inside, wide;
  };

  void find_boxes(const Blocks& blocks, const FluidParticles<D>& fluid);
  Marks marks(const Blocks& blocks, const FluidParticles<D>& fluid, const Region<D>& region) const;
  std::vector<std::uint8_t> slots_in(const Blocks& blocks, const FluidParticles<D>& fluid,
                                     const Region<D>& region) const;
  std::vector<std::uint8_t> wide_blocks(const Blocks& blocks, const FluidParticles<D>& fluid) const;
  std::uint16_t lanes_near(const Blocks& blocks, const FluidParticles<D>& fluid, std::uint32_t slot,
                           std::uint32_t block) const;
  template <class Work>
  void for_each_row(const CellGrid<D>& grid, int first_plane, int last_plane, Work&& work) const;
  template <class Work>
  void for_each_block_list(const Blocks& blocks, const FluidParticles<D>& fluid, const CellGrid<D>& grid,
                           const Vec<D, int>& row, double reach, Search& search, Work&& work);
  std::uint32_t gather_candidates(const CellGrid<D>& grid, std::uint32_t block, Search& search) const;

  const Model<D>& model_;
  Bands<D> bands_;
  std::vector<Vec<D, int>> half_rows_;
  std::vector<Search> searches_;                      // of the threads
  std::array<Column<double>, D> box_low_, box_high_;  // of the blocks, rcut
  std::vector<KeptLists<D, Numbers>> kept_;
  std::vector<std::uint8_t> foreign_;  // of each block
};

}  // namespace mappm
