// What the pair passes of a step meet, of densities and of forces together, and what they cost, on a fluid in disorder:
// 39 neighbours in the plane, 77 in space.
//   bench-pair_census SIDE_2D SIDE_3D ROUNDS
// SIDE: PPs along each axis. ROUNDS: of the timed parts; with 0 each part is made once, untimed, for a tool that counts
// instructions. Prints one line a figure; those in time are medians over the rounds, ns a pair within the cutoff.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "parallel/fluid_pass.hpp"
#include "sorted_fluid.hpp"
#include "timing.hpp"

namespace mappm {
using bench::Counted, bench::Operations, bench::SortedFluid;
namespace {

constexpr int passes = 2;  // of densities and of forces: each works out the distances

/// What the search meets, candidates, and what the lists hold that it makes: blocks, and those with a pair within the
/// cutoff; pairs within the cutoff.
struct Census {
  std::uint64_t candidates = 0, blocks = 0, near_blocks = 0, pairs = 0;
};

/// The parts of the passes of a step, each by itself. None is inlined, so that a tool can tell them apart.
template <int D>
class Parts {
  using Pass = FluidPass<D, DoubleLanes<D>>;

 public:
  explicit Parts(std::uint64_t side)
      : setup_(side), numbers_(setup_.fluid.model.pair, setup_.fluid.model.rest_density), pass_(setup_.fluid.model, 1) {
    setup_.list(pass_);
    sum();
    lay_blocks();
  }

  const SortedFluid<D>& setup() const { return setup_; }

  [[gnu::noinline]] void sort() { setup_.grid.sort(setup_.particles); }
  [[gnu::noinline]] void search() { setup_.list(pass_); }
  [[gnu::noinline]] void lay_out() { lay_blocks(); }
  [[gnu::noinline]] void distances() {
    for (int pass = 0; pass < passes; ++pass)
      for (const auto& lists : pass_.lists().all())
        lists.for_each_chunk(numbers_, blocks_.data(), squares_, [](auto, auto) {});
  }
  [[gnu::noinline]] void whole_pass() { sum(); }

  Census census() {
    Census found;
    found.candidates = pass_.lists().measured() * lane_count;  // the search measures to the box of a block
    for (const auto& lists : pass_.lists().all()) {
      found.blocks += lists.blocks().size();
      lists.for_each_chunk(numbers_, blocks_.data(), squares_, [&](auto centres, std::size_t base) {
        for (std::size_t n = base; n < centres.back().end; ++n) {
          const double* const square = squares_.data() + (n - base) * lane_count;
          const auto near = std::count_if(square, square + lane_count, [](double q) { return q < 1.0; });
          found.pairs += static_cast<std::uint64_t>(near);
          found.near_blocks += near > 0 ? 1 : 0;
        }
      });
    }
    // Some between ghosts are in blocks of others.
    if (found.pairs < setup_.pairs || found.pairs > setup_.pairs + setup_.pairs_of_ghosts)
      throw std::runtime_error(fmt::format("{} pairs in the lists, {} in the fluid", found.pairs, setup_.pairs));
    found.pairs = setup_.pairs;
    return found;
  }

 private:
  void lay_blocks() { blocks_.fill(setup_.fluid.model, numbers_, setup_.particles, setup_.grid); }
  void sum() { setup_.sum(pass_); }

  SortedFluid<D> setup_;
  DoubleLanes<D> numbers_;
  Pass pass_;
  PairBlocks<D, DoubleLanes<D>> blocks_;
  Column<double> squares_;
};

/// Operations of a block, and the registers it loads and stores.
struct BlockWork {
  Operations operations;
  int loads = 0, stores = 0;
};

template <int D>
Vec<D, Counted> of_lanes(Operations& operations) {
  Vec<D, Counted> numbers;
  for (int axis = 0; axis < D; ++axis) numbers[axis] = Counted::of_lanes(0.25, operations);
  return numbers;
}

/// Distances of a block (`KeptLists`), in all passes.
template <int D>
BlockWork work_of_distances(const Model<D>& model) {
  BlockWork work;
  for (int pass = 0; pass < passes; ++pass) {
    const Vec<D, Counted> r = separation(model.pair, Vec<D, Counted>{} - of_lanes<D>(work.operations));
    dot(r, r);
    work.loads += D;
    work.stores += 1;
  }
  return work;
}

/// Roots and laws of a block (`for_each_block`, `sum_densities_of_blocks`, `pair_block`).
template <int D>
BlockWork work_of_pairs(const Model<D>& model) {
  BlockWork work;
  Operations& operations = work.operations;
  with_pair_law(model, [&]<class Kernel, bool transport>(Kernel, std::bool_constant<transport>) {
    using Rounding = typename DoubleLanes<D>::ListRounding;
    constexpr int components = transport ? 2 * D + 2 : D;  // impulse, shift, shear, agitation
    pair_density<Kernel, Rounding, D>(model.pair, cut_distance(Counted::of_lanes(0.25, operations)));
    const Counted q = cut_distance(Counted::of_lanes(0.25, operations));
    const Vec<D, Counted> r = separation(model.pair, Vec<D, Counted>{} - of_lanes<D>(operations));
    FluidPair<D, Counted> pair;
    pair.v = Vec<D, Counted>{} - of_lanes<D>(operations);
    pair.v2 = Counted() + Counted::of_lanes(1.0, operations);
    pair.pv2 = Counted() + Counted::of_lanes(1.0, operations);
    fluid_pair<Kernel, transport, Rounding>(model.pair, pair, r, q, Counted(1.0));
    operations.integers += 2 * (1 + components);  // to the partner and to the centre
    // Of densities: the sum; the square and its root. Of forces: places, velocities, volume terms, sums; the same.
    work.loads = 1 + 2 + 2 * D + 2 + components + 2;
    work.stores = 1 + 1 + components + 1;  // sums; the roots
  });
  return work;
}

template <int D>
class Report {
 public:
  Report(std::string name, std::uint64_t side) : name_(std::move(name)), parts_(side) {}

  void print(int rounds) {
    const Census census = parts_.census();
    const double owned = static_cast<double>(parts_.setup().owned), blocks = static_cast<double>(census.blocks),
                 pairs = static_cast<double>(census.pairs);
    figure("particles", owned);
    figure("pairs", pairs);
    figure("pairs_per_particle", pairs / owned);
    figure("blocks_per_particle", blocks / owned);
    ratio("candidates_inside", pairs / static_cast<double>(census.candidates));
    ratio("blocks_within_cutoff", static_cast<double>(census.near_blocks) / blocks);
    ratio("lanes_used", pairs / blocks / lane_count);
    constexpr double block = sizeof(PairBlock<D, DoubleLanes<D>>) / lane_count, state = 8.0 * 2 * D;
    const double lists = 4.0 * blocks / owned + 8.0;
    figure("bytes_per_particle_block", block);
    figure("bytes_per_particle_lists", lists);
    // State read and block written; for the densities places and sums read and sums written, lists read; densities and
    // volumes written; for the forces block read and written, lists read. More where a block leaves the cache between
    // two rows.
    figure("bytes_per_particle_memory", state + 3.0 * block + 8.0 * (D + 2) + 8.0 * 3 + passes * lists);
    print_work("distances", work_of_distances(parts_.setup().fluid.model));
    print_work("pairs", work_of_pairs(parts_.setup().fluid.model));
    if (rounds > 0)
      print_times(rounds, pairs);
    else
      for (const auto& part : all_parts_) part.second();
  }

 private:
  void print_work(const std::string& part, const BlockWork& work) const {
    figure("block_" + part + ".multiplications", work.operations.multiplications);
    figure("block_" + part + ".additions", work.operations.additions);
    figure("block_" + part + ".roots", work.operations.roots);
    figure("block_" + part + ".integers", work.operations.integers);
    figure("block_" + part + ".loads", work.loads);
    figure("block_" + part + ".stores", work.stores);
  }
  void print_times(int rounds, double pairs) {
    std::vector<std::vector<double>> times(all_parts_.size());
    for (int round = 0; round < rounds; ++round)
      for (std::size_t part = 0; part < all_parts_.size(); ++part) {
        const double before = bench::computing_seconds();
        all_parts_[part].second();
        times[part].push_back((bench::computing_seconds() - before) / pairs * 1e9);
      }
    for (std::size_t part = 0; part < all_parts_.size(); ++part)
      figure("ns_per_pair_" + all_parts_[part].first, bench::median(times[part]));
  }
  void figure(const std::string& figure, double value) const {
    fmt::print("figure {}.{} {:.6g}\n", name_, figure, value);
  }
  void ratio(const std::string& ratio, double value) const { fmt::print("ratio {}.{} {:.6g}\n", name_, ratio, value); }

  std::string name_;
  Parts<D> parts_;
  std::vector<std::pair<std::string, std::function<void()>>> all_parts_{{"sort", [&] { parts_.sort(); }},
                                                                        {"search", [&] { parts_.search(); }},
                                                                        {"lay_out", [&] { parts_.lay_out(); }},
                                                                        {"distances", [&] { parts_.distances(); }},
                                                                        {"whole_pass", [&] { parts_.whole_pass(); }}};
};

}  // namespace
}  // namespace mappm

int main(int argc, char** argv) {
  if (argc != 4) {
    fmt::print(stderr, "usage: bench-pair_census SIDE_2D SIDE_3D ROUNDS\n");
    return 2;
  }
  const int rounds = std::atoi(argv[3]);
  mappm::Report<2>("fluid_2d_39", std::strtoull(argv[1], nullptr, 10)).print(rounds);
  mappm::Report<3>("fluid_3d_77", std::strtoull(argv[2], nullptr, 10)).print(rounds);
}
