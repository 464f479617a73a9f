#include "parallel/halo.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>
#include <utility>

#include "parallel/solid_message.hpp"
#include "particles/frozen.hpp"

namespace mappm {

template <int D>
Halo<D>::Halo(const Model<D>& model, const Domains<D>& domains, const Communicator& communicator)
    : model_(model),
      domains_(domains),
      communicator_(communicator),
      region_(domains.region(communicator.rank())),
      reach_(widened(model, region_, 1.0)),
      solid_reach_(widened(model, region_, solid_margin(model))),
      interior_(widened(model, region_, -1.0 - skin)),
      solid_interior_(widened(model, region_, -solid_margin(model))),
      images_(domains.images(communicator.rank())),
      partners_(domains.partners(communicator.rank())),
      out_(partners_.size()),
      in_(partners_.size()),
      selected_(images_.size()) {
  for (const int partner : partners_) traffic_.neighbours += partner != communicator.rank() ? 1 : 0;
  for (const Image<D>& image : images_) {
    image_reach_.push_back(widened(model, image.region, 1.0));
    NeededRegion<D>& needed = needed_.emplace_back();
    needed.region = widened(model, image.region, 1.0 + skin);
    if (partners_[static_cast<std::size_t>(image.partner)] == communicator.rank()) needed.image_shift = image.shift;
    image_solid_reach_.push_back(widened(model, image.region, solid_margin(model)));
  }
}

template <int D>
void Halo<D>::send_messages() {
  for (std::size_t n = 0; n < partners_.size(); ++n) {
    if (partners_[n] == communicator_.rank()) continue;
    ++traffic_.messages;
    traffic_.bytes += out_[n].size();
  }
  communicator_.send(partners_, out_);
}

template <int D>
void Halo<D>::receive_messages() {
  communicator_.receive(partners_, out_, in_);
  for (Buffer& buffer : out_) buffer.clear();
}

/// The periodic image of a position that is nearest to the middle of the region.
template <int D>
Vec<D, double> Halo<D>::in_frame(Vec<D, double> x) const {
  for (int axis = 0; axis < D; ++axis) {
    const double from_middle = x[axis] - 0.5 * (region_.low[axis] + region_.high[axis]);
    if (from_middle >= 0.5 * box_quanta) x[axis] -= box_quanta;
    if (from_middle < -0.5 * box_quanta) x[axis] += box_quanta;
  }
  return x;
}

template <int D>
void Halo<D>::begin_exchange(State<D>& state, Residents<D>& residents, PhaseTimes& times) {
  // Alone, a process ends its stay when it must.
  const std::uint64_t plan = traffic_.neighbours > 0 ? residents.schedule().plan(state.step) : StaySchedule::never;
  if (!residents.schedule().lasts()) residents.leave(state.fluid);
  for (Buffer& buffer : out_) put(buffer, plan);
  pack_fluid(state.fluid, residents);
  times.end(Phase::exchange);
  pack_solids(state.solids);
  times.end(Phase::copies);
  send_messages();
  times.end(Phase::exchange);
}

template <int D>
bool Halo<D>::end_exchange(State<D>& state, Residents<D>& residents, std::vector<Solid<D>>& copies, PhaseTimes& times) {
  receive_messages();
  std::vector<BufferReader> readers(in_.begin(), in_.end());
  for (BufferReader& reader : readers) residents.schedule().adopt_plan(state.step, reader.get<std::uint64_t>());
  const std::vector<BufferReader> of_fluid = readers;
  const bool stay = residents.schedule().lasts() && residents.refresh(state.fluid, readers);
  if (!stay) {
    if (residents.staying()) {
      residents.leave(state.fluid);
      choose(state.fluid, true);
    }
    add_own_images(state.fluid);
    readers = of_fluid;
    for (BufferReader& reader : readers) unpack_fluid(reader, state.fluid);
  }
  times.end(Phase::exchange);
  unpack_solids(readers, state.solids, copies);
  times.end(Phase::copies);
  return stay;
}

/// Outside a stay: the PPs needed elsewhere. Those near the border of the region, or beyond it, are moved to its frame,
/// where those that stay are already.
template <int D>
void Halo<D>::choose(FluidParticles<D>& fluid, bool own_images_alone) {
  const auto is_own = [](const NeededRegion<D>& needed) { return needed.image_shift.has_value(); };
  if (own_images_alone && std::ranges::none_of(needed_, is_own)) return;
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    Vec<D, double> x = fluid.position(i);
    if (interior_.contains(x)) continue;
    x = in_frame(x);
    for (int axis = 0; axis < D; ++axis) fluid.x(axis)[i] = x[axis];
    for (std::size_t n = 0; n < images_.size(); ++n) {
      if (own_images_alone && !needed_[n].image_shift) continue;
      if (needed_[n].region.contains(x)) selected_[n].push_back(static_cast<std::uint32_t>(i));
    }
  }
}

/// Message to each partner, behind the plan: number of PPs, then their ids, then field by field. Images of own PPs need
/// none.
template <int D>
void Halo<D>::pack_fluid(FluidParticles<D>& fluid, const Residents<D>& residents) {
  for (auto& chosen : selected_) chosen.clear();
  if (residents.staying()) {
    for (std::size_t n = 0; n < images_.size(); ++n)
      if (!needed_[n].image_shift) residents.select(fluid, n, selected_[n]);
  } else {
    choose(fluid, false);
  }
  for (std::size_t partner = 0; partner < partners_.size(); ++partner) {
    Buffer& buffer = out_[partner];
    std::uint64_t count = 0;
    if (partners_[partner] == communicator_.rank()) {
      put(buffer, count);
      continue;
    }
    for_each_image_of(partner, [&](std::size_t n) { count += selected_[n].size(); });
    std::byte* to = extend(buffer, sizeof count * (1 + count * (1 + FluidParticles<D>::field_count)));
    write(to, count);
    for_each_image_of(partner, [&](std::size_t n) {
      for (const std::uint32_t i : selected_[n]) write(to, fluid.id[i]);
    });
    for (int f = 0; f < FluidParticles<D>::field_count; ++f)
      for_each_image_of(partner, [&](std::size_t n) {
        const double shift = f < D ? images_[n].shift[f] : 0.0;
        const auto& values = fluid.field[static_cast<std::size_t>(f)];
        for (const std::uint32_t i : selected_[n]) write(to, values[i] + shift);
      });
  }
}

template <int D>
void Halo<D>::add_own_images(FluidParticles<D>& fluid) const {
  std::size_t first = fluid.size(), size = first;
  for (std::size_t n = 0; n < images_.size(); ++n)
    if (needed_[n].image_shift) size += selected_[n].size();
  fluid.resize(size);
  for (std::size_t n = 0; n < images_.size(); ++n) {
    if (!needed_[n].image_shift) continue;
    const auto add = [&](auto& values, const auto& shift) {
      for (std::size_t k = 0; k < selected_[n].size(); ++k) values[first + k] = values[selected_[n][k]] + shift;
    };
    add(fluid.id, std::uint64_t{0});
    for (int f = 0; f < FluidParticles<D>::field_count; ++f)
      add(fluid.field[static_cast<std::size_t>(f)], f < D ? (*needed_[n].image_shift)[f] : 0.0);
    first += selected_[n].size();
  }
}

template <int D>
void Halo<D>::unpack_fluid(BufferReader& reader, FluidParticles<D>& fluid) {
  const auto count = reader.get<std::uint64_t>();
  const std::size_t first = fluid.size();
  fluid.resize(first + count);
  if (count == 0) return;
  std::memcpy(&fluid.id[first], reader.skip<std::uint64_t>(count), count * sizeof(std::uint64_t));
  for (auto& values : fluid.field) std::memcpy(&values[first], reader.skip<double>(count), count * sizeof(double));
}

/// Behind the PPs, for each image: number of solids, then these.
template <int D>
void Halo<D>::pack_solids(std::vector<Solid<D>>& solids) {
  std::vector<const Solid<D>*> outward;
  for (Solid<D>& solid : solids) {
    solid.x = in_frame(solid.x);
    if (!solid_interior_.contains(solid.x)) outward.push_back(&solid);
  }
  for (std::size_t n = 0; n < images_.size(); ++n) {
    Buffer& buffer = out_[static_cast<std::size_t>(images_[n].partner)];
    std::uint64_t count = 0;
    for (const Solid<D>* solid : outward) count += image_solid_reach_[n].contains(solid->x) ? 1 : 0;
    put(buffer, count);
    for (const Solid<D>* solid : outward)
      if (image_solid_reach_[n].contains(solid->x)) pack_solid(*solid, n);
  }
}

/// Sorts what was here and what came into solids owned and copies.
template <int D>
void Halo<D>::unpack_solids(std::vector<BufferReader>& readers, std::vector<Solid<D>>& solids,
                            std::vector<Solid<D>>& copies) const {
  std::vector<Solid<D>> here;
  copies.clear();
  for (Solid<D>& solid : solids) {
    if (region_.contains(solid.x))
      here.push_back(std::move(solid));
    else if (solid_reach_.contains(solid.x))
      copies.push_back(std::move(solid));
  }
  for (BufferReader& reader : readers)
    while (!reader.at_end())
      for (auto count = reader.get<std::uint64_t>(); count > 0; --count) {
        Solid<D> solid = get_solid<D>(reader);
        (region_.contains(solid.x) ? here : copies).push_back(std::move(solid));
      }
  std::sort(here.begin(), here.end(), [](const Solid<D>& a, const Solid<D>& b) { return a.id < b.id; });
  solids = std::move(here);
}

/// The new owner receives the contacts.
template <int D>
void Halo<D>::pack_solid(const Solid<D>& solid, std::size_t image) {
  put_solid(out_[static_cast<std::size_t>(images_[image].partner)], solid, solid.x + images_[image].shift,
            images_[image].region.contains(solid.x));
}

/// Message to each partner: number of PPs, their ids, their densities; then the FPs.
template <int D>
void Halo<D>::begin_densities(const FluidParticles<D>& fluid, const Residents<D>& residents, std::span<double> density,
                              const PlacedSolids<D>& solids) {
  residents.copy_densities(fluid, density);
  for (std::size_t n = 0; n < images_.size(); ++n) {
    selected_[n].clear();
    if (needed_[n].image_shift) continue;
    residents.select(fluid, n, selected_[n]);
    std::erase_if(selected_[n], [&](std::uint32_t i) { return !image_reach_[n].contains(fluid.position(i)); });
  }
  for (std::size_t partner = 0; partner < partners_.size(); ++partner) {
    std::uint64_t count = 0;
    for_each_image_of(partner, [&](std::size_t n) { count += selected_[n].size(); });
    std::byte* to = extend(out_[partner], sizeof count * (1 + 2 * count));
    write(to, count);
    for_each_image_of(partner, [&](std::size_t n) {
      for (const std::uint32_t i : selected_[n]) write(to, fluid.id[i]);
    });
    for_each_image_of(partner, [&](std::size_t n) {
      for (const std::uint32_t i : selected_[n]) write(to, density[i]);
    });
  }
  put_frozen_densities(solids);
  send_messages();
}

namespace {

/// Density of an FP in a message.
struct FrozenDensity {
  std::uint64_t solid;  // id
  std::uint64_t index;  // in its shape
  double density;
};

}  // namespace

template <int D>
void Halo<D>::put_frozen_densities(const PlacedSolids<D>& solids) {
  for (const FrozenInStep<D>& fp : solids.frozen) {
    if (!region_.contains(fp.place.x)) continue;
    for (std::size_t n = 0; n < images_.size(); ++n)
      if (image_reach_[n].contains(fp.place.x))
        put(out_[static_cast<std::size_t>(images_[n].partner)],
            FrozenDensity{solids.bodies[fp.solid].solid->id, fp.index, fp.density});
  }
}

template <int D>
void Halo<D>::end_densities(Residents<D>& residents, std::span<double> density, PlacedSolids<D>& solids) {
  receive_messages();
  std::vector<BufferReader> readers(in_.begin(), in_.end());
  for (std::size_t n = 0; n < readers.size(); ++n) residents.take_densities(n, readers[n], density);
  take_frozen_densities(readers, solids);
}

/// All images of an FP have its density.
template <int D>
void Halo<D>::take_frozen_densities(std::vector<BufferReader>& readers, PlacedSolids<D>& solids) const {
  std::unordered_multimap<std::uint64_t, std::size_t> bodies;  // by the id of their solid
  for (BufferReader& reader : readers)
    while (!reader.at_end()) {
      if (bodies.empty())
        for (std::size_t b = 0; b < solids.bodies.size(); ++b) bodies.emplace(solids.bodies[b].solid->id, b);
      const auto given = reader.get<FrozenDensity>();
      const auto [first, last] = bodies.equal_range(given.solid);
      for (auto body = first; body != last; ++body) {
        const auto begin = solids.frozen.begin() + static_cast<std::ptrdiff_t>(solids.first[body->second]);
        const auto end = solids.frozen.begin() + static_cast<std::ptrdiff_t>(solids.first[body->second + 1]);
        const auto fp = std::lower_bound(
            begin, end, given.index, [](const FrozenInStep<D>& one, std::uint64_t index) { return one.index < index; });
        if (fp != end && fp->index == given.index) set_density(model_, *fp, given.density);
      }
    }
}

template <int D>
std::vector<HomeReport<D>> Halo<D>::send_home(const std::vector<Solid<D>>& copies,
                                              std::vector<HomeReport<D>>&& reports) {
  for (std::size_t c = 0; c < copies.size(); ++c) {
    if (!reports[c].any) continue;
    const int owner = domains_.owner(copies[c].x);
    const auto partner = std::lower_bound(partners_.begin(), partners_.end(), owner) - partners_.begin();
    Buffer& buffer = out_[static_cast<std::size_t>(partner)];
    put(buffer, reports[c].solid);
    put(buffer, reports[c].fluid);
  }
  send_messages();
  receive_messages();
  std::vector<HomeReport<D>> received;
  for (const Buffer& buffer : in_) {
    BufferReader reader(buffer);
    while (!reader.at_end()) {
      HomeReport<D>& report = received.emplace_back();
      report.solid = reader.get<std::uint64_t>();
      report.fluid = reader.get<SolidImpulse<D>>();
    }
  }
  return received;
}

template class Halo<2>;
template class Halo<3>;

}  // namespace mappm
