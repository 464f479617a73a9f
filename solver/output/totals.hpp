// Sums over all particles, made of integers: the same bits on any number of processes.
#pragma once

#include <cstdint>
#include <string>

#include "base/group.hpp"
#include "base/vec.hpp"
#include "particles/density_field.hpp"
#include "particles/model.hpp"

namespace mappm {

/// Quantum in which velocities of SPs are summed, c: finer than any double of a velocity that matters.
inline constexpr double mean_velocity_quantum = 0x1p-70;

/// Quantum in which energies are summed, PP mass c^2. 2^46 such energies of 1 fit in the sum.
inline constexpr double energy_quantum = 0x1p-80;

/// Quantum in which angular momenta about the middle of the box are summed, PP mass c rcut. A spin is a whole number of
/// them.
inline constexpr double angular_quantum = 0x1p-70;

/// "SPs" are the solids other than pieces of walls; "mobile" ones are those that are not fixed.
template <int D>
struct Totals {
  std::uint64_t step = 0;
  Int128 fluid_count = 0, frozen_count = 0, sp_count = 0, mobile_count = 0;
  Vec<D, Int128> fluid_momentum{};                             // iota; in velocity quanta too, as the PP mass is 1
  Vec<D, Int128> mobile_velocity{};                            // mean_velocity_quantum
  Vec<D, Int128> sp_impulse{}, wall_impulse{};                 // from the fluid since the last sample, iota
  Int128 fluid_energy = 0, solid_energy = 0, spin_energy = 0;  // energy_quantum
  Int128 internal_energy = 0;                                  // of the PPs, by compression; energy_quantum
  AngularVec<D, Int128> angular_momentum{};      // of PPs and free or moving solids, spin included; angular_quantum
  Vec<D, Int128> momentum{}, outside_impulse{};  // of PPs and solids; iota
  Int128 digest_sum = 0;
  double lowest_density = 0.0, highest_density = 0.0;  // over PPs, PPs per rcut^D; NaN where there are none

  /// Digest of the whole state.
  std::uint64_t digest() const { return static_cast<std::uint64_t>(digest_sum); }
  std::uint64_t particles() const { return static_cast<std::uint64_t>(fluid_count + frozen_count); }
};

/// Collective: one sum and one minimum over the group.
template <int D>
Totals<D> measure(const Model<D>& model, const Sample<D>& sample, const Group& group);

/// Momentum now, less that at the start, less the impulse from outside: zero in every run, as an equality of integers.
template <int D>
Vec<D, Int128> momentum_defect(const Totals<D>& totals, const Vec<D, Int128>& start) {
  return totals.momentum - start - totals.outside_impulse;
}

/// Force in internal units of an impulse (iota) received over `steps` steps of `dt`; zero where no step was made.
template <int D>
Vec<D, double> mean_force(const Vec<D, Int128>& impulse, std::uint64_t steps, double dt) {
  Vec<D, double> force;
  if (steps == 0) return force;
  for (int axis = 0; axis < D; ++axis)
    force[axis] = static_cast<double>(impulse[axis]) * velocity_quantum / (static_cast<double>(steps) * dt);
  return force;
}

/// 16 hexadecimal digits.
std::string digest_text(std::uint64_t digest);

}  // namespace mappm
