// Byte buffers as sequences of trivially copyable values.
#pragma once

#include <cstring>
#include <type_traits>
#include <vector>

#include "parallel/communicator.hpp"

namespace mappm {

/// Room for so many more bytes at the end of a buffer; returns where it begins.
inline std::byte* extend(Buffer& buffer, std::size_t bytes) {
  const std::size_t at = buffer.size();
  buffer.resize(at + bytes);
  return buffer.data() + at;
}

template <class T>
void put(Buffer& buffer, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::memcpy(extend(buffer, sizeof(T)), &value, sizeof(T));
}

template <class T>
void put(Buffer& buffer, const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  put(buffer, values.size());
  if (values.empty()) return;
  std::memcpy(extend(buffer, values.size() * sizeof(T)), values.data(), values.size() * sizeof(T));
}

/// Writes a value at an address of bytes, and moves that behind it.
template <class T>
void write(std::byte*& to, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::memcpy(to, &value, sizeof(T));
  to += sizeof(T);
}

/// Reads back, in the same order, what `put` wrote.
class BufferReader {
 public:
  explicit BufferReader(const Buffer& buffer) : buffer_(&buffer) {}
  bool at_end() const { return at_ == buffer_->size(); }

  template <class T>
  T get() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    std::memcpy(&value, buffer_->data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  /// So many values, where they lie: they may be at any address.
  template <class T>
  const std::byte* skip(std::size_t count) {
    const std::byte* const values = buffer_->data() + at_;
    at_ += count * sizeof(T);
    return values;
  }
  template <class T>
  void get(std::vector<T>& values) {
    values.resize(get<std::size_t>());
    if (values.empty()) return;
    std::memcpy(values.data(), buffer_->data() + at_, values.size() * sizeof(T));
    at_ += values.size() * sizeof(T);
  }

 private:
  const Buffer* buffer_;
  std::size_t at_ = 0;
};

}  // namespace mappm
