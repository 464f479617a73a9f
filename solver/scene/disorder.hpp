// Random displacement of the lattice on which PPs start. Private to the builder.
#pragma once

#include <cstdint>

#include "base/digest.hpp"
#include "scene/lattice.hpp"

namespace mappm {

/// Displaces each PP along each axis by a whole number of quanta, uniform in [-reach, reach], that follows from seed,
/// id and axis alone, so that it is the same on every process. Nodes stand half a spacing from the sides of the box, so
/// that with at most `largest_disorder` no PP crosses them.
template <int D>
class Disorder {
 public:
  Disorder(const FluidScene& fluid, const Lattice<D>& lattice) {
    if (!fluid.disorder) return;
    seed_ = fluid.disorder->seed;
    for (int axis = 0; axis < D; ++axis)
      reach_[axis] =
          static_cast<std::uint64_t>(fluid.disorder->amplitude * box_quanta / static_cast<double>(lattice.count[axis]));
  }

  /// Largest displacement along an axis, position quanta; 0 on all axes without disorder.
  double reach(int axis) const { return static_cast<double>(reach_[axis]); }

  double displacement(std::uint64_t id, int axis) const {
    __extension__ using Wide = unsigned __int128;
    const std::uint64_t hash = ParticleHash(seed_).add(id).add(static_cast<std::uint64_t>(axis)).value();
    const auto drawn = static_cast<std::uint64_t>((static_cast<Wide>(hash) * (2 * reach_[axis] + 1)) >> 64);
    return static_cast<double>(drawn) - static_cast<double>(reach_[axis]);
  }

 private:
  std::uint64_t seed_ = 0;
  std::uint64_t reach_[D] = {};
};

}  // namespace mappm
