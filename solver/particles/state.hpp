// The state of a run: the PPs as one table of fields, and the solids. FPs are not stored: a solid and its shape
// determine where they are. Densities are not stored: they follow from the positions.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/column.hpp"
#include "base/digest.hpp"
#include "base/fixed_point.hpp"
#include "base/vec.hpp"
#include "physics/rigid_body.hpp"

namespace mappm {

/// Makes room for `count` values, a tenth more than needed: the doubling of a vector would cost more memory than all
/// other arrays of a step.
template <class Values>
void reserve_tightly(Values& values, std::size_t count) {
  if (count > values.capacity()) values.reserve(count + count / 10);
}

/// The field table of the PPs: it feeds allocation, halo, output, checkpoint and digest. All values are integers,
/// kept in doubles that hold them exactly: x in position quanta, v in multiples of velocity_quantum (PP mass 1, so
/// this is the momentum too).
template <int D>
struct FluidParticles {
  static constexpr int field_count = 2 * D;
  std::vector<std::uint64_t> id;
  std::array<Column<double>, field_count> field;

  Column<double>& x(int axis) { return field[axis]; }
  const Column<double>& x(int axis) const { return field[axis]; }
  Column<double>& v(int axis) { return field[D + axis]; }
  const Column<double>& v(int axis) const { return field[D + axis]; }

  Vec<D, double> position(std::size_t i) const {
    Vec<D, double> position;
    for (int axis = 0; axis < D; ++axis) position[axis] = x(axis)[i];
    return position;
  }

  std::size_t size() const { return id.size(); }
  void resize(std::size_t count) {
    reserve_tightly(id, count);
    id.resize(count);
    for (auto& values : field) {
      reserve_tightly(values, count);
      values.resize(count);
    }
  }
  /// Frees all memory.
  void release() {
    std::vector<std::uint64_t>().swap(id);
    for (auto& values : field) Column<double>().swap(values);
  }
};

/// A box of positions: its particles are those with low <= x < high on every axis (position quanta).
template <int D>
struct Region {
  Vec<D, double> low, high;
  bool contains(const Vec<D, double>& x) const {
    for (int axis = 0; axis < D; ++axis)
      if (x[axis] < low[axis] || x[axis] >= high[axis]) return false;
    return true;
  }
  static Region whole_box() {
    Region region;
    for (int axis = 0; axis < D; ++axis) region.high[axis] = box_quanta;
    return region;
  }
};

/// What a process owns. The momentum ledger is this process' share; sums over processes are the totals.
template <int D>
struct State {
  std::uint64_t step = 0;
  FluidParticles<D> fluid;
  std::vector<Solid<D>> solids;      // sorted by id
  Vec<D, Int128> outside_impulse{};  // received from body forces and from what holds fixed solids, iota
  Vec<D, Int128> start_momentum{};   // total at step 0; the same on every process
};

/// This process' share of the digest: shares add up modulo 2^64.
template <int D>
std::uint64_t digest_share(const State<D>& state);

/// This process' share of the total momentum of PPs and SPs, iota.
template <int D>
Vec<D, Int128> momentum_share(const State<D>& state);

}  // namespace mappm
