#include "parallel/engine.hpp"

#include <chrono>
#include <utility>

#include "parallel/redistribute.hpp"

namespace mappm {

namespace {

enum Phase { exchange_phase, sort_phase, pair_phase, solid_phase, integrate_phase };

/// Adds the seconds since its construction, or since the last call, to a phase.
class Stopwatch {
 public:
  explicit Stopwatch(double (&seconds)[5]) : seconds_(seconds) {}
  void end(Phase phase) {
    const auto now = std::chrono::steady_clock::now();
    seconds_[phase] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  double (&seconds_)[5];
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Cells to a cutoff, by measurement (bench/fluid_pass.cpp, 39 and 77 neighbours): narrow along a row, where they only
/// order its particles; across, more rows would leave more lanes empty.
template <int D>
Vec<D, int> cells_per_cutoff() {
  Vec<D, int> cells;
  cells[0] = 8;
  for (int axis = 1; axis < D; ++axis) cells[axis] = 1;
  return cells;
}

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
      state_(std::move(state)) {
  rebalance();
}

template <int D>
void ParallelEngine<D>::rebalance() {
  if (communicator_.size() > 1) {
    domains_ = domains_by_load(model_, domains_, communicator_, state_);
    redistribute(model_, domains_, communicator_, state_);
  }
  start_domains();
}

template <int D>
void ParallelEngine<D>::start_domains() {
  before_ = traffic();
  halo_ = std::make_unique<Halo<D>>(model_, domains_, communicator_);
  grid_.fit(halo_->region(), model_.pair.length, cells_per_cutoff<D>());
  if (model_.shapes.empty()) return;
  Vec<D, double> low = in_cutoffs(model_, halo_->region().low), high = in_cutoffs(model_, halo_->region().high);
  double smallest = model_.largest_reach;
  for (const Shape<D>& shape : model_.shapes) smallest = std::min(smallest, shape.reach);
  for (int axis = 0; axis < D; ++axis) {
    low[axis] -= solid_margin(model_);
    high[axis] += solid_margin(model_);
  }
  levels_ = std::make_unique<CellLevels<D>>(low, high, model_.largest_reach, smallest);
}

template <int D>
PhaseSeconds ParallelEngine<D>::phase_seconds() const {
  return {{"exchange", seconds_[exchange_phase]},
          {"sort", seconds_[sort_phase]},
          {"pairs", seconds_[pair_phase]},
          {"solids", seconds_[solid_phase]},
          {"integrate", seconds_[integrate_phase]}};
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
  Stopwatch watch(seconds_);
  halo_->exchange(state_, copies_);
  watch.end(exchange_phase);
  place_solids();
  watch.end(solid_phase);
  grid_.sort(state_.fluid);
  watch.end(sort_phase);
  std::visit([&](auto& pass) { pass.sum(state_.fluid, grid_, frozen_, frozen_sums_); }, pass_);
  watch.end(pair_phase);
  explain_pairs();
  if (model_.terms.solids) {
    sum_frozen_densities();
    std::vector<HomeReport<D>> reports = collect_reports();
    watch.end(solid_phase);
    reports = halo_->send_home(copies_, std::move(reports));
    watch.end(exchange_phase);
    move_solids(reports);
    watch.end(solid_phase);
  }
  move_fluid();
  ++state_.step;
  watch.end(integrate_phase);
}

template <int D>
void ParallelEngine<D>::place_solids() {
  bodies_.clear();
  frozen_.clear();
  if (!model_.terms.solids) return;
  levels_->clear();
  const auto add = [&](const Solid<D>& solid) {
    const auto index = static_cast<std::uint32_t>(bodies_.size());
    bodies_.push_back(solid_in_step(model_, solid));
    levels_->add(index, in_cutoffs(model_, solid.x), bodies_.back().shape->reach);
    if (model_.terms.fluid) place_frozen(model_, bodies_.back(), index, halo_->reach(), frozen_);
  };
  for (const Solid<D>& solid : state_.solids) add(solid);
  for (const Solid<D>& solid : copies_) add(solid);
}

/// What the pass summed, taken apart where that was asked for: the ledger of the faces, the trace of one PP.
template <int D>
void ParallelEngine<D>::explain_pairs() {
  faces_.clear();
  if (options_.faces > 0 && (state_.step + 1) % options_.faces == 0) {
    const FaceLedger<D> ledger(model_, domains_, halo_->region(), grid_);
    faces_ = ledger.faces(state_.fluid, frozen_);
    faces_.push_back({all_partners, ledger.received(state_.fluid, pass_, frozen_, frozen_sums_)});
  }
  trace_.reset();
  if (!traced_particle_.has_value()) return;
  const auto partners =
      std::visit([&](auto& pass) { return pass.trace(state_.fluid, grid_, frozen_, *traced_particle_); }, pass_);
  if (partners) {
    trace_ = StepTrace<D>{state_.step, *traced_particle_, *partners};
    for (PartnerTrace<D>& partner : trace_->partners)
      if (partner.frozen) partner.id = bodies_[partner.id].solid->id;
  }
  traced_particle_.reset();
}

/// An FP also counts the matter of other solids within rcut. Only FPs of solids that near each other are looked at.
template <int D>
void ParallelEngine<D>::sum_frozen_densities() {
  if (frozen_.empty()) return;  // solids alone: no FP is placed
  std::vector<std::size_t> first(bodies_.size() + 1, frozen_.size());
  for (std::size_t k = frozen_.size(); k-- > 0;) first[frozen_[k].solid] = k;
  for (std::size_t b = bodies_.size(); b-- > 0;) first[b] = std::min(first[b], first[b + 1]);
  const auto near = [&](std::size_t body, const SolidInStep<D>& other) {
    std::vector<std::size_t> chosen;
    const double reach = other.shape->reach + 1.0;
    for (std::size_t k = first[body]; k < first[body + 1]; ++k) {
      const Vec<D, double> r = separation(model_.pair, frozen_[k].place.x - other.solid->x);
      if (dot(r, r) < reach * reach) chosen.push_back(k);
    }
    return chosen;
  };
  with_pair_law(model_, [&]<class Kernel, bool transport>(Kernel, std::bool_constant<transport>) {
    for (std::uint32_t a = 0; a < bodies_.size(); ++a) {
      const SolidInStep<D>& one = bodies_[a];
      levels_->for_each_near(in_cutoffs(model_, one.solid->x), one.shape->reach, 1.0, [&](std::uint32_t b) {
        const SolidInStep<D>& other = bodies_[b];
        if (one.solid->group == other.solid->group) return;
        const std::vector<std::size_t> others = near(b, one);
        if (others.empty()) return;
        for (const std::size_t k : near(a, other))
          for (const std::size_t n : others) {
            const FrozenInStep<D>&fp = frozen_[k], &partner = frozen_[n];
            const Vec<D, double> r = separation(model_.pair, fp.place.x - partner.place.x);
            frozen_sums_[k].density +=
                pair_density<Kernel>(model_.pair, r, fp.place.v - partner.place.v, cut_distance(dot(r, r)));
          }
      });
    }
  });
}

/// Sums the FPs in this region onto their solids: owned ones into `loads_`, copies into reports for their owners.
template <int D>
std::vector<HomeReport<D>> ParallelEngine<D>::collect_reports() {
  const std::size_t owned = state_.solids.size();
  loads_.assign(owned, {});
  std::vector<HomeReport<D>> reports(copies_.size());
  for (std::size_t c = 0; c < copies_.size(); ++c) reports[c].solid = copies_[c].id;
  for (std::size_t k = 0; k < frozen_.size(); ++k) {
    const FrozenInStep<D>& fp = frozen_[k];
    if (!halo_->region().contains(fp.place.x)) continue;
    const double density = frozen_density(fp, frozen_sums_[k].density);
    if (fp.solid < owned) {
      add_frozen_load(fp, frozen_sums_[k].impulse, loads_[fp.solid].fluid);
      state_.solids[fp.solid].density[fp.index] = density;
    } else {
      HomeReport<D>& report = reports[fp.solid - owned];
      add_frozen_load(fp, frozen_sums_[k].impulse, report.fluid);
      report.index.push_back(fp.index);
      report.density.push_back(density);
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
    for (std::size_t k = 0; k < report.index.size(); ++k) home->density[report.index[k]] = report.density[k];
  }
  if (model_.terms.contact)
    for (std::size_t a = 0; a < state_.solids.size(); ++a) {
      const SolidInStep<D>& one = bodies_[a];
      levels_->for_each_near(in_cutoffs(model_, one.solid->x), one.shape->reach, 0.0, [&](std::uint32_t b) {
        const SolidInStep<D>& other = bodies_[b];
        if (one.solid->id != other.solid->id && is_nearest_image(*one.solid, *other.solid))
          add_contacts(model_, one, other, loads_[a]);
      });
      add_face_contacts(model_, one, loads_[a]);
    }
  for (std::size_t a = 0; a < state_.solids.size(); ++a) {
    const std::string fault =
        finish_step(model_, state_.step, state_.solids[a], std::move(loads_[a]), state_.outside_impulse);
    if (range_error_.empty()) range_error_ = fault;
  }
}

/// Keeps the first fault of PP i as the error of the run.
template <int D>
[[gnu::noinline]] void ParallelEngine<D>::report(RangeFault fault, std::uint32_t i, const Vec<D, double>& v,
                                                 const NeighbourSums<D>& sums) {
#pragma omp critical
  if (range_error_.empty()) range_error_ = range_message(fault, state_.step, state_.fluid.id[i], v, sums);
}

/// Moves the owned PPs, which fill the inner cells, and drops the ghosts.
template <int D>
void ParallelEngine<D>::move_fluid() {
  FluidParticles<D>& fluid = state_.fluid;
  const ParticleStep<D> constants = particle_step(model_, state_.step);
  struct Row {
    std::uint32_t first, last;
    int plane;
  };
  std::vector<Row> rows;
  Vec<D, int> row;
  const auto add_row = [&] {
    const std::size_t cells = grid_.row(row) + static_cast<std::size_t>(grid_.margin(0));
    rows.push_back({grid_.start(cells), grid_.start(cells + static_cast<std::size_t>(grid_.inner(0))), row[D - 1]});
  };
  const auto first_inner = [&](int axis) { return grid_.margin(axis); };
  const auto end_inner = [&](int axis) { return grid_.margin(axis) + grid_.inner(axis); };
  for (row[D - 1] = first_inner(D - 1); row[D - 1] < end_inner(D - 1); ++row[D - 1]) {
    if constexpr (D == 2)
      add_row();
    else
      for (row[1] = first_inner(1); row[1] < end_inner(1); ++row[1]) add_row();
  }
  std::vector<Vec<D, Int128>> given(model_.terms.force_field ? rows.size() : 0);  // by the field of force, to each row
  const auto move = [&]<bool field>(const auto& pass, std::bool_constant<field>) {
#pragma omp parallel for num_threads(options_.threads) schedule(static) if (options_.threads > 1)
    for (std::size_t n = 0; n < rows.size(); ++n)
      for (std::uint32_t i = rows[n].first; i < rows[n].last; ++i) {
        Vec<D, double> x, v;
        for (int axis = 0; axis < D; ++axis) {
          x[axis] = fluid.x(axis)[i];
          v[axis] = fluid.v(axis)[i];
        }
        NeighbourSums<D> sums = pass.sums(i, rows[n].plane);
        if constexpr (field) {
          const Vec<D, std::int64_t> impulse = field_impulse(model_.fluid_field, x);
          sums.impulse += impulse;
          for (int axis = 0; axis < D; ++axis) given[n][axis] += impulse[axis];
        }
        const RangeFault fault = advance(x, v, fluid.density()[i], sums, constants);
        if (fault != RangeFault::none) [[unlikely]]
          report(fault, i, v, sums);
        for (int axis = 0; axis < D; ++axis) {
          fluid.x(axis)[i] = wrap_position(x[axis]);
          fluid.v(axis)[i] = v[axis];
        }
      }
  };
  std::visit([&](const auto& pass) { with_force_field(model_, state_.step, [&](auto field) { move(pass, field); }); },
             pass_);
  for (const Vec<D, Int128>& impulse : given) state_.outside_impulse += impulse;
  std::size_t kept = 0;
  for (const auto& [first, last, plane] : rows) {
    std::copy(fluid.id.begin() + first, fluid.id.begin() + last, fluid.id.begin() + static_cast<std::ptrdiff_t>(kept));
    for (auto& values : fluid.field)
      std::copy(values.begin() + first, values.begin() + last, values.begin() + static_cast<std::ptrdiff_t>(kept));
    kept += last - first;
  }
  fluid.resize(kept);
  for (int axis = 0; axis < D; ++axis)
    state_.outside_impulse[axis] +=
        static_cast<Int128>(kept) * static_cast<std::int64_t>(constants.kick[axis] / velocity_quantum);
}

template class ParallelEngine<2>;
template class ParallelEngine<3>;

}  // namespace mappm
