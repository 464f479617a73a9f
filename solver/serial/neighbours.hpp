// Neighbour search of the reference engine: all pairs (the oracle) or plain cells of one size on the periodic box.
#pragma once

#include <algorithm>
#include <vector>

#include "base/fixed_point.hpp"
#include "base/vec.hpp"

namespace mappm {

enum class Neighbours { cells, all_pairs };

template <int D>
class NeighbourSearch {
 public:
  /// box: sides in rcut. With fewer than three cells on some axis, a cell would neighbour itself twice: all pairs then.
  NeighbourSearch(const Vec<D, double>& box, Neighbours kind) : all_pairs_(kind == Neighbours::all_pairs) {
    int cells = 1;
    for (int axis = 0; axis < D; ++axis) {
      count_[axis] = static_cast<int>(box[axis] * (1.0 - 1e-9));
      if (count_[axis] < 3) all_pairs_ = true;
      cells *= count_[axis];
    }
    if (!all_pairs_) cell_.resize(static_cast<std::size_t>(cells));
  }

  void clear() {
    size_ = 0;
    for (auto& members : cell_) members.clear();
  }

  /// Registers the next particle; x in position quanta, inside the box.
  void add(const Vec<D, double>& x) {
    if (!all_pairs_) cell_[index(coordinates(x))].push_back(size_);
    ++size_;
  }

  /// Calls visit(k) for every registered particle that may lie within rcut of x.
  template <class Visit>
  void for_each_near(const Vec<D, double>& x, Visit&& visit) const {
    if (all_pairs_) {
      for (int k = 0; k < size_; ++k) visit(k);
      return;
    }
    const Vec<D, int> centre = coordinates(x);
    const int neighbour_cells = D == 2 ? 9 : 27;
    for (int n = 0; n < neighbour_cells; ++n) {
      Vec<D, int> cell = centre;
      for (int axis = 0, digits = n; axis < D; ++axis, digits /= 3)
        cell[axis] = (centre[axis] + digits % 3 - 1 + count_[axis]) % count_[axis];
      for (const int k : cell_[index(cell)]) visit(k);
    }
  }

 private:
  Vec<D, int> coordinates(const Vec<D, double>& x) const {
    Vec<D, int> cell;
    for (int axis = 0; axis < D; ++axis)
      cell[axis] = std::min(static_cast<int>(x[axis] / box_quanta * count_[axis]), count_[axis] - 1);
    return cell;
  }
  std::size_t index(const Vec<D, int>& cell) const {
    int flat = cell[D - 1];
    for (int axis = D - 2; axis >= 0; --axis) flat = flat * count_[axis] + cell[axis];
    return static_cast<std::size_t>(flat);
  }

  bool all_pairs_;
  Vec<D, int> count_;
  std::vector<std::vector<int>> cell_;
  int size_ = 0;
};

}  // namespace mappm
