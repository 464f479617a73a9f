#include "serial/engine.hpp"

#include <algorithm>
#include <utility>

#include "base/stopwatch.hpp"

namespace mappm {

namespace {

template <int D>
Vec<D, double> position(const FluidParticles<D>& fluid, std::size_t i) {
  Vec<D, double> x;
  for (int axis = 0; axis < D; ++axis) x[axis] = fluid.x(axis)[i];
  return x;
}

template <int D>
Vec<D, double> velocity(const FluidParticles<D>& fluid, std::size_t i) {
  Vec<D, double> v;
  for (int axis = 0; axis < D; ++axis) v[axis] = fluid.v(axis)[i];
  return v;
}

template <int D>
Vec<D, double> nearest_vector(const Vec<D, double>& a, const Vec<D, double>& b) {
  Vec<D, double> d;
  for (int axis = 0; axis < D; ++axis) d[axis] = nearest_difference(a[axis], b[axis]);
  return d;
}

template <int D>
Vec<D, double> wrapped(Vec<D, double> x) {
  for (int axis = 0; axis < D; ++axis) x[axis] = wrap_position(x[axis]);
  return x;
}

/// What two particles give to the density of each other, density quanta.
template <class Kernel, class Numbers, int D>
std::int64_t density_between(const Numbers& numbers, const PairPoint<D>& i, const PairPoint<D>& j) {
  const auto r = separation(numbers.law(), pair_of(numbers, i, j, nearest_difference).d);
  return numbers.density(pair_density<Kernel>(numbers.law(), cut_distance(dot(r, r))));
}

/// A region that holds every FP wherever its solid is: a solid reaches at most half a box beyond its centre.
template <int D>
Region<D> everywhere() {
  Region<D> region;
  for (int axis = 0; axis < D; ++axis) {
    region.low[axis] = -box_quanta;
    region.high[axis] = 2.0 * box_quanta;
  }
  return region;
}

}  // namespace

template <int D>
SerialEngine<D>::SerialEngine(const Model<D>& model, State<D>&& state, Neighbours neighbours)
    : model_(model),
      state_(std::move(state)),
      fluid_cells_(model.box, model.terms.fluid ? neighbours : Neighbours::all_pairs),  // without fluid no cells
      frozen_cells_(model.box, model.terms.fluid ? neighbours : Neighbours::all_pairs) {}

/// One step of the method:
///   1. place the FPs of every solid and find neighbours,
///   2. sum the density of every PP and FP,
///   3. sum the pair law over the neighbours of every PP; an FP receives the opposite impulse,
///   4. kick and drift the PPs; sum the impulses of the FPs onto their solids, add contacts, kick and drift these.
template <int D>
void SerialEngine<D>::step() {
  Stopwatch watch;
  place_solids();
  find_neighbours();
  sum_densities();
  sums_.assign(state_.fluid.size(), {});
  frozen_sums_.assign(frozen_.size(), {});
  with_pair_numbers(model_,
                    [&]<class Kernel, bool transport>(Kernel, std::bool_constant<transport>, const auto& numbers) {
                      for (std::size_t i = 0; i < state_.fluid.size(); ++i) {
                        sum_over_fluid<Kernel, transport>(numbers, i);
                        sum_over_frozen<Kernel, transport>(numbers, i);
                      }
                    });
  pair_seconds_ += watch.lap();
  trace_partners();
  move_fluid();
  move_solids();
  ++state_.step;
  integrate_seconds_ += watch.lap();
}

template <int D>
Sample<D> SerialEngine<D>::sample() {
  place_solids();
  find_neighbours();
  sum_densities();
  Sample<D> sample{state_, {density_, {}}};
  for (const FrozenInStep<D>& fp : frozen_) sample.density.frozen.push_back(point_of(fp, state_.solids[fp.solid]));
  return sample;
}

template <int D>
void SerialEngine<D>::place_solids() {
  bodies_.clear();
  frozen_.clear();
  for (const Solid<D>& solid : state_.solids) {
    bodies_.push_back(solid_in_step(model_, solid));
    if (model_.terms.fluid)
      place_frozen(model_, bodies_.back(), static_cast<std::uint32_t>(bodies_.size() - 1), everywhere<D>(), frozen_);
  }
}

template <int D>
void SerialEngine<D>::find_neighbours() {
  fluid_cells_.clear();
  for (std::size_t i = 0; i < state_.fluid.size(); ++i) fluid_cells_.add(position(state_.fluid, i));
  frozen_cells_.clear();
  frozen_x_.clear();
  for (const FrozenInStep<D>& fp : frozen_) {
    frozen_x_.push_back(wrapped(fp.place.x));
    frozen_cells_.add(frozen_x_.back());
  }
}

/// Pressure and volume of every PP and FP, by the density that its neighbours give it.
template <int D>
void SerialEngine<D>::sum_densities() {
  const FluidParticles<D>& fluid = state_.fluid;
  density_.resize(fluid.size());
  volume_.resize(fluid.size());
  frozen_density_sums_.assign(frozen_.size(), 0);
  with_pair_numbers(model_, [&]<class Kernel>(Kernel, auto, const auto& numbers) {
    for (std::size_t i = 0; i < fluid.size(); ++i)
      density_[i] = summed_density(density_of_fluid<Kernel>(numbers, i), model_.self_density);
    for (std::size_t k = 0; k < frozen_.size(); ++k)
      set_density(model_, frozen_[k], summed_density(density_of_frozen<Kernel>(k), frozen_[k].own_density));
  });
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    volume_[i] = volume_terms(density_[i], model_.rest_density, 1.0, model_.background);
    note_density(model_, {state_.step, FaultOrigin::What::fluid_density, fluid.id[i]}, density_[i], fault_);
  }
  for (const FrozenInStep<D>& fp : frozen_)
    note_density(model_, {state_.step, FaultOrigin::What::frozen_density, state_.solids[fp.solid].id, fp.index},
                 fp.density, fault_);
}

/// What other PPs and the FPs give to the density of PP i; an FP gets as much from the PP.
template <int D>
template <class Kernel, class Numbers>
std::int64_t SerialEngine<D>::density_of_fluid(const Numbers& numbers, std::size_t i) {
  const PairPoint<D> one = point(i);
  std::int64_t sum = 0;
  fluid_cells_.for_each_near(one.x, [&](int neighbour) {
    const auto j = static_cast<std::size_t>(neighbour);
    if (j != i) sum += density_between<Kernel>(numbers, one, point(j));
  });
  frozen_cells_.for_each_near(one.x, [&](int neighbour) {
    const auto k = static_cast<std::size_t>(neighbour);
    const std::int64_t given = density_between<Kernel>(numbers, one, frozen_point(k));
    sum += given;
    frozen_density_sums_[k] += given;
  });
  return sum;
}

/// What PPs, other solids and images of its own one give to the density of FP k.
template <int D>
template <class Kernel>
std::int64_t SerialEngine<D>::density_of_frozen(std::size_t k) {
  const FrozenInStep<D>& fp = frozen_[k];
  std::int64_t sum = frozen_density_sums_[k];
  frozen_cells_.for_each_near(frozen_x_[k], [&](int neighbour) {
    const auto n = static_cast<std::size_t>(neighbour);
    const FrozenInStep<D>& other = frozen_[n];
    const Vec<D, double> d = nearest_vector(frozen_x_[k], frozen_x_[n]);
    const bool images = !(d == fp.place.x - other.place.x);
    if (!give_each_other_density(model_, state_.solids[fp.solid], state_.solids[other.solid], images)) return;
    const Vec<D, double> r = separation(model_.pair, d);
    sum += pair_density<Kernel>(model_.pair, cut_distance(dot(r, r)));
  });
  return sum;
}

/// PP i as a pair reads it.
template <int D>
PairPoint<D> SerialEngine<D>::point(std::size_t i) const {
  return {position(state_.fluid, i), velocity(state_.fluid, i), volume_[i]};
}

template <int D>
PairPoint<D> SerialEngine<D>::frozen_point(std::size_t k) const {
  return {frozen_x_[k], frozen_[k].place.v, frozen_[k].volume};
}

/// Calls visit(j, given) with what PP j gives to PP i.
template <int D>
template <class Kernel, bool transport, class Numbers, class Visit>
void SerialEngine<D>::for_each_fluid_partner(const Numbers& numbers, std::size_t i, Visit&& visit) const {
  const PairPoint<D> one = point(i);
  fluid_cells_.for_each_near(one.x, [&](int neighbour) {
    const auto j = static_cast<std::size_t>(neighbour);
    if (j == i) return;
    const auto pair = pair_of(numbers, one, point(j), nearest_difference);
    const auto r = separation(numbers.law(), pair.d);
    const auto beta = static_cast<typename Numbers::Real>(1);
    visit(j, numbers.sums(fluid_pair<Kernel, transport>(numbers.law(), pair, r, cut_distance(dot(r, r)), beta)));
  });
}

/// Calls visit(k, given) with what FP k gives to PP i.
template <int D>
template <class Kernel, bool transport, class Numbers, class Visit>
void SerialEngine<D>::for_each_frozen_partner(const Numbers& numbers, std::size_t i, Visit&& visit) const {
  const PairPoint<D> one = point(i);
  frozen_cells_.for_each_near(one.x, [&](int neighbour) {
    const auto k = static_cast<std::size_t>(neighbour);
    const FrozenInStep<D>& fp = frozen_[k];
    const NoSlipFactor<D, typename Numbers::Real> beta(model_, fp);
    const auto pair = pair_of(numbers, one, frozen_point(k), nearest_difference);
    const auto r = separation(numbers.law(), pair.d);
    visit(k, numbers.sums(fluid_pair<Kernel, transport>(numbers.law(), pair, r, cut_distance(dot(r, r)), beta(r))));
  });
}

template <int D>
template <class Kernel, bool transport, class Numbers>
void SerialEngine<D>::sum_over_fluid(const Numbers& numbers, std::size_t i) {
  NeighbourSums<D>& sums = sums_[i];
  for_each_fluid_partner<Kernel, transport>(numbers, i, [&](std::size_t, const NeighbourSums<D>& given) {
    sums.impulse += given.impulse;
    sums.shift += given.shift;
    sums.shear += given.shear;
    sums.agitation += given.agitation;
  });
}

template <int D>
template <class Kernel, bool transport, class Numbers>
void SerialEngine<D>::sum_over_frozen(const Numbers& numbers, std::size_t i) {
  NeighbourSums<D>& sums = sums_[i];
  for_each_frozen_partner<Kernel, transport>(numbers, i, [&](std::size_t k, const NeighbourSums<D>& given) {
    sums.impulse += given.impulse;
    sums.shift += given.shift;
    sums.shear += given.shear;
    sums.agitation += given.agitation;
    frozen_sums_[k].impulse -= given.impulse;
  });
}

/// What each partner gave to one PP, where that was asked for.
template <int D>
void SerialEngine<D>::trace_partners() {
  trace_.reset();
  if (!traced_particle_.has_value()) return;
  const auto& ids = state_.fluid.id;
  const auto i = static_cast<std::size_t>(std::find(ids.begin(), ids.end(), *traced_particle_) - ids.begin());
  const StepTrace<D> empty{state_.step, *traced_particle_, {}};
  traced_particle_.reset();
  if (i == ids.size()) return;
  trace_ = empty;
  const auto keep = [&](const PartnerTrace<D>& partner) {
    if (partner.any()) trace_->partners.push_back(partner);
  };
  with_pair_numbers(model_,
                    [&]<class Kernel, bool transport>(Kernel, std::bool_constant<transport>, const auto& numbers) {
                      const PairPoint<D> one = point(i);
                      for_each_fluid_partner<Kernel, transport>(numbers, i, [&](std::size_t j, const auto& given) {
                        keep({false, ids[j], 0, given, density_between<Kernel>(numbers, one, point(j))});
                      });
                      for_each_frozen_partner<Kernel, transport>(numbers, i, [&](std::size_t k, const auto& given) {
                        keep({true, state_.solids[frozen_[k].solid].id, frozen_[k].index, given,
                              density_between<Kernel>(numbers, one, frozen_point(k))});
                      });
                    });
}

template <int D>
void SerialEngine<D>::move_fluid() {
  FluidParticles<D>& fluid = state_.fluid;
  const ParticleStep<D> constants = particle_step(model_, state_.step);
  with_force_field(model_, state_.step, [&]<bool field>(std::bool_constant<field>) {
    if constexpr (field)
      for (std::size_t i = 0; i < fluid.size(); ++i) {
        const Vec<D, std::int64_t> impulse = field_impulse(model_.fluid_field, position(fluid, i));
        sums_[i].impulse += impulse;
        for (int axis = 0; axis < D; ++axis) state_.outside_impulse[axis] += impulse[axis];
      }
  });
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    Vec<D, double> x = position(fluid, i), v = velocity(fluid, i);
    const RangeFault fault = advance(x, v, sums_[i], constants);
    if (fault != RangeFault::none)
      note_motion(fault, {state_.step, FaultOrigin::What::fluid_motion, fluid.id[i]}, v, sums_[i], fault_);
    for (int axis = 0; axis < D; ++axis) {
      fluid.x(axis)[i] = wrap_position(x[axis]);
      fluid.v(axis)[i] = v[axis];
      state_.outside_impulse[axis] += static_cast<std::int64_t>(constants.kick[axis] / velocity_quantum);
    }
  }
}

template <int D>
void SerialEngine<D>::move_solids() {
  std::vector<SolidLoad<D>> loads(state_.solids.size());
  for (std::size_t k = 0; k < frozen_.size(); ++k) {
    const FrozenInStep<D>& fp = frozen_[k];
    add_frozen_load(fp, frozen_sums_[k].impulse, loads[fp.solid].fluid);
  }
  if (model_.terms.contact)
    for (std::size_t a = 0; a < bodies_.size(); ++a) {
      for (std::size_t b = 0; b < bodies_.size(); ++b)
        if (a != b) add_contacts(model_, bodies_[a], bodies_[b], loads[a]);
      add_face_contacts(model_, bodies_[a], loads[a]);
    }
  note_overlaps(model_, state_.step, loads, overlaps_);
  for (std::size_t a = 0; a < state_.solids.size(); ++a) {
    Solid<D>& solid = state_.solids[a];
    fault_.note({state_.step, FaultOrigin::What::solid_motion, solid.id},
                finish_step(model_, state_.step, solid, std::move(loads[a]), state_.outside_impulse));
  }
}

template class SerialEngine<2>;
template class SerialEngine<3>;

}  // namespace mappm
