#include "parallel/redistribute.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "parallel/solid_message.hpp"

namespace mappm {

namespace {

constexpr std::size_t profile_bins = 4096;

std::size_t bin_of(double x) {
  return std::min(profile_bins - 1, static_cast<std::size_t>(x / box_quanta * static_cast<double>(profile_bins)));
}

}  // namespace

template <int D>
Domains<D> domains_by_load(const Model<D>& model, const Domains<D>& domains, const Communicator& communicator,
                           const State<D>& state) {
  std::array<std::vector<std::uint64_t>, D> profile;
  for (int axis = 0; axis < D; ++axis) {
    auto& bins = profile[static_cast<std::size_t>(axis)];
    bins.assign(profile_bins, 0);
    for (const double x : state.fluid.x(axis)) ++bins[bin_of(wrap_position(x))];
    for (const Solid<D>& solid : state.solids)
      bins[bin_of(wrap_position(solid.x[axis]))] += model.shapes[solid.shape].frozen.size();
    communicator.sum(std::span(bins));
  }
  return balanced<D>(model, domains, profile);
}

template <int D>
void redistribute(const Domains<D>& domains, const Communicator& communicator, State<D>& state) {
  std::vector<Buffer> out(static_cast<std::size_t>(communicator.size()));
  const FluidParticles<D>& fluid = state.fluid;
  std::vector<int> owner(fluid.size());
  std::vector<std::uint64_t> count(out.size(), 0);
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    owner[i] = domains.owner(fluid.position(i));
    ++count[static_cast<std::size_t>(owner[i])];
  }
  constexpr std::size_t particle_bytes = sizeof(double) * (1 + FluidParticles<D>::field_count);
  for (std::size_t rank = 0; rank < out.size(); ++rank) {
    out[rank].reserve(sizeof(std::uint64_t) + count[rank] * particle_bytes);
    put(out[rank], count[rank]);
  }
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    Buffer& buffer = out[static_cast<std::size_t>(owner[i])];
    put(buffer, fluid.id[i]);
    for (const auto& values : fluid.field) put(buffer, values[i]);
  }
  for (const Solid<D>& solid : state.solids)
    put_solid(out[static_cast<std::size_t>(domains.owner(solid.x))], solid, solid.x, true);

  state.fluid.release();
  state.solids.clear();
  const std::vector<Buffer> received = communicator.exchange_all(std::move(out));
  std::uint64_t total = 0;
  for (const Buffer& buffer : received) total += BufferReader(buffer).get<std::uint64_t>();
  state.fluid.resize(total);
  std::size_t i = 0;
  for (const Buffer& buffer : received) {
    BufferReader reader(buffer);
    for (auto particles = reader.get<std::uint64_t>(); particles > 0; --particles, ++i) {
      state.fluid.id[i] = reader.get<std::uint64_t>();
      for (auto& values : state.fluid.field) values[i] = reader.get<double>();
    }
    while (!reader.at_end()) state.solids.push_back(get_solid<D>(reader));
  }
  std::sort(state.solids.begin(), state.solids.end(), [](const Solid<D>& a, const Solid<D>& b) { return a.id < b.id; });
}

#define MAPPM_INSTANTIATE(D)                                                                                        \
  template Domains<D> domains_by_load<D>(const Model<D>&, const Domains<D>&, const Communicator&, const State<D>&); \
  template void redistribute<D>(const Domains<D>&, const Communicator&, State<D>&);
MAPPM_INSTANTIATE(2)
MAPPM_INSTANTIATE(3)
#undef MAPPM_INSTANTIATE

}  // namespace mappm
