// When a stay ends: by how far PPs have moved, and by what the neighbours plan (residents.hpp).
#pragma once

#include <cstdint>

namespace mappm {

/// In rcut. More of it makes stays longer and lists wider: from .06 to .2, a step took least time between .1 and .12,
/// in the plane and in space.
inline constexpr double skin = 0.1;
static_assert(skin < 0.15, "blocks that lists join must be told apart in single precision (largest_extent)");

/// How long the order of the PPs, and the lists of their pairs, are to serve.
enum class StayLength { several_steps, single_step };

class StaySchedule {
 public:
  static constexpr std::uint64_t never = ~std::uint64_t{0};

  void begin(StayLength length);
  void end();
  /// From `begin` to `end`.
  bool staying() const { return staying_; }
  /// False where PPs have moved so far that the stay must end now, or where that is the plan, or after its only step.
  bool lasts() const { return staying_ && length_ == StayLength::several_steps && !ending_ && used() <= allowance; }
  /// For the neighbours, at the start of a step: in which step this stay ends, `never` if that is not yet to be seen.
  std::uint64_t plan(std::uint64_t step);
  /// Takes over the plan of a neighbour unless that makes this stay shorter by more than half, or not worth its lists.
  void adopt_plan(std::uint64_t step, std::uint64_t plan);
  /// Whether lists that are kept will pay in a stay that begins now: whether it can last for some steps like the last,
  /// and stays did of late, whatever ended them. Where they did not, it is tried again from time to time.
  bool pays() const {
    constexpr int tries = 2, pause = 16;
    return (worthwhile - 1) * last_farthest_ <= allowance && (short_stays_ < tries || short_stays_ % pause == 0);
  }

  /// Largest displacement of the owned PPs in the step made now, rcut.
  void owned_moved(double farthest) { farthest_ = last_farthest_ = farthest; }
  /// The same of ghosts; after `owned_moved`.
  void ghosts_moved(double farthest) { farthest_ = farthest > farthest_ ? farthest : farthest_; }
  /// The stay goes on with another step.
  void add_step() {
    travelled_ += farthest_;
    farthest_ = 0.0;
    ++steps_;
  }

 private:
  static constexpr double allowance = 0.5 * skin - 1e-6;  // less what distances and positions may be off, rcut
  static constexpr int worthwhile = 3;                    // steps
  double used() const { return travelled_ + farthest_; }

  bool staying_ = false;
  StayLength length_ = StayLength::several_steps;
  int steps_ = 0, short_stays_ = 0;  // of this stay; stays in a row that were shorter than worthwhile
  // Displacements, rcut: since the start of the stay at most, in the last step, and in that of the owned PPs alone.
  double travelled_ = 0.0, farthest_ = 0.0, last_farthest_ = 0.0;
  std::uint64_t end_ = never;  // the step planned
  bool ending_ = false;        // it has come
};

}  // namespace mappm
