// HDF5 behind handles that close themselves, and the two things the solver does with it: tables whose rows are spread
// over the processes are written to one file, and read back in slices. The only header that includes hdf5.h.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/group.hpp"

namespace mappm {

/// An HDF5 identifier and the function that releases it.
class Hdf5Handle {
 public:
  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, herr_t (*release)(hid_t)) : id_(id), close_(release) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, 0)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Hdf5Handle() {
    if (id_ > 0) close_(id_);
  }
  hid_t id() const { return id_; }
  /// Forgets the identifier without releasing it.
  void abandon() { id_ = 0; }
  /// Releases now; whether that went well.
  bool close() { return id_ <= 0 || close_(std::exchange(id_, 0)) >= 0; }

 private:
  hid_t id_ = 0;  // H5P_DEFAULT, which needs no release
  herr_t (*close_)(hid_t) = nullptr;
};

template <class T>
hid_t hdf5_type();

/// A file written by all processes of a group together. Every method is collective and throws InputError on all of
/// them with the cause (a full disk, a missing permission) if it failed on any.
///
/// The disk is asked for the room before anything is written to it, where it can promise any. For a process whose write
/// failed drops out of what HDF5 does together, and the others wait for it for ever: in H5Fclose too, so that a file
/// shared by several processes is left unclosed once something failed.
///
/// Rows are written by each process for itself (independent transfer): its part of a data set is one stretch of the
/// file, so nothing is gained by collecting parts first, and where a disk is full, Open MPI's collective writing leaves
/// some processes waiting for ever.
class Hdf5Writer {
 public:
  /// Makes the file, replacing one of that name.
  Hdf5Writer(const std::string& path, const Group& group);
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;
  ~Hdf5Writer();

  void make_group(const std::string& name);
  /// Attributes of the group `where`; the same value on every process.
  void text_attribute(const std::string& where, const std::string& name, const std::string& text);
  template <class T>
  void attribute(const std::string& where, const std::string& name, const std::vector<T>& values);
  /// A data set of rows of `width` values; each process gives its own rows, which follow each other by rank. A width of
  /// 0 makes the data set one-dimensional.
  template <class T>
  void rows(const std::string& name, const std::vector<T>& values, std::size_t width);
  /// Hands everything to the operating system. Without it the file is not complete.
  void close();

 private:
  void reserve(std::uint64_t end);

  std::string path_;
  const Group& group_;
  Hdf5Handle file_;
  std::uint64_t reserved_ = 0;  // bytes from the start for which the disk has room
};

/// A file read by one process for itself. Throws InputError naming the file and what is missing.
class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::string& path);

  std::string text_attribute(const std::string& where, const std::string& name) const;
  template <class T>
  std::vector<T> attribute(const std::string& where, const std::string& name) const;
  /// An attribute of one number.
  std::uint64_t number_attribute(const std::string& where, const std::string& name) const;
  std::uint64_t row_count(const std::string& name) const;
  /// Values of the rows [first, first + count) of a data set of `width` values a row (0: one-dimensional).
  template <class T>
  std::vector<T> rows(const std::string& name, std::uint64_t first, std::uint64_t count, std::size_t width) const;

 private:
  [[noreturn]] void refuse(const std::string& what) const;

  std::string path_;
  Hdf5Handle file_;
};

}  // namespace mappm
