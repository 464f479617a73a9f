// The step of PPs that a process owns, by the sums of a pass.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/lanes.hpp"
#include "particles/first_fault.hpp"
#include "particles/model.hpp"
#include "particles/solid_step.hpp"
#include "particles/state.hpp"
#include "physics/pseudo_particle.hpp"

namespace mappm {

/// What is moved in one step, by one thread or by all. A thread keeps its own on its stack: there the compiler sees
/// that no store to a PP changes the constants, which is worth a quarter to a half of the time.
template <int D>
class FluidMotion {
 public:
  /// Only PPs in `region` will be moved. `fault` hears of each value out of its range; threads may share it.
  FluidMotion(const Model<D>& model, std::uint64_t step, const Region<D>& region, FirstFault& fault)
      : model_(model), step_(step), region_(region), constants_(particle_step(model, step)), fault_(fault) {}

  /// Moves PPs [first, first + count), which lie side by side from this slot of the pass on. `pass` gives their sums
  /// and hears of their new state.
  template <class Pass>
  MAPPM_INLINE void move(Pass& pass, FluidParticles<D>& fluid, std::uint32_t first, std::uint32_t slot,
                         std::uint32_t count) {
    with_force_field(model_, step_, [&]<bool field>(std::bool_constant<field> with_field) {
      for (std::uint32_t n = 0; n < count;) {
        if constexpr (!field)
          if ((slot + n) % lane_count == 0 && n + lane_count <= count && move_lanes(pass, fluid, first + n, slot + n)) {
            n += lane_count;
            continue;
          }
        move_one(pass, fluid, first + n, slot + n, with_field);
        ++n;
      }
    });
  }

  void add(const FluidMotion& other) {
    count_ += other.count_;
    square_ = larger(square_, other.square_);
    for (int axis = 0; axis < D; ++axis) given_[axis] += other.given_[axis];
  }
  /// Displacement of the PP that moved farthest, rcut.
  double farthest() const {
    double square = 0.0;
    for (int lane = 0; lane < lane_count; ++lane) square = larger(square, static_cast<double>(square_[lane]));
    return std::sqrt(square);
  }
  /// Impulse that body force and field of force gave to all, iota.
  Vec<D, Int128> impulse() const {
    Vec<D, Int128> impulse = given_;
    for (int axis = 0; axis < D; ++axis)
      impulse[axis] +=
          static_cast<Int128>(count_) * static_cast<std::int64_t>(constants_.kick[axis] / velocity_quantum);
    return impulse;
  }

 private:
  template <class Way>
  MAPPM_INLINE void keep_farthest(const Vec<D, Way>& way) {
    const auto length = separation(model_.pair, way);
    square_ = larger(square_, Lanes(dot(length, length)));
  }

  template <class Pass, bool field>
  MAPPM_INLINE void move_one(Pass& pass, FluidParticles<D>& fluid, std::uint32_t i, std::uint32_t slot,
                             std::bool_constant<field>) {
    Vec<D, double> x, v;
    for (int axis = 0; axis < D; ++axis) {
      x[axis] = fluid.x(axis)[i];
      v[axis] = fluid.v(axis)[i];
    }
    if (!region_.contains(x)) return;
    NeighbourSums<D> sums = pass.sums(slot);
    if constexpr (field) {
      const Vec<D, std::int64_t> impulse = field_impulse(model_.fluid_field, x);
      sums.impulse += impulse;
      for (int axis = 0; axis < D; ++axis) given_[axis] += impulse[axis];
    }
    const Vec<D, double> before = x;
    const RangeFault fault = advance(x, v, sums, constants_);
    if (fault != RangeFault::none) [[unlikely]]
      report(fault_, fault, {step_, FaultOrigin::What::fluid_motion, fluid.id[i]}, v, sums);
    for (int axis = 0; axis < D; ++axis) {
      fluid.x(axis)[i] = x[axis];
      fluid.v(axis)[i] = v[axis];
    }
    pass.moved(slot, x, v);
    keep_farthest(x - before);
    ++count_;
  }

  /// False, and nothing done, where one of them is out of range or not in the region.
  template <class Pass>
  MAPPM_INLINE bool move_lanes(Pass& pass, FluidParticles<D>& fluid, std::uint32_t i, std::uint32_t slot) {
    Vec<D, Lanes> x, v;
    auto outside = Lanes(0.0) > Lanes(0.0);
    for (int axis = 0; axis < D; ++axis) {
      x[axis] = load_lanes(&fluid.x(axis)[i]);
      v[axis] = load_lanes(&fluid.v(axis)[i]);
      outside = outside || x[axis] < region_.low[axis] || x[axis] >= region_.high[axis];
    }
    const auto motion = motion_of(x, v, pass.sums_of_lanes(slot), constants_);
    if (any_of_lanes(outside || motion.beyond.any())) [[unlikely]]
      return false;
    for (int axis = 0; axis < D; ++axis) {
      store_lanes(motion.x[axis], &fluid.x(axis)[i]);
      store_lanes(motion.v[axis], &fluid.v(axis)[i]);
    }
    pass.moved(slot, motion.x, motion.v);
    keep_farthest(motion.x - x);
    count_ += lane_count;
    return true;
  }

  [[gnu::noinline]] static void report(FirstFault& first, RangeFault fault, const FaultOrigin& origin,
                                       const Vec<D, double>& v, const NeighbourSums<D>& sums) {
#pragma omp critical
    note_motion(fault, origin, v, sums, first);
  }

  const Model<D>& model_;
  std::uint64_t step_;
  Region<D> region_;
  ParticleStep<D> constants_;
  FirstFault& fault_;
  std::uint64_t count_ = 0;
  Lanes square_{0.0};       // of the largest displacement, rcut^2
  Vec<D, Int128> given_{};  // by the field of force
};

}  // namespace mappm
