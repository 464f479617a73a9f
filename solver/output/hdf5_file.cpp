#include "output/hdf5_file.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include "base/error.hpp"
#include "output/durable_file.hpp"
#include "output/together.hpp"

namespace mappm {

template <>
hid_t hdf5_type<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
hid_t hdf5_type<std::int64_t>() {
  return H5T_NATIVE_INT64;
}
template <>
hid_t hdf5_type<std::uint64_t>() {
  return H5T_NATIVE_UINT64;
}
template <>
hid_t hdf5_type<std::uint8_t>() {
  return H5T_NATIVE_UINT8;
}

namespace {

constexpr std::uint64_t beside_rows = 1 << 16;  // bytes; headers of the objects that follow a data set

/// Messages go into exceptions, not to the terminal; and a file that could not be completed is not tried again at the
/// end of the program.
void set_up_library() {
  static const bool done = [] {
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    return true;
  }();
  static_cast<void>(done);
}

herr_t keep_cause(unsigned, const H5E_error2_t* error, void* to) {
  const std::string text = error->desc == nullptr ? "" : error->desc;
  std::string& cause = *static_cast<std::string*>(to);
  const std::string mark = "error message = '";
  const std::size_t begin = text.find(mark);
  if (begin != std::string::npos)
    cause = text.substr(begin + mark.size(), text.find('\'', begin + mark.size()) - begin - mark.size());
  else if (cause.empty())
    cause = text;
  return 0;
}

/// What the operating system said, or else the innermost message of the library (MPI does not say why).
std::string last_cause() {
  std::string cause;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_cause, &cause);
  H5Eclear2(H5E_DEFAULT);
  return cause.empty() ? "unknown error of HDF5" : cause;
}

[[noreturn]] void refuse_to_write(const std::string& path) {
  const std::string cause = last_cause();
  std::error_code failed;
  const auto folder = std::filesystem::path(path).parent_path();
  const auto space = std::filesystem::space(folder.empty() ? "." : folder, failed);
  throw InputError(path + ": cannot be written: " + cause +
                   (failed ? "" : ", " + std::to_string(space.available >> 10) + " KiB are left on its disk") +
                   "; free space, or choose another folder with --out");
}

/// A handle, or an InputError.
Hdf5Handle checked(hid_t id, herr_t (*release)(hid_t), const std::string& path) {
  if (id < 0) refuse_to_write(path);
  return {id, release};
}

void check(herr_t status, const std::string& path) {
  if (status < 0) refuse_to_write(path);
}

/// Two-dimensional for a width, one-dimensional for 0.
Hdf5Handle row_space(std::uint64_t rows, std::size_t width) {
  const std::array<hsize_t, 2> sides{rows, width};
  return {H5Screate_simple(width == 0 ? 1 : 2, sides.data(), nullptr), H5Sclose};
}

void select_rows(hid_t space, std::uint64_t first, std::uint64_t count, std::size_t width) {
  const std::array<hsize_t, 2> start{first, 0}, size{count, width};
  if (count == 0)
    H5Sselect_none(space);
  else
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr);
}

}  // namespace

Hdf5Writer::Hdf5Writer(const std::string& path, const Group& group) : path_(path), group_(group) {
  set_up_library();
  const Hdf5Handle access(group.hdf5_file_access(), H5Pclose);
  together(group,
           [&] { file_ = checked(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose, path); });
  reserve(0);
}

Hdf5Writer::~Hdf5Writer() {
  if (group_.size() > 1) file_.abandon();  // without effect after close()
}

/// Room for the bytes before `end` and for what the library keeps beside the rows.
void Hdf5Writer::reserve(std::uint64_t end) {
  if (group_.size() == 1) return;
  on_first(group_, [&] { reserve_room(path_, reserved_, end + beside_rows); });
  reserved_ = std::max(reserved_, end + beside_rows);
}

void Hdf5Writer::make_group(const std::string& name) {
  together(group_, [&] {
    checked(H5Gcreate2(file_.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path_);
  });
}

void Hdf5Writer::text_attribute(const std::string& where, const std::string& name, const std::string& text) {
  together(group_, [&] {
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.id(), text.empty() ? 1 : text.size());
    H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle attribute = checked(H5Acreate_by_name(file_.id(), where.c_str(), name.c_str(), type.id(),
                                                           space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                                         H5Aclose, path_);
    check(H5Awrite(attribute.id(), type.id(), text.c_str()), path_);
  });
}

template <class T>
void Hdf5Writer::attribute(const std::string& where, const std::string& name, const std::vector<T>& values) {
  together(group_, [&] {
    const Hdf5Handle space = row_space(values.size(), 0);
    const Hdf5Handle attribute = checked(H5Acreate_by_name(file_.id(), where.c_str(), name.c_str(), hdf5_type<T>(),
                                                           space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                                         H5Aclose, path_);
    check(H5Awrite(attribute.id(), hdf5_type<T>(), values.data()), path_);
  });
}

template <class T>
void Hdf5Writer::rows(const std::string& name, const std::vector<T>& values, std::size_t width) {
  const std::uint64_t mine = width == 0 ? values.size() : values.size() / width;
  const std::uint64_t before = group_.sum_before(mine);
  std::array<std::uint64_t, 1> all{mine};
  group_.sum(std::span<std::uint64_t>(all));
  Hdf5Handle data;
  together(group_, [&] {
    const Hdf5Handle space = row_space(all[0], width);
    data =
        checked(H5Dcreate2(file_.id(), name.c_str(), hdf5_type<T>(), space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                H5Dclose, path_);
  });
  if (all[0] > 0) reserve(H5Dget_offset(data.id()) + all[0] * (width == 0 ? 1 : width) * sizeof(T));
  together(group_, [&] {
    if (all[0] == 0) return;  // a data set without rows has no place in the file
    const Hdf5Handle in_file = row_space(all[0], width);
    select_rows(in_file.id(), before, mine, width);
    const Hdf5Handle in_memory = row_space(mine, width);
    if (mine == 0) H5Sselect_none(in_memory.id());
    check(H5Dwrite(data.id(), hdf5_type<T>(), in_memory.id(), in_file.id(), H5P_DEFAULT, values.data()), path_);
  });
  together(group_, [&] {  // small data sets reach the disk only here
    if (!data.close()) refuse_to_write(path_);
  });
}

void Hdf5Writer::close() {
  together(group_, [&] { check(H5Fflush(file_.id(), H5F_SCOPE_GLOBAL), path_); });
  together(group_, [&] {
    if (!file_.close()) refuse_to_write(path_);
  });
}

Hdf5Reader::Hdf5Reader(const std::string& path) : path_(path) {
  set_up_library();
  file_ = Hdf5Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (file_.id() < 0) refuse("it is missing, cut short or no HDF5 file (" + last_cause() + ")");
}

void Hdf5Reader::refuse(const std::string& what) const { throw InputError(path_ + ": cannot be read: " + what); }

std::string Hdf5Reader::text_attribute(const std::string& where, const std::string& name) const {
  const Hdf5Handle attribute(H5Aopen_by_name(file_.id(), where.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  if (attribute.id() < 0) refuse("attribute '" + name + "' is missing");
  const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose);
  if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) != 0 ||
      H5Sget_simple_extent_npoints(space.id()) != 1)
    refuse("attribute '" + name + "' is not one text");
  std::string text(H5Tget_size(type.id()), '\0');
  if (H5Aread(attribute.id(), type.id(), text.data()) < 0) refuse(last_cause());
  while (!text.empty() && text.back() == '\0') text.pop_back();
  return text;
}

template <class T>
std::vector<T> Hdf5Reader::attribute(const std::string& where, const std::string& name) const {
  const Hdf5Handle attribute(H5Aopen_by_name(file_.id(), where.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  if (attribute.id() < 0) refuse("attribute '" + name + "' is missing");
  const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  if (count < 0) refuse(last_cause());
  std::vector<T> values(static_cast<std::size_t>(count));
  if (H5Aread(attribute.id(), hdf5_type<T>(), values.data()) < 0) refuse(last_cause());
  return values;
}

std::uint64_t Hdf5Reader::number_attribute(const std::string& where, const std::string& name) const {
  const auto values = attribute<std::uint64_t>(where, name);
  if (values.size() != 1) refuse("attribute '" + name + "' is not one number");
  return values[0];
}

std::uint64_t Hdf5Reader::row_count(const std::string& name) const {
  const Hdf5Handle data(H5Dopen2(file_.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
  if (data.id() < 0) refuse("data set '" + name + "' is missing");
  const Hdf5Handle space(H5Dget_space(data.id()), H5Sclose);
  std::array<hsize_t, 2> sides{};
  if (H5Sget_simple_extent_ndims(space.id()) > 2) refuse("data set '" + name + "' has an unknown shape");
  H5Sget_simple_extent_dims(space.id(), sides.data(), nullptr);
  return sides[0];
}

template <class T>
std::vector<T> Hdf5Reader::rows(const std::string& name, std::uint64_t first, std::uint64_t count,
                                std::size_t width) const {
  const std::uint64_t columns = width == 0 ? 1 : width;
  const std::uint64_t present = row_count(name);
  if (first > present || count > present - first) refuse("data set '" + name + "' is too short");
  if (count > std::filesystem::file_size(path_) / (columns * sizeof(T)))
    refuse("data set '" + name + "' claims more rows than the file can hold");
  std::vector<T> values(count * columns);
  if (count == 0) return values;
  const Hdf5Handle data(H5Dopen2(file_.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
  const Hdf5Handle in_file(H5Dget_space(data.id()), H5Sclose);
  const int expected = width == 0 ? 1 : 2;
  std::array<hsize_t, 2> sides{};
  if (H5Sget_simple_extent_ndims(in_file.id()) != expected) refuse("data set '" + name + "' has another shape");
  H5Sget_simple_extent_dims(in_file.id(), sides.data(), nullptr);
  if (width != 0 && sides[1] != width) refuse("data set '" + name + "' has rows of another width");
  select_rows(in_file.id(), first, count, width);
  const Hdf5Handle in_memory = row_space(count, width);
  if (H5Dread(data.id(), hdf5_type<T>(), in_memory.id(), in_file.id(), H5P_DEFAULT, values.data()) < 0)
    refuse(last_cause());
  return values;
}

template void Hdf5Writer::attribute(const std::string&, const std::string&, const std::vector<std::int64_t>&);
template void Hdf5Writer::attribute(const std::string&, const std::string&, const std::vector<std::uint64_t>&);
template void Hdf5Writer::rows(const std::string&, const std::vector<double>&, std::size_t);
template void Hdf5Writer::rows(const std::string&, const std::vector<std::int64_t>&, std::size_t);
template void Hdf5Writer::rows(const std::string&, const std::vector<std::uint64_t>&, std::size_t);
template void Hdf5Writer::rows(const std::string&, const std::vector<std::uint8_t>&, std::size_t);
template std::vector<std::uint64_t> Hdf5Reader::attribute(const std::string&, const std::string&) const;
template std::vector<std::uint8_t> Hdf5Reader::rows(const std::string&, std::uint64_t, std::uint64_t,
                                                    std::size_t) const;
template std::vector<std::int64_t> Hdf5Reader::rows(const std::string&, std::uint64_t, std::uint64_t,
                                                    std::size_t) const;
template std::vector<std::uint64_t> Hdf5Reader::rows(const std::string&, std::uint64_t, std::uint64_t,
                                                     std::size_t) const;

}  // namespace mappm
