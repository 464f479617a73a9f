// A solid as a message: its fixed part, and its contacts.
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

/// `x`: the position in the receiver's frame.
template <int D>
void put_solid(Buffer& buffer, const Solid<D>& solid, const Vec<D, double>& x, bool with_contacts) {
  put(buffer, SolidHeader<D>{solid.id, solid.shape, solid.group, solid.motion, x, solid.momentum,
                             solid.angular_momentum, solid.orientation, solid.fluid_impulse, solid.sampled_impulse});
  put(buffer, with_contacts ? solid.contacts : std::vector<Contact<D>>{});
}

template <int D>
Solid<D> get_solid(BufferReader& reader) {
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
  reader.get(solid.contacts);
  return solid;
}

}  // namespace mappm
