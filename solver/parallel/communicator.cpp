#include "parallel/communicator.hpp"

#include <hdf5.h>
#include <mpi.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

namespace mappm {

namespace {

constexpr int exchange_tag = 1;

/// MPI counts in int.
int count_of(const Buffer& buffer) {
  if (buffer.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw std::length_error("a message to one process exceeds 2 GiB; use more processes");
  return static_cast<int>(buffer.size());
}

/// The parts of 128-bit integers that can be added as 64-bit ones: three pieces of at most 43 bits.
constexpr int piece_bits = 43;
constexpr std::int64_t piece_mask = (std::int64_t{1} << piece_bits) - 1;

template <class T>
void reduce(std::span<T> values, MPI_Datatype type, MPI_Op operation) {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), type, operation, MPI_COMM_WORLD);
}

}  // namespace

struct Communicator::Impl {
  int rank = 0, size = 1, on_this_machine = 1;
  std::vector<MPI_Request> requests;  // of messages being sent
};

Communicator::Communicator(int& argc, char**& argv) : impl_(std::make_unique<Impl>()) {
  // Open MPI names a file of its own after each that is written together, in a buffer of 256 bytes: longer paths end in
  // an overflow. The part that does so serves shared file pointers, which are not used here.
  ::setenv("OMPI_MCA_sharedfp", "^lockedfile", 0);
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &impl_->rank);
  MPI_Comm_size(MPI_COMM_WORLD, &impl_->size);
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, impl_->rank, MPI_INFO_NULL, &machine);
  MPI_Comm_size(machine, &impl_->on_this_machine);
  MPI_Comm_free(&machine);
}

Communicator::~Communicator() { MPI_Finalize(); }

int Communicator::rank() const { return impl_->rank; }
int Communicator::size() const { return impl_->size; }
int Communicator::on_this_machine() const { return impl_->on_this_machine; }

void Communicator::sum(std::span<Int128> values) const {
  std::vector<std::int64_t> pieces(3 * values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    pieces[3 * i] = static_cast<std::int64_t>(values[i]) & piece_mask;
    pieces[3 * i + 1] = static_cast<std::int64_t>(values[i] >> piece_bits) & piece_mask;
    pieces[3 * i + 2] = static_cast<std::int64_t>(values[i] >> (2 * piece_bits));
  }
  reduce(std::span(pieces), MPI_INT64_T, MPI_SUM);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Int128 unit = Int128{1} << piece_bits;
    values[i] = (Int128{pieces[3 * i + 2]} * unit + pieces[3 * i + 1]) * unit + pieces[3 * i];
  }
}

void Communicator::sum(std::span<std::uint64_t> values) const { reduce(values, MPI_UINT64_T, MPI_SUM); }
void Communicator::minimum(std::span<double> values) const { reduce(values, MPI_DOUBLE, MPI_MIN); }
void Communicator::maximum(std::span<double> values) const { reduce(values, MPI_DOUBLE, MPI_MAX); }

std::uint64_t Communicator::sum_before(std::uint64_t value) const {
  std::uint64_t before = 0;
  MPI_Exscan(&value, &before, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
  return impl_->rank == 0 ? 0 : before;
}

std::string Communicator::broadcast(const std::string& text, int root) const {
  std::uint64_t length = text.size();
  MPI_Bcast(&length, 1, MPI_UINT64_T, root, MPI_COMM_WORLD);
  std::string received = text;
  received.resize(length);
  MPI_Bcast(received.data(), static_cast<int>(length), MPI_CHAR, root, MPI_COMM_WORLD);
  return received;
}

std::vector<double> Communicator::gather(const std::vector<double>& values) const {
  const bool first = impl_->rank == 0;
  const int count = static_cast<int>(values.size());
  std::vector<int> counts(first ? static_cast<std::size_t>(impl_->size) : 0);
  MPI_Gather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
  std::vector<int> offsets(counts.size());
  int total = 0;
  for (std::size_t r = 0; r < counts.size(); ++r) {
    offsets[r] = total;
    total += counts[r];
  }
  std::vector<double> all(static_cast<std::size_t>(total));
  MPI_Gatherv(values.data(), count, MPI_DOUBLE, all.data(), counts.data(), offsets.data(), MPI_DOUBLE, 0,
              MPI_COMM_WORLD);
  return all;
}

void Communicator::barrier() const { MPI_Barrier(MPI_COMM_WORLD); }

std::int64_t Communicator::hdf5_file_access() const {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_mpio(access, MPI_COMM_WORLD, MPI_INFO_NULL);
  return access;
}

void Communicator::exchange(std::span<const int> partners, std::span<Buffer> out, std::span<Buffer> in) const {
  send(partners, out);
  receive(partners, out, in);
}

void Communicator::send(std::span<const int> partners, std::span<const Buffer> out) const {
  for (std::size_t n = 0; n < partners.size(); ++n)
    if (partners[n] != impl_->rank)
      MPI_Isend(out[n].data(), count_of(out[n]), MPI_BYTE, partners[n], exchange_tag, MPI_COMM_WORLD,
                &impl_->requests.emplace_back());
}

void Communicator::receive(std::span<const int> partners, std::span<Buffer> out, std::span<Buffer> in) const {
  for (std::size_t n = 0; n < partners.size(); ++n) {
    if (partners[n] == impl_->rank) {
      std::swap(out[n], in[n]);
      continue;
    }
    MPI_Message message;
    MPI_Status status;
    MPI_Mprobe(partners[n], exchange_tag, MPI_COMM_WORLD, &message, &status);
    int bytes = 0;
    MPI_Get_count(&status, MPI_BYTE, &bytes);
    in[n].resize(static_cast<std::size_t>(bytes));
    MPI_Mrecv(in[n].data(), bytes, MPI_BYTE, &message, MPI_STATUS_IGNORE);
  }
  // Here and no later: some networks send only while the sender waits.
  MPI_Waitall(static_cast<int>(impl_->requests.size()), impl_->requests.data(), MPI_STATUSES_IGNORE);
  impl_->requests.clear();
}

std::vector<Buffer> Communicator::exchange_all(std::vector<Buffer>&& out) const {
  std::vector<int> ranks(out.size());
  for (std::size_t r = 0; r < ranks.size(); ++r) ranks[r] = static_cast<int>(r);
  std::vector<Buffer> received(out.size());
  exchange(ranks, out, received);
  out.clear();
  return received;
}

}  // namespace mappm
