// The reference engine: one process, plain loops in double, a step that reads like the paper.
#pragma once

#include <optional>
#include <vector>

#include "particles/engine.hpp"
#include "particles/frozen.hpp"
#include "particles/model.hpp"
#include "particles/state.hpp"
#include "serial/neighbours.hpp"

namespace mappm {

template <int D>
class SerialEngine final : public Engine<D> {
 public:
  SerialEngine(const Model<D>& model, State<D>&& state, Neighbours neighbours);

  void step() override;
  std::uint64_t present_step() const override { return state_.step; }
  State<D>& state() override { return state_; }
  Sample<D> sample() override;
  const FirstFault& first_fault() const override { return fault_; }
  const FirstOverlaps& overlaps() const override { return overlaps_; }
  void trace_next_step(std::uint64_t particle) override { traced_particle_ = particle; }
  const MaybeTrace<D>& last_trace() const override { return trace_; }
  PhaseSeconds phase_seconds() const override { return {{"pairs", pair_seconds_}, {"integrate", integrate_seconds_}}; }

 private:
  void place_solids();
  void find_neighbours();
  void sum_densities();
  template <class Kernel, class Numbers>
  std::int64_t density_of_fluid(const Numbers& numbers, std::size_t i);
  template <class Kernel>
  std::int64_t density_of_frozen(std::size_t k);
  PairPoint<D> point(std::size_t i) const;
  PairPoint<D> frozen_point(std::size_t k) const;
  template <class Kernel, bool transport, class Numbers, class Visit>
  void for_each_fluid_partner(const Numbers& numbers, std::size_t i, Visit&& visit) const;
  template <class Kernel, bool transport, class Numbers, class Visit>
  void for_each_frozen_partner(const Numbers& numbers, std::size_t i, Visit&& visit) const;
  template <class Kernel, bool transport, class Numbers>
  void sum_over_fluid(const Numbers& numbers, std::size_t i);
  template <class Kernel, bool transport, class Numbers>
  void sum_over_frozen(const Numbers& numbers, std::size_t i);
  void trace_partners();
  void move_fluid();
  void move_solids();

  const Model<D>& model_;
  State<D> state_;
  NeighbourSearch<D> fluid_cells_, frozen_cells_;

  // Of the present step:
  std::vector<double> density_;              // of the PPs
  std::vector<VolumeTerms<double>> volume_;  // of the PPs
  std::vector<NeighbourSums<D>> sums_;       // of the PPs
  std::vector<SolidInStep<D>> bodies_;
  std::vector<FrozenInStep<D>> frozen_;
  std::vector<Vec<D, double>> frozen_x_;  // in the box
  std::vector<std::int64_t> frozen_density_sums_;
  std::vector<NeighbourSums<D>> frozen_sums_;

  std::optional<std::uint64_t> traced_particle_;  // in the next step
  MaybeTrace<D> trace_;

  FirstFault fault_;
  FirstOverlaps overlaps_;
  double pair_seconds_ = 0.0, integrate_seconds_ = 0.0;
};

}  // namespace mappm
