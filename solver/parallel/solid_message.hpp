// A solid as a message: its fixed part, densities of the FPs that the receiver needs, contacts.
#pragma once

#include <vector>

#include "parallel/message.hpp"
#include "particles/model.hpp"

namespace mappm {

template <int D>
struct SolidHeader {
  std::uint64_t id;
  std::uint32_t shape, group;
  SolidMotion motion;
  Vec<D, double> x;
  Vec<D, Int128> momentum;
  AngularVec<D, Int128> angular_momentum;
  Rotation<D> orientation;
  Vec<D, Int128> fluid_impulse, sampled_impulse;
};

/// `x`: the position in the receiver's frame; `frozen`: indices of the FPs whose densities go along.
template <int D>
void put_solid(Buffer& buffer, const Solid<D>& solid, const Vec<D, double>& x, const std::vector<std::uint32_t>& frozen,
               bool with_contacts) {
  put(buffer, SolidHeader<D>{solid.id, solid.shape, solid.group, solid.motion, x, solid.momentum,
                             solid.angular_momentum, solid.orientation, solid.fluid_impulse, solid.sampled_impulse});
  std::vector<double> density;
  for (const std::uint32_t k : frozen) density.push_back(solid.density[k]);
  put(buffer, frozen);
  put(buffer, density);
  put(buffer, with_contacts ? solid.contacts : std::vector<Contact<D>>{});
}

/// FPs whose densities did not come along get the rest density; the receiver never reads them.
template <int D>
Solid<D> get_solid(BufferReader& reader, const Model<D>& model) {
  const auto header = reader.get<SolidHeader<D>>();
  Solid<D> solid;
  solid.id = header.id;
  solid.shape = header.shape;
  solid.group = header.group;
  solid.motion = header.motion;
  solid.x = header.x;
  solid.momentum = header.momentum;
  solid.angular_momentum = header.angular_momentum;
  solid.orientation = header.orientation;
  solid.fluid_impulse = header.fluid_impulse;
  solid.sampled_impulse = header.sampled_impulse;
  std::vector<std::uint32_t> frozen;
  std::vector<double> density;
  reader.get(frozen);
  reader.get(density);
  reader.get(solid.contacts);
  solid.density.assign(model.shapes[solid.shape].frozen.size(), model.rest_density);
  for (std::size_t k = 0; k < frozen.size(); ++k) solid.density[frozen[k]] = density[k];
  return solid;
}

template <int D>
std::vector<std::uint32_t> all_frozen(const Solid<D>& solid) {
  std::vector<std::uint32_t> all(solid.density.size());
  for (std::uint32_t k = 0; k < all.size(); ++k) all[k] = k;
  return all;
}

}  // namespace mappm
