// A group of one process: that of the serial engine and of tests.
#pragma once

#include "base/group.hpp"

namespace mappm {

class SingleGroup : public Group {
 public:
  int rank() const override { return 0; }
  int size() const override { return 1; }
  void sum(std::span<Int128>) const override {}
  void sum(std::span<std::uint64_t>) const override {}
  void minimum(std::span<double>) const override {}
  void maximum(std::span<double>) const override {}
  std::uint64_t sum_before(std::uint64_t) const override { return 0; }
  std::string broadcast(const std::string& text, int) const override { return text; }
  std::vector<double> gather(const std::vector<double>& values) const override { return values; }
  void barrier() const override {}
  std::int64_t hdf5_file_access() const override { return 0; }
};

}  // namespace mappm
