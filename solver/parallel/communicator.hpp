// Message passing; communicator.cpp is the only file of the solver that includes mpi.h.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "base/group.hpp"

namespace mappm {

using Buffer = std::vector<std::byte>;

/// All processes of the run. Its constructor starts MPI and its destructor ends it.
class Communicator : public Group {
 public:
  Communicator(int& argc, char**& argv);
  ~Communicator() override;
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;

  int rank() const override;
  int size() const override;
  int on_this_machine() const override;
  void sum(std::span<Int128> values) const override;
  void sum(std::span<std::uint64_t> values) const override;
  void minimum(std::span<double> values) const override;
  void maximum(std::span<double> values) const override;
  std::uint64_t sum_before(std::uint64_t value) const override;
  std::string broadcast(const std::string& text, int root) const override;
  std::vector<double> gather(const std::vector<double>& values) const override;
  void barrier() const override;
  std::int64_t hdf5_file_access() const override;

  /// Sends `out[n]` to rank `partners[n]` and receives one message from each into `in[n]`. Partners are mutual. A
  /// partner that is this rank itself is a copy. One message pair a partner.
  void exchange(std::span<const int> partners, std::span<Buffer> out, std::span<Buffer> in) const;
  /// The same in two parts, with work between them that leaves `out` as it is.
  void send(std::span<const int> partners, std::span<const Buffer> out) const;
  void receive(std::span<const int> partners, std::span<Buffer> out, std::span<Buffer> in) const;

  /// Sends out[r] to every rank r and receives from all; for rare events (a new decomposition), not for steps.
  std::vector<Buffer> exchange_all(std::vector<Buffer>&& out) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mappm
