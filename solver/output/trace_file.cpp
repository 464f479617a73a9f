#include "output/trace_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>

#include "base/error.hpp"
#include "output/columns.hpp"
#include "output/durable_file.hpp"
#include "output/together.hpp"

namespace mappm {

namespace {

template <int D>
Columns columns(const StepTrace<D>& trace, const PartnerTrace<D>& partner, bool transport) {
  Columns columns;
  columns.add("step", "", trace.step);
  columns.add("particle", "", trace.particle);
  columns.add("kind", "", partner.frozen ? "FP" : "PP");
  columns.add("partner", "",
              partner.frozen ? fmt::format("{}:{}", partner.id, partner.index) : fmt::format("{}", partner.id));
  columns.add("impulse", "", partner.given.impulse);
  if (transport) columns.add("shift", "", partner.given.shift);
  columns.add("density", "", partner.density);
  return columns;
}

}  // namespace

template <int D>
std::string trace_text(const StepTrace<D>& trace, bool transport) {
  std::vector<PartnerTrace<D>> partners = trace.partners;
  // Two entries of one partner are a defect, but of a known order all the same.
  const auto key = [](const PartnerTrace<D>& partner) {
    return std::tuple(partner.frozen, partner.id, partner.index, partner.density, partner.given.impulse[0]);
  };
  std::sort(partners.begin(), partners.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  std::string text = columns<D>(trace, {}, transport).header() + '\n';
  for (const PartnerTrace<D>& partner : partners) text += columns(trace, partner, transport).row() + '\n';
  return text;
}

template <int D>
void check_traced(const FluidParticles<D>& fluid, std::uint64_t particle, const Group& group) {
  std::array<double, 1> found{std::ranges::find(fluid.id, particle) != fluid.id.end() ? 1.0 : 0.0};
  group.maximum(found);
  if (found[0] == 0.0)
    throw InputError("command line", "--trace", fmt::format("{}", particle),
                     "no PP has this id; ids of PPs stand in the snapshots, where kind is 0");
}

template <int D>
void write_trace(const std::filesystem::path& folder, const MaybeTrace<D>& trace, bool transport, const Group& group) {
  together(group, [&] {
    if (trace.has_value()) write_durably(folder / "trace.csv", trace_text(*trace, transport));
  });
}

#define MAPPM_INSTANTIATE(D)                                                         \
  template std::string trace_text<D>(const StepTrace<D>&, bool);                     \
  template void check_traced(const FluidParticles<D>&, std::uint64_t, const Group&); \
  template void write_trace<D>(const std::filesystem::path&, const MaybeTrace<D>&, bool, const Group&);
MAPPM_INSTANTIATE(2)
MAPPM_INSTANTIATE(3)
#undef MAPPM_INSTANTIATE

}  // namespace mappm
