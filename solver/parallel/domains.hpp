// The grid of domains (the paper's ACDs): one box of positions a process. Free of MPI.
//
//   owned   a particle whose position lies in the process' region, or a solid whose centre does
//   ghost   a copy of a particle within rcut and skin outside the region, in the frame of the region (a periodic image
//   is
//           shifted by a whole box)
//   copy    the same for a solid, within the margin that its FPs and contacts need
//   image   a neighbouring region as seen from here: its rank, and its position in the frame of this region
#pragma once

#include <array>
#include <string>
#include <vector>

#include "particles/model.hpp"
#include "particles/state.hpp"

namespace mappm {

/// A neighbouring region in this process' frame. A particle at x (this frame) is at x + shift in the neighbour's.
template <int D>
struct Image {
  int partner = 0;  // index in Domains::partners
  Region<D> region;
  Vec<D, double> shift;
};

template <int D>
class Domains {
 public:
  /// cuts[axis]: borders of the domains along that axis, from 0 to box_quanta, increasing integers.
  explicit Domains(std::array<std::vector<double>, D> cuts);

  int count() const;
  Vec<D, int> grid() const;
  const std::array<std::vector<double>, D>& cuts() const { return cuts_; }
  Region<D> region(int rank) const;
  /// The rank that owns a position, given in any frame (at most one box outside).
  int owner(const Vec<D, double>& x) const;
  /// The 3^D - 1 neighbouring regions, and the ranks behind them, each once, in increasing order.
  std::vector<Image<D>> images(int rank) const;
  std::vector<int> partners(int rank) const;

 private:
  Vec<D, int> coordinates(int rank) const;
  int rank_at(const Vec<D, int>& coordinates) const;
  std::array<std::vector<double>, D> cuts_;
};

/// `grid`: "2x4" (domains along x, y ...), or empty for slabs along the longest side, of equal ones the last. Throws
/// InputError for a grid that does not match the number of processes, or domains too small for rcut or for the solids
/// (the paper's h > 2R).
template <int D>
Domains<D> make_domains(const Model<D>& model, int processes, const std::string& grid);

/// Moves the cuts so that the particles counted in `profile[axis]` (equal bins from 0 to box side) are shared evenly
/// along each axis, as far as the smallest allowed domain permits.
template <int D>
Domains<D> balanced(const Model<D>& model, const Domains<D>& domains,
                    const std::array<std::vector<std::uint64_t>, D>& profile);

}  // namespace mappm
