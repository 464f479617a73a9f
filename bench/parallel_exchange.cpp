// What a message costs: exchanges between two processes through the solver's own communicator, of little and of much.
// Runs under mpirun -np 2; prints one line a figure.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "base/stopwatch.hpp"
#include "parallel/communicator.hpp"

namespace {

constexpr std::size_t little = 64, much = std::size_t{1} << 20;  // bytes; much: more than a margin in most runs

/// Median seconds of an exchange in which each of the two processes sends so many bytes.
double exchange_seconds(const mappm::Communicator& world, std::size_t bytes, int repeats) {
  const std::vector<int> partners{1 - world.rank()};
  std::vector<mappm::Buffer> out(1), in(1);
  std::vector<double> seconds;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    out[0].assign(bytes, std::byte{1});
    world.barrier();
    seconds.push_back(mappm::seconds_of([&] { world.exchange(partners, out, in); }));
  }
  std::nth_element(seconds.begin(), seconds.begin() + repeats / 2, seconds.end());
  return seconds[static_cast<std::size_t>(repeats) / 2];
}

}  // namespace

int main(int argc, char** argv) {
  const mappm::Communicator world(argc, argv);
  if (world.size() != 2) {
    std::fputs("parallel_exchange: runs on two processes: mpirun -np 2\n", stderr);
    return 1;
  }
  const double least = exchange_seconds(world, little, 2001), most = exchange_seconds(world, much, 201);
  if (!world.is_first()) return 0;
  fmt::print("figure message.microseconds {:.6g}\n", 1e6 * least);
  fmt::print("figure message.nanoseconds_per_byte {:.6g}\n", 1e9 * (most - least) / static_cast<double>(much - little));
}
