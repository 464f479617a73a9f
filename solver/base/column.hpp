// Arrays of fields that are read side by side.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

namespace mappm {

/// Memory whose first byte lies in another line of the cache for each array. Large arrays from the system all start at
/// the same offset in a page; where a loop walks along a dozen of them, their lines would compete for the few ways of
/// one set of the cache, and a store would look like that of a load beside it.
template <class T>
struct SpreadAllocator {
  using value_type = T;
  SpreadAllocator() = default;
  template <class U>
  SpreadAllocator(const SpreadAllocator<U>&) {}

  T* allocate(std::size_t count) {
    static std::atomic<std::size_t> arrays{0};
    const std::size_t offset = line + arrays.fetch_add(1, std::memory_order_relaxed) * 5 * line % page;
    auto* const start =
        static_cast<std::byte*>(::operator new (count * sizeof(T) + line + page, std::align_val_t{page}));
    std::byte* const first = start + offset;
    reinterpret_cast<std::byte**>(first)[-1] = start;
    return reinterpret_cast<T*>(first);
  }
  void deallocate(T* first, std::size_t) {
    ::operator delete (reinterpret_cast<std::byte**>(first)[-1], std::align_val_t{page});
  }
  bool operator==(const SpreadAllocator&) const { return true; }

 private:
  static constexpr std::size_t line = 64, page = 4096;
};

/// One field, an entry a particle.
template <class T>
using Column = std::vector<T, SpreadAllocator<T>>;

}  // namespace mappm
