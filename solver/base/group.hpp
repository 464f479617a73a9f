// The processes that compute one scene together, as the output layer sees them. The serial engine has a group of
// one; the parallel engine's communicator implements this with MPI.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/fixed_point.hpp"

namespace mappm {

class Group {
 public:
  virtual ~Group() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// How many of its members run on the machine of this one.
  virtual int on_this_machine() const { return size(); }
  /// Replaces each entry by its sum over the group, on every member. Exact: integers only.
  virtual void sum(std::span<Int128> values) const = 0;
  virtual void sum(std::span<std::uint64_t> values) const = 0;  // modulo 2^64
  virtual void minimum(std::span<double> values) const = 0;
  virtual void maximum(std::span<double> values) const = 0;
  /// Sum of `value` over the members before this one.
  virtual std::uint64_t sum_before(std::uint64_t value) const = 0;
  /// Every member receives the text of `root`.
  virtual std::string broadcast(const std::string& text, int root) const = 0;
  /// The values of all members in the order of their ranks, on the first member; empty on the others.
  virtual std::vector<double> gather(const std::vector<double>& values) const = 0;
  virtual void barrier() const = 0;
  /// HDF5 file-access property list for a file that all members open together: an hid_t that the caller closes, or 0
  /// (H5P_DEFAULT).
  virtual std::int64_t hdf5_file_access() const = 0;

  bool is_first() const { return rank() == 0; }
};

}  // namespace mappm
