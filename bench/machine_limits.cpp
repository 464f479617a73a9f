// What a core of this machine can do at most in the numbers of the fast engine: arithmetic on lanes in registers, and
// loads and stores of a cache and of main memory. One line a figure; medians over repeats, which take turns.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

#include "base/column.hpp"
#include "base/lanes.hpp"
#include "timing.hpp"

namespace mappm {
namespace {

constexpr int repeats = 9;
constexpr std::size_t unrolled = 4;  // registers of a column side by side
constexpr int chains = 12;  // that do not wait for each other: more than the latency of an operation, in registers

/// A value that no compiler knows.
template <class T>
T unknown(T value) {
  benchmark::DoNotOptimize(value);
  return value;
}

/// Operations a second; advance(chain, x) makes one on all lanes of x.
template <class Numbers, class Value, class Advance>
double rate(Value start, Advance&& advance) {
  constexpr int rounds = 200'000;
  Numbers x[chains];
  for (Numbers& number : x) number = Numbers(unknown(start));
  const double before = bench::computing_seconds();
  for (int round = 0; round < rounds; ++round)
    for (int chain = 0; chain < chains; ++chain) advance(chain, x[chain]);
  const double seconds = bench::computing_seconds() - before;
  Numbers all = x[0];
  for (int chain = 1; chain < chains; ++chain) all += x[chain];
  benchmark::DoNotOptimize(all);
  return static_cast<double>(rounds) * chains * lane_count / seconds;
}

double multiplications() {
  const Lanes factor(unknown(1.0));
  return rate<Lanes>(
      1.0, [&](int, Lanes& x) __attribute__((always_inline)) { x *= factor; });
}
double additions() {
  const Lanes term(unknown(0.0));
  return rate<Lanes>(
      1.0, [&](int, Lanes& x) __attribute__((always_inline)) { x += term; });
}
/// Half of each.
double both() {
  const Lanes factor(unknown(1.0)), term(unknown(0.0));
  return rate<Lanes>(
      1.0, [&](int chain, Lanes& x) __attribute__((always_inline)) {
        if (chain % 2 == 0)
          x *= factor;
        else
          x += term;
      });
}
double roots() {
  return rate<Lanes>(
      0.7, [&](int, Lanes& x) __attribute__((always_inline)) { x = square_root(x); });
}
double integer_additions() {
  const IntLanes term(unknown(std::int64_t{0}));
  return rate<IntLanes>(
      std::int64_t{1}, [&](int, IntLanes& x) __attribute__((always_inline)) { x += term; });
}

/// Three columns that fill `bytes` together.
struct Columns {
  Column<double> a, b, c;
  explicit Columns(std::size_t bytes)
      : a(bytes / 3 / sizeof(Lanes) / unrolled * unrolled * lane_count, 1.0), b(a.size(), 2.0), c(a.size(), 3.0) {}

  /// Bytes a second of walk(way, first lane), called for every register of a column, `streams` columns at a time; `way`
  /// counts the registers side by side.
  template <class Walk>
  double rate(int streams, Walk&& walk) {
    constexpr std::size_t enough = 64 << 20;  // bytes
    const std::size_t bytes = a.size() * sizeof(double) * static_cast<std::size_t>(streams);
    const std::size_t rounds = enough / bytes + 1;
    const double before = bench::computing_seconds();
    for (std::size_t round = 0; round < rounds; ++round) {
      for (std::size_t n = 0; n < a.size(); n += unrolled * lane_count)
        for (std::size_t way = 0; way < unrolled; ++way) walk(way, n + way * lane_count);
      benchmark::ClobberMemory();
    }
    return static_cast<double>(rounds * bytes) / (bench::computing_seconds() - before);
  }
  /// By the bits, which are combined faster than they are loaded.
  double load() {
    IntLanes even{}, odd{};
    const auto* const from = reinterpret_cast<const std::int64_t*>(a.data());
    const double result = rate(
        1, [&](std::size_t way, std::size_t n) __attribute__((always_inline)) {
          if (way % 2 == 0)
            even ^= load_lanes(from + n);
          else
            odd ^= load_lanes(from + n);
        });
    IntLanes all = even ^ odd;  // which alone is seen from outside, so that the loop keeps its sums in registers
    benchmark::DoNotOptimize(all);
    return result;
  }
  double store() {
    const Lanes value(unknown(1.5));
    double* const to = a.data();
    return rate(
        1, [&](std::size_t, std::size_t n) __attribute__((always_inline)) { store_lanes(value, to + n); });
  }
  /// a = b + s c
  double triad() {
    const Lanes factor(unknown(0.5));
    double *const to = a.data(), *const one = b.data(), *const other = c.data();
    return rate(
        3, [&](std::size_t, std::size_t n) __attribute__((always_inline)) {
          store_lanes(load_lanes(one + n) + factor * load_lanes(other + n), to + n);
        });
  }
};

struct Limit {
  std::string name;
  std::function<double()> measure;
  std::vector<double> found{};
};

void measure() {
  std::vector<Limit> limits{{"multiplications_per_s", multiplications},
                            {"additions_per_s", additions},
                            {"multiplications_and_additions_per_s", both},
                            {"roots_per_s", roots},
                            {"integer_additions_per_s", integer_additions}};
  Columns nearest(24 << 10), own(512 << 10), memory(384 << 20);
  const auto add = [&](const std::string& level, Columns& columns) {
    limits.push_back({level + "_load_bytes_per_s", [&columns] { return columns.load(); }});
    limits.push_back({level + "_store_bytes_per_s", [&columns] { return columns.store(); }});
    limits.push_back({level + "_triad_bytes_per_s", [&columns] { return columns.triad(); }});
  };
  add("l1", nearest);
  add("l2", own);
  add("memory", memory);
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (Limit& limit : limits) limit.found.push_back(limit.measure());
  fmt::print("figure machine.lanes {}\n", lane_count);
  for (const Limit& limit : limits) fmt::print("figure machine.{} {:.6g}\n", limit.name, bench::median(limit.found));
}

}  // namespace
}  // namespace mappm

int main() { mappm::measure(); }
