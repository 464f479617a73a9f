#include "output/fastest.hpp"

#include <cmath>
#include <limits>
#include <span>

namespace mappm {

template <int D>
Fastest<D> find_fastest(const FluidParticles<D>& fluid, const Vec<D, double>& mean, const Group& group) {
  double own = 0.0;
  Vec<D, double> position;
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    double square = 0.0;
    for (int axis = 0; axis < D; ++axis) {
      const double v = fluid.v(axis)[i] - mean[axis];
      square += v * v;
    }
    if (square <= own) continue;
    own = square;
    position = fluid.position(i);
  }
  double largest[] = {own};
  group.maximum(std::span<double>(largest));
  Fastest<D> fastest{std::sqrt(largest[0]), position};
  if (own < largest[0])
    for (double& x : fastest.position.component) x = -std::numeric_limits<double>::infinity();
  group.maximum(std::span<double>(fastest.position.component));
  return fastest;
}

template Fastest<2> find_fastest<2>(const FluidParticles<2>&, const Vec<2, double>&, const Group&);
template Fastest<3> find_fastest<3>(const FluidParticles<3>&, const Vec<3, double>&, const Group&);

}  // namespace mappm
