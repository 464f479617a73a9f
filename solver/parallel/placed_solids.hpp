// The solids of a step on one process, and their FPs.
#pragma once

#include <cstddef>
#include <vector>

#include "particles/frozen.hpp"

namespace mappm {

template <int D>
struct PlacedSolids {
  std::vector<SolidInStep<D>> bodies;   // owned, then copies
  std::vector<FrozenInStep<D>> frozen;  // those of a body side by side, in the order of the bodies
  std::vector<std::size_t> first;       // FP of each body, and the end of the last

  void clear() {
    bodies.clear();
    frozen.clear();
    first.assign(1, 0);
  }
};

}  // namespace mappm
