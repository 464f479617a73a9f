// A group whose members are threads of the test: what the processes of a run agree upon, without MPI.
#pragma once

#include <algorithm>
#include <barrier>
#include <numeric>
#include <thread>
#include <vector>

#include "base/group.hpp"

namespace mappm::testing_tools {

class ThreadGroup {
 public:
  explicit ThreadGroup(int size) : size_(size), barrier_(size), slots_(static_cast<std::size_t>(size)) {}

  /// Calls work(member) in `size` threads, each with its own member of the group.
  template <class Work>
  void run(Work&& work) {
    std::vector<std::thread> threads;
    for (int rank = 0; rank < size_; ++rank) threads.emplace_back([&, rank] { work(Member(*this, rank)); });
    for (std::thread& thread : threads) thread.join();
  }

 private:
  class Member : public Group {
   public:
    Member(ThreadGroup& group, int rank) : group_(group), rank_(rank) {}
    int rank() const override { return rank_; }
    int size() const override { return group_.size_; }
    void sum(std::span<Int128> values) const override { fold(values, std::plus<Int128>()); }
    void sum(std::span<std::uint64_t> values) const override { fold(values, std::plus<std::uint64_t>()); }
    void minimum(std::span<double> values) const override {
      fold(values, [](double a, double b) { return std::min(a, b); });
    }
    void maximum(std::span<double> values) const override {
      fold(values, [](double a, double b) { return std::max(a, b); });
    }
    std::uint64_t sum_before(std::uint64_t value) const override {
      const auto all = everyone(&value);
      std::uint64_t sum = 0;
      for (int k = 0; k < rank_; ++k) sum += *static_cast<const std::uint64_t*>(all[k]);
      barrier();
      return sum;
    }
    std::string broadcast(const std::string& text, int root) const override {
      const std::string copy = *static_cast<const std::string*>(everyone(&text)[root]);
      barrier();
      return copy;
    }
    std::vector<double> gather(const std::vector<double>& values) const override {
      std::vector<double> result;
      for (const void* slot : everyone(&values)) {
        const auto& part = *static_cast<const std::vector<double>*>(slot);
        if (rank_ == 0) result.insert(result.end(), part.begin(), part.end());
      }
      barrier();
      return result;
    }
    void barrier() const override { group_.barrier_.arrive_and_wait(); }
    std::int64_t hdf5_file_access() const override { return 0; }

   private:
    /// What each member has put down here. A second barrier must follow before anybody changes it.
    std::vector<const void*> everyone(const void* mine) const {
      group_.slots_[static_cast<std::size_t>(rank_)] = mine;
      barrier();
      return group_.slots_;
    }
    template <class T, class Fold>
    void fold(std::span<T> values, Fold&& two) const {
      const auto all = everyone(values.data());
      std::vector<T> result(values.size());
      for (std::size_t k = 0; k < values.size(); ++k) {
        result[k] = static_cast<const T*>(all[0])[k];
        for (std::size_t rank = 1; rank < all.size(); ++rank)
          result[k] = two(result[k], static_cast<const T*>(all[rank])[k]);
      }
      barrier();
      std::copy(result.begin(), result.end(), values.begin());
    }

    ThreadGroup& group_;
    int rank_;
  };

  int size_;
  std::barrier<> barrier_;
  std::vector<const void*> slots_;
};

}  // namespace mappm::testing_tools
