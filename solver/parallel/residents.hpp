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

#include "parallel/message.hpp"
#include "particles/model.hpp"
#include "particles/state.hpp"

namespace mappm {

/// In rcut. More of it makes stays longer and lists wider: from .06 to .2, a step took least time between .1 and .12,
/// in the plane and in space.
inline constexpr double skin = 0.1;
static_assert(skin < 0.15, "blocks that lists join must be told apart in single precision (largest_extent)");

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

  bool staying() const { return staying_; }
  /// False where the owned PPs have moved so far that the stay must end now, or where that is the plan.
  bool lasts() const { return staying_ && !ending_ && used() <= allowance; }
  /// For the neighbours, at the start of a step: in which step this stay ends, `never` if that is not yet to be seen.
  std::uint64_t plan(std::uint64_t step);
  /// Takes over the plan of a neighbour unless that makes this stay shorter by more than half, or not worth its lists.
  void adopt_plan(std::uint64_t step, std::uint64_t plan);
  static constexpr std::uint64_t never = ~std::uint64_t{0};
  /// Whether lists that are kept will pay in a stay that begins now: whether it can last for some steps like the last,
  /// and stays did of late, whatever ended them. Where they did not, it is tried again from time to time.
  bool pays() const {
    constexpr int tries = 2, pause = 16;
    return (worthwhile - 1) * last_farthest_ <= allowance && (short_stays_ < tries || short_stays_ % pause == 0);
  }
  /// All that can come to lie in the region during a stay.
  const Region<D>& may_come_to_own() const { return may_come_to_own_; }

  /// Starts a stay, which may be one of a single step. `fluid`: all PPs here, in the order that they will keep.
  void settle(const FluidParticles<D>& fluid, bool single_step = false);
  /// Adds those of the PPs that this process owns that lie in region n of `needed` now.
  void select(const FluidParticles<D>& fluid, std::size_t n, std::vector<std::uint32_t>& chosen) const;
  /// PPs that others own or may come to own, and images of owned ones: all those that `refresh` can change.
  std::span<const std::uint32_t> foreign() const { return foreign_; }
  /// PPs that were outside the region at the start of the stay and may lie in it now.
  std::span<const std::uint32_t> near_outside() const { return near_outside_; }
  /// PPs that this process does not own in this step.
  std::vector<std::uint32_t> others() const;
  /// Largest displacement of the owned PPs in the step made now, rcut.
  void moved(double farthest) { farthest_ = last_farthest_ = farthest; }

  /// In a stay that lasts: brings ghosts up to date, images of owned PPs from these and others from messages
  /// (halo.hpp), whose readers then stand behind their PPs. False where the stay ends by what they say: some ghosts may
  /// be new and others old, and `leave` is due.
  bool refresh(FluidParticles<D>& fluid, std::span<BufferReader> readers);
  /// In any step, once ghosts are up to date: gives images of owned PPs the density of these.
  void copy_densities(const FluidParticles<D>& fluid, std::span<double> density) const;
  /// Gives ghosts the densities in message n: their number, ids, and densities (PPs per rcut^D). All images of a PP
  /// have its density.
  void take_densities(const FluidParticles<D>& fluid, std::size_t n, BufferReader& reader, std::span<double> density);
  /// Ends a stay: only what this process owned in the last step remains in `fluid`.
  void leave(FluidParticles<D>& fluid);

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  static constexpr double allowance = 0.5 * skin - 1e-6;  // less what distances and positions may be off, rcut
  static constexpr int worthwhile = 3;                    // steps
  double used() const { return travelled_ + farthest_; }
  const std::uint32_t* probe_of(std::uint64_t id) const;
  const std::uint32_t* next(const std::uint32_t* probe) const;
  bool refresh(FluidParticles<D>& fluid, BufferReader& reader, std::vector<std::uint32_t>& sequence);
  void refresh_images(FluidParticles<D>& fluid, std::size_t n);

  const Model<D>& model_;
  Region<D> region_, may_come_to_own_, deep_, noticed_, needless_;
  std::vector<NeededRegion<D>> needed_;
  std::vector<Region<D>> may_enter_;  // those, a skin / 2 wider
  bool staying_ = false;
  int steps_ = 0, short_stays_ = 0;  // of this stay; stays in a row that were shorter than worthwhile
  // Displacements, rcut: since the start of the stay at most, in the last step, and in that of the owned PPs alone.
  double travelled_ = 0.0, farthest_ = 0.0, last_farthest_ = 0.0;
  std::uint64_t end_ = never;  // the step planned
  bool ending_ = false;        // it has come
  struct Candidate {
    std::uint32_t particle,
        near;             // indices in the fluid and in foreign_; `near` is `none` where it is owned throughout
    std::uint32_t image;  // an index into foreign_, `none` where it is not here
  };
  bool is_needed(const FluidParticles<D>& fluid, std::size_t n, const Candidate& candidate) const {
    return (candidate.near == none || owned_[candidate.near] != 0) &&
           needed_[n].region.contains(fluid.position(candidate.particle));
  }
  std::vector<std::vector<Candidate>> candidates_;  // of those in `may_enter_`
  // Those that others own, or may come to own, and images: first, `near_` of them, the ones near the border of the
  // region.
  std::vector<std::uint32_t> foreign_;
  std::size_t near_ = 0;
  std::vector<std::uint32_t> near_outside_;
  std::vector<std::uint8_t> owned_;       // of the near ones, in this step
  std::vector<std::uint8_t> up_to_date_;  // of all
  std::vector<std::uint32_t> table_;      // hashed by id: indices into foreign_
  // A message names much the same PPs as the one before, in the same order: indices into foreign_ by message, or
  // `none`, and where each of these stood in its message.
  struct Sequences {
    std::vector<std::vector<std::uint32_t>> of_messages;
    std::vector<std::uint32_t> stood;
    void clear(std::size_t count) {
      for (auto& sequence : of_messages) sequence.clear();
      stood.assign(count, 0);
    }
  };
  Sequences states_, densities_;
  std::vector<std::uint32_t> sequence_;  // of the message that is read
  std::vector<std::uint32_t>
      twins_;  // of each entry of foreign_ another image of its PP, in a circle; itself where it is alone
};

}  // namespace mappm
