#include "parallel/domains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "base/error.hpp"

namespace mappm {

namespace {

template <int D>
constexpr int offset_count = D == 2 ? 9 : 27;

/// The n-th offset in {-1, 0, 1}^D.
template <int D>
Vec<D, int> neighbour_offset(int n) {
  Vec<D, int> offset;
  for (int axis = 0; axis < D; ++axis, n /= 3) offset[axis] = n % 3 - 1;
  return offset;
}

std::vector<double> even_cuts(int count) {
  std::vector<double> cuts;
  for (int n = 0; n <= count; ++n) cuts.push_back(std::floor(box_quanta * n / count));
  return cuts;
}

/// Along one axis: keeps the product of three in range.
constexpr int most_domains = 1'000'000;

template <int D>
Vec<D, int> parse_grid(const std::string& text, int processes) {
  Vec<D, int> grid;
  std::size_t at = 0;
  std::int64_t product = 1;
  for (int axis = 0; axis < D; ++axis) {
    const char* const first = text.data() + std::min(at, text.size());
    const auto [end, failed] = std::from_chars(first, text.data() + text.size(), grid[axis]);
    at = static_cast<std::size_t>(end - text.data());
    const bool separator_fits = axis == D - 1 ? at == text.size() : at < text.size() && text[at] == 'x';
    if (failed != std::errc{} || grid[axis] < 1 || grid[axis] > most_domains || !separator_fits)
      throw InputError("command line", "--domains", text,
                       fmt::format("expected {} positive numbers such as {}", D, D == 2 ? "2x4" : "2x2x1"));
    ++at;
    product *= grid[axis];
  }
  if (product != processes)
    throw InputError(
        "command line", "--domains", text,
        fmt::format("{} domains do not match {} processes; start mpirun with -np {}", product, processes, product));
  return grid;
}

/// Smallest allowed side of a domain, rcut: PPs need a margin of rcut and room to move, solids that of their copies.
template <int D>
double smallest_side(const Model<D>& model) {
  return std::max(1.25, solid_margin(model));
}

template <int D>
void check_sides(const Model<D>& model, const Domains<D>& domains) {
  for (int axis = 0; axis < D; ++axis) {
    const auto& cuts = domains.cuts()[static_cast<std::size_t>(axis)];
    for (std::size_t n = 1; n < cuts.size(); ++n) {
      const double side = (cuts[n] - cuts[n - 1]) * model.pair.length[axis];
      if (side >= smallest_side(model)) continue;
      const int most = std::max(1, static_cast<int>(model.box[axis] / smallest_side(model)));
      throw InputError(
          "command line", "--domains", fmt::format("{} along {}", cuts.size() - 1, "xyz"[axis]),
          fmt::format("a domain would be {:.3g} rcut wide, but {} needs {:.3g}; use at most {} domains along "
                      "this axis",
                      side, model.terms.solids ? "a solid (h > 2R)" : "the margin of the PPs", smallest_side(model),
                      most));
    }
  }
}

}  // namespace

template <int D>
Domains<D>::Domains(std::array<std::vector<double>, D> cuts) : cuts_(std::move(cuts)) {}

template <int D>
Vec<D, int> Domains<D>::grid() const {
  Vec<D, int> grid;
  for (int axis = 0; axis < D; ++axis) grid[axis] = static_cast<int>(cuts_[static_cast<std::size_t>(axis)].size()) - 1;
  return grid;
}

template <int D>
int Domains<D>::count() const {
  int product = 1;
  for (const auto& cuts : cuts_) product *= static_cast<int>(cuts.size()) - 1;
  return product;
}

template <int D>
Vec<D, int> Domains<D>::coordinates(int rank) const {
  Vec<D, int> coordinates;
  for (int axis = 0; axis < D; ++axis) {
    coordinates[axis] = rank % grid()[axis];
    rank /= grid()[axis];
  }
  return coordinates;
}

template <int D>
int Domains<D>::rank_at(const Vec<D, int>& coordinates) const {
  int rank = 0;
  for (int axis = D - 1; axis >= 0; --axis) rank = rank * grid()[axis] + coordinates[axis];
  return rank;
}

template <int D>
Region<D> Domains<D>::region(int rank) const {
  Region<D> region;
  const Vec<D, int> at = coordinates(rank);
  for (int axis = 0; axis < D; ++axis) {
    const auto& cuts = cuts_[static_cast<std::size_t>(axis)];
    region.low[axis] = cuts[static_cast<std::size_t>(at[axis])];
    region.high[axis] = cuts[static_cast<std::size_t>(at[axis]) + 1];
  }
  return region;
}

template <int D>
int Domains<D>::owner(const Vec<D, double>& x) const {
  Vec<D, int> at;
  for (int axis = 0; axis < D; ++axis) {
    const auto& cuts = cuts_[static_cast<std::size_t>(axis)];
    const auto above = std::upper_bound(cuts.begin(), cuts.end(), wrap_position(x[axis]));
    at[axis] = static_cast<int>(above - cuts.begin()) - 1;
  }
  return rank_at(at);
}

template <int D>
std::vector<int> Domains<D>::partners(int rank) const {
  std::vector<int> ranks;
  for (int n = 0; n < offset_count<D>; ++n) {
    if (neighbour_offset<D>(n) == Vec<D, int>{}) continue;
    Vec<D, int> at = coordinates(rank) + neighbour_offset<D>(n);
    for (int axis = 0; axis < D; ++axis) at[axis] = (at[axis] + grid()[axis]) % grid()[axis];
    ranks.push_back(rank_at(at));
  }
  std::sort(ranks.begin(), ranks.end());
  ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
  return ranks;
}

template <int D>
std::vector<Image<D>> Domains<D>::images(int rank) const {
  std::vector<Image<D>> images;
  const std::vector<int> ranks = partners(rank);
  for (int n = 0; n < offset_count<D>; ++n) {
    if (neighbour_offset<D>(n) == Vec<D, int>{}) continue;
    Vec<D, int> at = coordinates(rank) + neighbour_offset<D>(n);
    Image<D> image;
    for (int axis = 0; axis < D; ++axis) {
      if (at[axis] < 0) image.shift[axis] = box_quanta;
      if (at[axis] >= grid()[axis]) image.shift[axis] = -box_quanta;
      at[axis] = (at[axis] + grid()[axis]) % grid()[axis];
    }
    const int neighbour = rank_at(at);
    image.partner = static_cast<int>(std::lower_bound(ranks.begin(), ranks.end(), neighbour) - ranks.begin());
    image.region = region(neighbour);
    image.region.low -= image.shift;
    image.region.high -= image.shift;
    images.push_back(image);
  }
  return images;
}

template <int D>
Domains<D> make_domains(const Model<D>& model, int processes, const std::string& grid) {
  Vec<D, int> counts;
  if (grid.empty()) {
    int longest = 0;  // of equal ones the slowest: its slabs hold whole planes of cells
    for (int axis = 1; axis < D; ++axis)
      if (model.box[axis] >= model.box[longest]) longest = axis;
    for (int axis = 0; axis < D; ++axis) counts[axis] = axis == longest ? processes : 1;
  } else {
    counts = parse_grid<D>(grid, processes);
  }
  std::array<std::vector<double>, D> cuts;
  for (int axis = 0; axis < D; ++axis) cuts[static_cast<std::size_t>(axis)] = even_cuts(counts[axis]);
  Domains<D> domains(std::move(cuts));
  check_sides(model, domains);
  return domains;
}

template <int D>
Domains<D> balanced(const Model<D>& model, const Domains<D>& domains,
                    const std::array<std::vector<std::uint64_t>, D>& profile) {
  std::array<std::vector<double>, D> cuts = domains.cuts();
  for (int axis = 0; axis < D; ++axis) {
    auto& borders = cuts[static_cast<std::size_t>(axis)];
    const auto& bins = profile[static_cast<std::size_t>(axis)];
    const int count = static_cast<int>(borders.size()) - 1;
    std::uint64_t total = 0;
    for (const std::uint64_t particles : bins) total += particles;
    const double smallest = std::ceil(smallest_side(model) / model.pair.length[axis]);
    std::uint64_t below = 0;
    std::size_t bin = 0;
    for (int n = 1; n < count; ++n) {
      const auto wanted = static_cast<double>(total) * n / count;
      while (bin < bins.size() && static_cast<double>(below + bins[bin]) < wanted) below += bins[bin++];
      const double inside = bin < bins.size() && bins[bin] > 0
                                ? (wanted - static_cast<double>(below)) / static_cast<double>(bins[bin])
                                : 0.0;
      const double cut =
          std::floor((static_cast<double>(bin) + inside) / static_cast<double>(bins.size()) * box_quanta);
      const auto border = static_cast<std::size_t>(n);
      borders[border] = std::clamp(cut, borders[border - 1] + smallest, box_quanta - (count - n) * smallest);
    }
  }
  return Domains<D>(std::move(cuts));
}

#define MAPPM_INSTANTIATE(D)                                                     \
  template class Domains<D>;                                                     \
  template Domains<D> make_domains<D>(const Model<D>&, int, const std::string&); \
  template Domains<D> balanced<D>(const Model<D>&, const Domains<D>&, const std::array<std::vector<std::uint64_t>, D>&);
MAPPM_INSTANTIATE(2)
MAPPM_INSTANTIATE(3)
#undef MAPPM_INSTANTIATE

}  // namespace mappm
