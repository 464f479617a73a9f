// The parallel engine: the paper's algorithm on a grid of domains, with two message pairs a neighbour and step.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "parallel/communicator.hpp"
#include "parallel/domains.hpp"
#include "parallel/face_ledger.hpp"
#include "parallel/fluid_pass.hpp"
#include "parallel/frozen_densities.hpp"
#include "parallel/halo.hpp"
#include "parallel/phase_times.hpp"
#include "parallel/placed_solids.hpp"
#include "parallel/residents.hpp"
#include "particles/cell_levels.hpp"
#include "particles/engine.hpp"

namespace mappm {

struct ParallelOptions {
  int threads = 1;
  std::uint64_t rebalance = 0;  // steps between moves of the domain borders to the particle load; 0: never
  std::uint64_t faces = 0;      // steps between ledgers of the faces of the domains; 0: none
  std::uint64_t last_step = 0;  // of the run: it has a ledger as well
};

template <int D>
class ParallelEngine final : public Engine<D> {
 public:
  /// `state`: this process' share under `domains`. The borders are first moved to the particle load.
  ParallelEngine(const Model<D>& model, const Domains<D>& domains, const Communicator& communicator, State<D>&& state,
                 const ParallelOptions& options);

  void step() override;
  std::uint64_t present_step() const override { return state_.step; }
  State<D>& state() override;
  Sample<D> sample() override;
  const FirstFault& first_fault() const override { return fault_; }
  const FirstOverlaps& overlaps() const override { return overlaps_; }
  PhaseSeconds phase_seconds() const override { return times_.seconds(); }
  std::optional<DomainReport<D>> domain_report() const override {
    return DomainReport<D>{traffic(), orderings_, domains_.cuts()};
  }
  std::vector<FaceImpulse<D>> faces() const override { return faces_; }
  /// Steps so far in which the PPs of this process were put in order anew.
  std::uint64_t orderings() const { return orderings_; }
  const Domains<D>& domains() const { return domains_; }

  void trace_next_step(std::uint64_t particle) override { traced_particle_ = particle; }
  const MaybeTrace<D>& last_trace() const override { return trace_; }

  /// Moves the borders of the domains to the particle load and every particle to its new owner.
  void rebalance();

 private:
  Traffic traffic() const;
  void start_domains();
  bool faces_due() const {
    const std::uint64_t step = state_.step + 1;
    return options_.faces > 0 && (step % options_.faces == 0 || step == options_.last_step);
  }
  /// What densities are summed for. Output asks for them in no step: what follows from them is not kept.
  enum class Purpose { step, output };
  template <class Pass>
  void step_with_fluid(Pass& pass);
  void step_of_solids_alone();
  void exchange_solids();
  void step_solids();
  void place_solids();
  template <class Pass>
  auto sum_densities(Pass& pass, Purpose purpose) -> typename Pass::template Sums<Stage::known_densities>;
  template <class Pass>
  void list_pairs(Pass& pass, StayLength length);
  void close_frozen_densities();
  template <class Numbers>
  StepSums<D, Numbers, Stage::forces> sum_forces(StepSums<D, Numbers, Stage::known_densities>&& densities);
  template <class Forces>
  void explain_pairs(const Forces& forces);
  template <class Forces>
  Vec<D, Int128> impulse_received(const Forces& forces) const;
  void find_rows();
  template <class Forces>
  void move_fluid(Forces& forces);
  std::vector<HomeReport<D>> collect_reports();
  void move_solids(const std::vector<HomeReport<D>>& from_others);

  const Model<D>& model_;
  const Communicator& communicator_;
  Domains<D> domains_;
  ParallelOptions options_;
  std::unique_ptr<Halo<D>> halo_;
  std::unique_ptr<Residents<D>> residents_;
  CellGrid<D> grid_;
  std::unique_ptr<CellLevels<D>> levels_;
  ModelPass<D> pass_;
  FrozenDensities<D> densities_;
  State<D> state_;  // with ghosts, and positions in the frame of the region, while PPs stay

  /// PPs of the inner cells of a row, as they were ordered last.
  struct Row {
    std::uint32_t first, last;
    int plane;
  };
  std::vector<Row> rows_;

  // Of the present step:
  std::vector<Solid<D>> copies_;
  PlacedSolids<D> solids_;  // owned, then copies
  Column<double> density_;  // of the PPs
  std::vector<std::int64_t> frozen_density_sums_;
  std::vector<NeighbourSums<D>> frozen_sums_;
  std::vector<SolidLoad<D>> loads_;  // of owned solids

  std::vector<FaceImpulse<D>> faces_;
  std::optional<std::uint64_t> traced_particle_;  // in the next step
  MaybeTrace<D> trace_;

  std::uint64_t orderings_ = 0;
  FirstFault fault_;
  FirstOverlaps overlaps_;
  PhaseTimes times_;
  Traffic before_;  // of the domains before the present ones
};

}  // namespace mappm
