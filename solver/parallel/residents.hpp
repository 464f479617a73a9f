// The PPs on a process that keep their order in memory over some steps, a stay: with them the lists of pairs stay, and
// the ghosts, which are brought up to date in place. What a process owns follows in each step from positions alone, as
// ever; so every process can end its stay at any step, whatever the others do.
//
// At the start of a stay the PPs within rcut + skin of the region are here, and all pairs nearer than that are listed.
// Nothing is missed while no PP has moved farther than skin / 2 since, for then only what was here can be within rcut
// of what lies in the region. A stay ends when
//   - the largest displacements of the steps add up to skin / 2;
//   - a PP that was not here comes within rcut + skin / 2 of the region: it has moved farther than that, or came from
//     beyond a neighbour, who sends it on only in the step after;
//   - one that was here, and nearer than that, is sent no more: it has left all at once.
//
// It can end at any earlier step, and does where a neighbour's does. Making lists takes about as long as a step, and
// the neighbours wait for whoever makes them: so all do best to make theirs in the same steps. Each message says in
// which step the sender's stay will end as far as it sees; who hears that may take the plan over, and says so in its
// own messages.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "parallel/ghost_table.hpp"
#include "parallel/message.hpp"
#include "parallel/stay_schedule.hpp"
#include "particles/model.hpp"
#include "particles/state.hpp"

namespace mappm {

/// `region` widened by a length (rcut) on every side, to whole quanta.
template <int D>
Region<D> widened(const Model<D>& model, Region<D> region, double margin);

/// Where the PPs lie that are needed elsewhere: by another process, or by this one across a periodic border, where it
/// needs their images.
template <int D>
struct NeededRegion {
  Region<D> region;
  std::optional<Vec<D, double>> image_shift;  // to these images, quanta
};

template <int D>
class Residents {
 public:
  Residents(const Model<D>& model, const Region<D>& region, const std::vector<NeededRegion<D>>& needed);

  bool staying() const { return schedule_.staying(); }
  /// When the stay ends.
  const StaySchedule& schedule() const { return schedule_; }
  StaySchedule& schedule() { return schedule_; }
  /// All that can come to lie in the region during a stay.
  const Region<D>& may_come_to_own() const { return may_come_to_own_; }

  /// Starts a stay. `fluid`: all PPs here, in the order that they will keep.
  void settle(const FluidParticles<D>& fluid, StayLength length);
  /// Adds the PPs that this process owns and that lie in region n of `needed` now.
  void select(const FluidParticles<D>& fluid, std::size_t n, std::vector<std::uint32_t>& chosen) const;
  /// PPs that others own or may come to own, and images of owned ones: all those that `refresh` can change.
  std::span<const std::uint32_t> foreign() const { return foreign_; }
  /// PPs that were outside the region at the start of the stay and may lie in it now.
  std::span<const std::uint32_t> near_outside() const { return near_outside_; }
  /// PPs that this process does not own in this step.
  std::vector<std::uint32_t> others() const;

  /// In a stay that lasts: brings ghosts up to date, images of owned PPs from these and others from messages
  /// (halo.hpp), whose readers then stand behind their PPs. False where the stay ends by what they say: some ghosts may
  /// be new and others old, and `leave` is due.
  bool refresh(FluidParticles<D>& fluid, std::span<BufferReader> readers);
  /// In any step, once ghosts are up to date: gives images of owned PPs the density of these.
  void copy_densities(const FluidParticles<D>& fluid, std::span<double> density) const;
  /// Gives ghosts the densities in a message of this sender: their number, ids, and densities (PPs per rcut^D). All
  /// images of a PP have its density.
  void take_densities(std::size_t sender, BufferReader& reader, std::span<double> density);
  /// Ends a stay: only what this process owned in the last step remains in `fluid`.
  void leave(FluidParticles<D>& fluid);

 private:
  static constexpr std::uint32_t none = GhostTable::none;
  struct Candidate {
    std::uint32_t particle;  // its index
    std::uint32_t near;      // its number in foreign_; `none` where it is owned throughout
    std::uint32_t image;     // the number of its image in foreign_; `none` where that is not here
  };
  bool is_needed(const FluidParticles<D>& fluid, std::size_t n, const Candidate& candidate) const {
    return (candidate.near == none || owned_[candidate.near] != 0) &&
           needed_[n].region.contains(fluid.position(candidate.particle));
  }
  void sort_out(const FluidParticles<D>& fluid);
  void find_images(const FluidParticles<D>& fluid);
  bool refresh(FluidParticles<D>& fluid, BufferReader& reader, std::size_t sender);
  void refresh_images(FluidParticles<D>& fluid, std::size_t n);

  const Model<D>& model_;
  Region<D> region_, may_come_to_own_, deep_, noticed_, needless_;
  std::vector<NeededRegion<D>> needed_;
  std::vector<Region<D>> may_enter_;  // those, a skin / 2 wider
  StaySchedule schedule_;
  std::vector<std::vector<Candidate>> candidates_;  // of those in `may_enter_`
  // Indices of those that others own, or may come to own, and of images: first, `near_` of them, the ones near the
  // border of the region.
  std::vector<std::uint32_t> foreign_;
  std::size_t near_ = 0;
  std::vector<std::uint32_t> near_outside_;
  std::vector<std::uint8_t> owned_;       // of the near ones, in this step
  std::vector<std::uint8_t> up_to_date_;  // of all
  GhostTable table_;                      // of all, by their numbers in foreign_
  MessageOrder states_, densities_;
};

}  // namespace mappm
