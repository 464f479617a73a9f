#include "particles/state.hpp"

namespace mappm {

namespace {

template <int D>
std::uint64_t solid_hash(const Solid<D>& solid) {
  ParticleHash hash(~solid.id);  // solids and PPs never share an id
  for (int axis = 0; axis < D; ++axis) hash.add(solid.x[axis]).add(solid.momentum[axis]).add(solid.fluid_impulse[axis]);
  for (const Int128 component : solid.angular_momentum.component) hash.add(component);
  for (const double component : solid.orientation.component.component) hash.add(component);
  for (const Contact<D>& contact : solid.contacts) {
    hash.add(contact.partner).add(std::uint64_t{contact.own} << 32 | contact.other);
    for (const double component : contact.stretch.component) hash.add(component);
  }
  return hash.value();
}

}  // namespace

template <int D>
std::uint64_t digest_share(const State<D>& state) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < state.fluid.size(); ++i) {
    ParticleHash hash(state.fluid.id[i]);
    for (const auto& field : state.fluid.field) hash.add(field[i]);
    sum += hash.value();
  }
  for (const Solid<D>& solid : state.solids) sum += solid_hash(solid);
  return sum;
}

template <int D>
Vec<D, Int128> momentum_share(const State<D>& state) {
  Vec<D, Int128> sum{};
  for (int axis = 0; axis < D; ++axis)
    for (const double v : state.fluid.v(axis)) sum[axis] += static_cast<std::int64_t>(v / velocity_quantum);
  for (const Solid<D>& solid : state.solids) sum += solid.momentum;
  return sum;
}

template std::uint64_t digest_share<2>(const State<2>&);
template std::uint64_t digest_share<3>(const State<3>&);
template Vec<2, Int128> momentum_share<2>(const State<2>&);
template Vec<3, Int128> momentum_share<3>(const State<3>&);

}  // namespace mappm
