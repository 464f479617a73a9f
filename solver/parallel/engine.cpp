#include "parallel/engine.hpp"

#include <algorithm>
#include <utility>

#include "parallel/fluid_motion.hpp"
#include "parallel/pass_trace.hpp"
#include "parallel/redistribute.hpp"

namespace mappm {

namespace {

template <int D>
Vec<D, double> in_cutoffs(const Model<D>& model, const Vec<D, double>& x) {
  Vec<D, double> lengths;
  for (int axis = 0; axis < D; ++axis) lengths[axis] = x[axis] * model.pair.length[axis];
  return lengths;
}

/// False for an image of `b` that is not the one nearest to `a`: in a small box a solid has two images in reach.
template <int D>
bool is_nearest_image(const Solid<D>& a, const Solid<D>& b) {
  for (int axis = 0; axis < D; ++axis)
    if (nearest_difference(a.x[axis], b.x[axis]) != a.x[axis] - b.x[axis]) return false;
  return true;
}

}  // namespace

template <int D>
ParallelEngine<D>::ParallelEngine(const Model<D>& model, const Domains<D>& domains, const Communicator& communicator,
                                  State<D>&& state, const ParallelOptions& options)
    : model_(model),
      communicator_(communicator),
      domains_(domains),
      options_(options),
      pass_(make_pass(model, options.threads)),
      densities_(model),
      state_(std::move(state)) {
  rebalance();
}

/// Ends the stay of the PPs.
template <int D>
State<D>& ParallelEngine<D>::state() {
  if (residents_ == nullptr || !residents_->staying()) return state_;
  residents_->leave(state_.fluid);
  for (int axis = 0; axis < D; ++axis)
    for (double& x : state_.fluid.x(axis)) x = wrap_position(x);
  return state_;
}

template <int D>
void ParallelEngine<D>::rebalance() {
  state();
  if (communicator_.size() > 1) {
    domains_ = domains_by_load(model_, domains_, communicator_, state_);
    redistribute(domains_, communicator_, state_);
  }
  start_domains();
}

template <int D>
void ParallelEngine<D>::start_domains() {
  before_ = traffic();
  halo_ = std::make_unique<Halo<D>>(model_, domains_, communicator_);
  residents_ = std::make_unique<Residents<D>>(model_, halo_->region(), halo_->needed());
  Vec<D, double> in_reach;  // length of a quantum
  for (int axis = 0; axis < D; ++axis) in_reach[axis] = model_.pair.length[axis] / (1.0 + skin);
  if (model_.terms.fluid) grid_.fit(halo_->region(), in_reach, cells_per_reach(model_, 1.0 + skin));
  if (!model_.terms.solids) return;
  Vec<D, double> low = in_cutoffs(model_, halo_->region().low), high = in_cutoffs(model_, halo_->region().high);
  double smallest = model_.largest_reach;
  for (const Shape<D>& shape : model_.shapes)
    if (shape.reach > 0.0) smallest = std::min(smallest, shape.reach);  // of a wall without fluid nothing is placed
  for (int axis = 0; axis < D; ++axis) {
    low[axis] -= solid_margin(model_);
    high[axis] += solid_margin(model_);
  }
  levels_ = std::make_unique<CellLevels<D>>(low, high, model_.largest_reach, smallest);
}

template <int D>
Traffic ParallelEngine<D>::traffic() const {
  Traffic sum = before_;
  if (halo_ == nullptr) return sum;
  const Traffic& now = halo_->traffic();
  sum.messages += now.messages;
  sum.bytes += now.bytes;
  sum.neighbours = now.neighbours;
  return sum;
}

/// The paper's steps (i)-(xi): copies from the neighbours, interactions, loads of copies sent home, motion. Particles
/// that leave the region go to their new owner with the next exchange.
template <int D>
void ParallelEngine<D>::step() {
  if (options_.rebalance > 0 && state_.step > 0 && state_.step % options_.rebalance == 0) rebalance();
  times_.start();
  if (traced_particle_.has_value() || faces_due()) state();  // what explains the pairs wants them in their cells
  if (model_.terms.fluid)
    std::visit([&](auto& pass) { step_with_fluid(pass); }, pass_);
  else
    step_of_solids_alone();
  traced_particle_.reset();
  ++state_.step;
  times_.end(Phase::integrate);
}

template <int D>
template <class Pass>
void ParallelEngine<D>::step_with_fluid(Pass& pass) {
  auto forces = sum_forces(sum_densities(pass, Purpose::step));
  explain_pairs(forces);
  step_solids();
  move_fluid(forces);
}

template <int D>
void ParallelEngine<D>::step_of_solids_alone() {
  exchange_solids();
  trace_.reset();
  faces_.clear();
  if (faces_due()) faces_.push_back({all_partners, {}});  // nothing goes through them
  step_solids();
}

template <int D>
void ParallelEngine<D>::exchange_solids() {
  halo_->exchange(state_, *residents_, copies_, times_);
  place_solids();
  times_.end(Phase::solids);
}

template <int D>
void ParallelEngine<D>::step_solids() {
  if (!model_.terms.solids) return;
  std::vector<HomeReport<D>> reports = collect_reports();
  times_.end(Phase::solids);
  reports = halo_->send_home(copies_, std::move(reports));
  times_.end(Phase::copies);
  move_solids(reports);
  times_.end(Phase::solids);
}

/// Copies from the neighbours, and the densities of what lies in the region.
template <int D>
template <class Pass>
auto ParallelEngine<D>::sum_densities(Pass& pass, Purpose purpose) ->
    typename Pass::template Sums<Stage::known_densities> {
  halo_->begin_exchange(state_, *residents_, times_);
  std::optional<typename Pass::template Sums<Stage::inner_densities>> inner;
  if (residents_->staying()) {  // what needs no message, while they are on their way
    inner = pass.sum_inner_densities(grid_);
    times_.end(Phase::densities);
  }
  const bool stay = halo_->end_exchange(state_, *residents_, copies_, times_);
  place_solids();
  times_.end(Phase::solids);
  if (!stay) {
    list_pairs(pass, purpose == Purpose::step && residents_->schedule().pays() ? StayLength::several_steps
                                                                               : StayLength::single_step);
    inner = pass.sum_inner_densities(grid_);
  }
  auto densities = std::move(*inner).sum_rest(state_.fluid, grid_);
  times_.end(Phase::densities);
  densities.add_frozen(grid_, solids_.frozen, frozen_density_sums_);
  times_.end(Phase::frozen_pairs);
  if (model_.terms.solids) densities_.add(solids_, *levels_, frozen_density_sums_);
  times_.end(Phase::solids);
  density_.resize(state_.fluid.size());
  auto known = std::move(densities).close(residents_->others(), density_);
  close_frozen_densities();
  times_.end(Phase::densities);
  return known;
}

/// Begins a stay: a new order of the PPs, and the lists of their pairs.
template <int D>
template <class Pass>
void ParallelEngine<D>::list_pairs(Pass& pass, StayLength length) {
  grid_.sort(state_.fluid);
  find_rows();
  residents_->settle(state_.fluid, length);
  ++orderings_;
  times_.end(Phase::sort);
  pass.list(state_.fluid, grid_, residents_->may_come_to_own(), length == StayLength::single_step ? 1.0 : 1.0 + skin,
            residents_->foreign(), halo_->traffic().neighbours > 0);
  times_.end(Phase::lists);
}

/// Of those in the region; faults of all densities are noted.
template <int D>
void ParallelEngine<D>::close_frozen_densities() {
  const auto wrong = find_out_of_range(density_, model_.rest_density);
  for (std::size_t i = wrong.value_or(density_.size()); i < density_.size(); ++i)
    note_density(model_, {state_.step, FaultOrigin::What::fluid_density, state_.fluid.id[i]}, density_[i], fault_);
  for (std::size_t k = 0; k < solids_.frozen.size(); ++k) {
    FrozenInStep<D>& fp = solids_.frozen[k];
    if (!halo_->region().contains(fp.place.x)) continue;
    set_density(model_, fp, summed_density(frozen_density_sums_[k], fp.own_density));
    const std::uint64_t solid = solids_.bodies[fp.solid].solid->id;
    note_density(model_, {state_.step, FaultOrigin::What::frozen_density, solid, fp.index}, fp.density, fault_);
  }
}

/// Densities of ghosts, and what needs none of them while they are on their way.
template <int D>
template <class Numbers>
StepSums<D, Numbers, Stage::forces> ParallelEngine<D>::sum_forces(
    StepSums<D, Numbers, Stage::known_densities>&& densities) {
  halo_->begin_densities(state_.fluid, *residents_, density_, solids_);
  times_.end(Phase::exchange);
  auto inner = std::move(densities).sum_inner(grid_);
  times_.end(Phase::pairs);
  halo_->end_densities(*residents_, density_, solids_);
  times_.end(Phase::exchange);
  auto forces = std::move(inner).sum_rest(density_, grid_);
  times_.end(Phase::pairs);
  forces.add_frozen(grid_, solids_.frozen, frozen_sums_);
  times_.end(Phase::frozen_pairs);
  return forces;
}

/// As the next step will see them.
template <int D>
Sample<D> ParallelEngine<D>::sample() {
  const PhaseTimes times = times_;
  state();
  if (model_.terms.fluid)
    std::visit([&](auto& pass) { static_cast<void>(sum_densities(pass, Purpose::output)); }, pass_);
  else
    exchange_solids();
  DensityField<D> field;
  for (std::size_t i = 0; i < state_.fluid.size(); ++i)
    if (halo_->region().contains(state_.fluid.position(i))) field.fluid.push_back(density_[i]);
  for (const FrozenInStep<D>& fp : solids_.frozen)
    if (halo_->region().contains(fp.place.x)) field.frozen.push_back(point_of(fp, *solids_.bodies[fp.solid].solid));
  times_ = times;
  return {state(), std::move(field)};
}

template <int D>
void ParallelEngine<D>::place_solids() {
  solids_.clear();
  if (!model_.terms.solids) return;
  levels_->clear();
  const auto add = [&](const Solid<D>& solid) {
    const auto index = static_cast<std::uint32_t>(solids_.bodies.size());
    const SolidInStep<D>& body = solids_.bodies.emplace_back(solid_in_step(model_, solid));
    levels_->add(index, in_cutoffs(model_, solid.x), body.shape->reach);
    if (model_.terms.fluid) place_frozen(model_, body, index, halo_->reach(), solids_.frozen);
    solids_.first.push_back(solids_.frozen.size());
  };
  for (const Solid<D>& solid : state_.solids) add(solid);
  for (const Solid<D>& solid : copies_) add(solid);
}

/// What the pass summed, taken apart where that was asked for: the ledger of the faces, the trace of one PP.
template <int D>
template <class Forces>
void ParallelEngine<D>::explain_pairs(const Forces& forces) {
  faces_.clear();
  if (faces_due()) {
    const FaceLedger<D> ledger(model_, domains_, halo_->region(), grid_);
    faces_ = ledger.faces(state_.fluid, density_, solids_.frozen);
    faces_.push_back({all_partners, impulse_received(forces)});
  }
  trace_.reset();
  if (!traced_particle_.has_value()) return;
  const auto partners = trace_partners(forces, state_.fluid, grid_, solids_.frozen, *traced_particle_);
  if (!partners) return;
  trace_ = StepTrace<D>{state_.step, *traced_particle_, *partners};
  for (PartnerTrace<D>& partner : trace_->partners)
    if (partner.frozen) partner.id = solids_.bodies[partner.id].solid->id;
}

/// Impulse (iota) that the pass summed for all PPs and FPs in the region.
template <int D>
template <class Forces>
Vec<D, Int128> ParallelEngine<D>::impulse_received(const Forces& forces) const {
  Vec<D, Int128> sum{};
  const auto add = [&](const Vec<D, std::int64_t>& impulse) {
    for (int axis = 0; axis < D; ++axis) sum[axis] += impulse[axis];
  };
  for (std::uint32_t i = 0; i < state_.fluid.size(); ++i)
    if (halo_->region().contains(state_.fluid.position(i))) add(forces.sums(forces.pass().blocks().slot(i)).impulse);
  for (std::size_t k = 0; k < solids_.frozen.size(); ++k)
    if (halo_->region().contains(solids_.frozen[k].place.x)) add(frozen_sums_[k].impulse);
  return sum;
}

/// Sums the FPs in this region onto their solids: owned ones into `loads_`, copies into reports for their owners.
template <int D>
std::vector<HomeReport<D>> ParallelEngine<D>::collect_reports() {
  const std::size_t owned = state_.solids.size();
  loads_.assign(owned, {});
  std::vector<HomeReport<D>> reports(copies_.size());
  for (std::size_t c = 0; c < copies_.size(); ++c) reports[c].solid = copies_[c].id;
  for (std::size_t k = 0; k < solids_.frozen.size(); ++k) {
    const FrozenInStep<D>& fp = solids_.frozen[k];
    if (!halo_->region().contains(fp.place.x)) continue;
    if (fp.solid < owned) {
      add_frozen_load(fp, frozen_sums_[k].impulse, loads_[fp.solid].fluid);
    } else {
      HomeReport<D>& report = reports[fp.solid - owned];
      add_frozen_load(fp, frozen_sums_[k].impulse, report.fluid);
      report.any = true;
    }
  }
  return reports;
}

template <int D>
void ParallelEngine<D>::move_solids(const std::vector<HomeReport<D>>& from_others) {
  for (const HomeReport<D>& report : from_others) {
    const auto home = std::lower_bound(state_.solids.begin(), state_.solids.end(), report.solid,
                                       [](const Solid<D>& solid, std::uint64_t id) { return solid.id < id; });
    SolidImpulse<D>& fluid = loads_[static_cast<std::size_t>(home - state_.solids.begin())].fluid;
    fluid.linear += report.fluid.linear;
    fluid.angular += report.fluid.angular;
  }
  if (model_.terms.contact)
    for (std::size_t a = 0; a < state_.solids.size(); ++a) {
      const SolidInStep<D>& one = solids_.bodies[a];
      levels_->for_each_near(in_cutoffs(model_, one.solid->x), one.shape->reach, 0.0, [&](std::uint32_t b) {
        const SolidInStep<D>& other = solids_.bodies[b];
        if (one.solid->id != other.solid->id && is_nearest_image(*one.solid, *other.solid))
          add_contacts(model_, one, other, loads_[a]);
      });
      add_face_contacts(model_, one, loads_[a]);
    }
  note_overlaps(model_, state_.step, loads_, overlaps_);
  for (std::size_t a = 0; a < state_.solids.size(); ++a) {
    Solid<D>& solid = state_.solids[a];
    fault_.note({state_.step, FaultOrigin::What::solid_motion, solid.id},
                finish_step(model_, state_.step, solid, std::move(loads_[a]), state_.outside_impulse));
  }
}

template <int D>
void ParallelEngine<D>::find_rows() {
  rows_.clear();
  Vec<D, int> row;
  const auto add_row = [&] {
    const std::size_t cells = grid_.row(row) + static_cast<std::size_t>(grid_.margin(0));
    rows_.push_back({grid_.start(cells), grid_.start(cells + static_cast<std::size_t>(grid_.inner(0))), row[D - 1]});
  };
  const auto first_inner = [&](int axis) { return grid_.margin(axis); };
  const auto end_inner = [&](int axis) { return grid_.margin(axis) + grid_.inner(axis); };
  for (row[D - 1] = first_inner(D - 1); row[D - 1] < end_inner(D - 1); ++row[D - 1]) {
    if constexpr (D == 2)
      add_row();
    else
      for (row[1] = first_inner(1); row[1] < end_inner(1); ++row[1]) add_row();
  }
}

/// Moves the PPs that lie in the region: most of those in the inner cells, and some that came in since these were
/// filled.
template <int D>
template <class Forces>
void ParallelEngine<D>::move_fluid(Forces& forces) {
  FluidMotion<D> all(model_, state_.step, halo_->region(), fault_);
  const auto& blocks = forces.pass().blocks();
#pragma omp parallel num_threads(options_.threads) if (options_.threads > 1)
  {
    FluidMotion<D> motion(model_, state_.step, halo_->region(), fault_);
#pragma omp for schedule(static)
    for (std::size_t n = 0; n < rows_.size(); ++n) {
      const Row& row = rows_[n];
      motion.move(forces, state_.fluid, row.first, row.first + blocks.gap(row.plane), row.last - row.first);
    }
#pragma omp critical
    all.add(motion);
  }
  for (const std::uint32_t i : residents_->near_outside()) all.move(forces, state_.fluid, i, blocks.slot(i), 1);
  residents_->schedule().owned_moved(all.farthest());
  state_.outside_impulse += all.impulse();
}

template class ParallelEngine<2>;
template class ParallelEngine<3>;

}  // namespace mappm
