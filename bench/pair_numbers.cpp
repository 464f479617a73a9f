// What the numbers of the pair pass cost, a fluid in disorder as in `fluid_pass`: prints one line a ratio of speeds,
// the median over rounds in which all kinds of numbers take their turn.
//   single.NAME.single_over_double             floats and 32-bit sums, against double precision
//   exactness.NAME.floating_over_integer       floating-point sums against exact ones: what exactness costs. Only where
//                                              the build has both (MAPPM_FLOATING_SUMS)
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <string>
#include <vector>

#include "parallel/fluid_pass.hpp"
#include "sorted_fluid.hpp"
#ifdef MAPPM_FLOATING_SUMS
#include "parallel/floating_lanes.hpp"
#endif

namespace mappm {
namespace {

constexpr int rounds = 41;

/// Of this process: what else the machine does does not count.
double seconds_now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Seconds of the processor for the two passes, of densities and of forces.
template <int D, class Numbers>
class Timed {
 public:
  explicit Timed(bench::SortedFluid<D>& fluid) : fluid_(fluid), pass_(fluid.fluid.model, 1) {
    fluid.list(pass_);
    run();
  }
  double run() {
    const double start = seconds_now();
    fluid_.sum(pass_);
    return seconds_now() - start;
  }

 private:
  bench::SortedFluid<D>& fluid_;
  FluidPass<D, Numbers> pass_;
};

class Ratio {
 public:
  void add(double value) { values_.push_back(value); }
  void print(const std::string& name) {
    std::sort(values_.begin(), values_.end());
    fmt::print("ratio {} {:.4g}\n", name, values_[values_.size() / 2]);
  }

 private:
  std::vector<double> values_;
};

template <int D>
void measure(const std::string& name, std::uint64_t side) {
  bench::SortedFluid<D> fluid(side);
  Timed<D, DoubleLanes<D>> exact(fluid);
  Timed<D, SingleLanes<D>> single(fluid);
  Ratio single_ratio;
#ifdef MAPPM_FLOATING_SUMS
  Timed<D, FloatingLanes<D>> floating(fluid);
  Ratio floating_ratio;
#endif
  for (int round = 0; round < rounds; ++round) {
    const double seconds = exact.run();
    single_ratio.add(seconds / single.run());
#ifdef MAPPM_FLOATING_SUMS
    floating_ratio.add(exact.run() / floating.run());
#endif
  }
  single_ratio.print(fmt::format("single.{}.single_over_double", name));
#ifdef MAPPM_FLOATING_SUMS
  floating_ratio.print(fmt::format("exactness.{}.floating_over_integer", name));
#endif
}

}  // namespace
}  // namespace mappm

int main() {
  mappm::measure<2>("fluid_2d_39", 320);
  mappm::measure<3>("fluid_3d_77", 48);
}
