// A checkpoint that is not as it was written; only InputError may come out, and a state with another digest never.
//   first byte even: the rest is the file as a whole
//   first byte odd:  the rest are edits of a sound checkpoint, sealed again, so that they reach what lies behind the
//   seal
#include "output/checkpoint.hpp"

#include <hdf5.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/single_group.hpp"
#include "output/file_seal.hpp"
#include "require.hpp"
#include "unit/output/hand_state.hpp"

namespace mappm {

namespace {

constexpr const char* scene_text = "fluid.spacing = 0.5\nrun.relax = 0\n";

constexpr std::array data_sets{"/scene",     "/fluid/id",  "/fluid/x_x",    "/fluid/x_y",
                               "/fluid/v_x", "/fluid/v_y", "/solids/words", "/solids/contacts"};
constexpr std::array attributes{"format",       "version", "numerics",    "dimension",      "scene_hash",     "step",
                                "sampled_step", "digest",  "ledger_hash", "start_momentum", "outside_impulse"};
constexpr std::size_t names = data_sets.size() + attributes.size();

/// On a disk of memory, one a process.
const std::string& path() {
  static const std::string name = "/dev/shm/mappm_fuzz_" + std::to_string(::getpid()) + ".h5";
  return name;
}

/// Takes numbers from the input; 0 where it has ended.
class Input {
 public:
  explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool ended() const { return bytes_.empty(); }
  std::uint64_t take(std::size_t width) {
    std::uint64_t value = 0;
    const std::size_t count = std::min(width, bytes_.size());
    std::memcpy(&value, bytes_.data(), count);
    bytes_ = bytes_.subspan(count);
    return value;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

hid_t open_object(hid_t file, std::size_t name) {
  return name < data_sets.size() ? H5Dopen2(file, data_sets[name], H5P_DEFAULT)
                                 : H5Aopen(file, attributes[name - data_sets.size()], H5P_DEFAULT);
}

/// One word of a data set or attribute.
void set_word(hid_t file, std::size_t name, std::uint64_t position, std::uint64_t value) {
  const bool is_data = name < data_sets.size();
  const hid_t object = open_object(file, name);
  if (object < 0) return;
  std::vector<std::uint64_t> words(4096);
  const hid_t space = is_data ? H5Dget_space(object) : H5Aget_space(object);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  if (count > 0 && static_cast<std::size_t>(count) <= words.size()) {
    std::uint64_t& word = words[position % static_cast<std::uint64_t>(count)];
    if (is_data) {
      H5Dread(object, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, words.data());
      word = value;
      H5Dwrite(object, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, words.data());
    } else if (H5Aread(object, H5T_NATIVE_UINT64, words.data()) >= 0) {
      word = value;
      H5Awrite(object, H5T_NATIVE_UINT64, words.data());
    }
  }
  H5Sclose(space);
  is_data ? H5Dclose(object) : H5Aclose(object);
}

void remove(hid_t file, std::size_t name) {
  if (name < data_sets.size())
    H5Ldelete(file, data_sets[name], H5P_DEFAULT);
  else
    H5Adelete(file, attributes[name - data_sets.size()]);
}

/// Puts another data set or attribute in its place: of another type, rank and length.
void replace(hid_t file, std::size_t name, std::uint64_t kind, std::uint64_t rows, std::uint64_t width) {
  remove(file, name);
  const std::array<hid_t, 5> types{H5T_NATIVE_UINT64, H5T_NATIVE_INT64, H5T_NATIVE_UINT8, H5T_NATIVE_DOUBLE, H5T_C_S1};
  const std::array<hsize_t, 3> sides{rows % 64, width % 64, 2};
  const hid_t space = H5Screate_simple(static_cast<int>(kind / types.size() % 4), sides.data(), nullptr);
  const hid_t type = types[kind % types.size()];
  const hid_t object =
      name < data_sets.size()
          ? H5Dcreate2(file, data_sets[name], type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)
          : H5Acreate2(file, attributes[name - data_sets.size()], type, space, H5P_DEFAULT, H5P_DEFAULT);
  if (object >= 0) name < data_sets.size() ? H5Dclose(object) : H5Aclose(object);
  H5Sclose(space);
}

void edit(Input input) {
  const hid_t file = H5Fopen(path().c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  require(file >= 0, "HDF5 opens a sealed checkpoint");
  while (!input.ended()) {
    const std::uint64_t action = input.take(1);
    const std::size_t name = input.take(1) % names;
    switch (action % 3) {
      case 0: {
        const std::uint64_t position = input.take(2);
        set_word(file, name, position, input.take(8));
        break;
      }
      case 1: {
        const std::uint64_t kind = input.take(1), rows = input.take(1);
        replace(file, name, kind, rows, input.take(1));
        break;
      }
      default:
        remove(file, name);
    }
  }
  H5Fclose(file);
}

void write_file(const void* bytes, std::size_t size) {
  std::ofstream(path(), std::ios::binary).write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
}

/// The bytes of a sound checkpoint.
const std::string& sound() {
  static const std::string bytes = [] {
    write_checkpoint(path(), scene_text, hand::state(), 4, SingleGroup());
    std::string content(std::filesystem::file_size(path()), '\0');
    std::ifstream(path(), std::ios::binary).read(content.data(), static_cast<std::streamsize>(content.size()));
    return content;
  }();
  return bytes;
}

void try_to_read() {
  try {
    const SingleGroup group;
    const auto read = read_checkpoint<2>(path(), scene_text, hand::model(), Region<2>::whole_box(), group);
    require(digest_share(read.state) == digest_share(hand::state()), "what is read is what was written");
  } catch (const InputError&) {  // every other exception is a finding
  }
}

void read(std::span<const std::uint8_t> bytes) {
  sound();
  if (bytes[0] % 2 == 0) {
    write_file(bytes.data() + 1, bytes.size() - 1);
  } else {
    write_file(sound().data(), sound().size());
    edit(Input(bytes.subspan(1)));
    seal_file(path(), SingleGroup());
  }
  try_to_read();
  std::filesystem::remove(path());
}

}  // namespace

}  // namespace mappm

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size > 0) mappm::read({bytes, size});
  return 0;
}
