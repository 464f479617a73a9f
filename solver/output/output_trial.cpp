#include "output/output_trial.hpp"

#include <cerrno>
#include <fstream>
#include <system_error>

#include "base/error.hpp"
#include "output/durable_file.hpp"
#include "output/hdf5_file.hpp"
#include "output/together.hpp"

namespace mappm {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t header_bytes = 1 << 16;  // of the library

/// Its length is tried as well as its room: files may be limited in the one and disks in the other. A disk that says
/// how little it has is not filled in vain.
void try_room(const fs::path& path, std::uint64_t bytes) {
  std::error_code failed;
  const fs::space_info space = fs::space(path, failed);
  if (!failed && space.available < bytes) refuse_to_write(path, ENOSPC);
  reserve_room(path, 0, bytes);
  fs::resize_file(path, bytes, failed);
  if (failed) refuse_to_write(path, failed.value());
}

void try_file(const ExpectedFile& file, const Group& group) {
  const fs::path partial = partial_name(file.path);
  on_first(group, [&] {
    make_folder(file.path.parent_path());
    if (!std::ofstream(partial)) refuse_to_write(partial, errno);  // names a cause, which MPI does not
  });
  Hdf5Writer(partial.string(), group).close();
  on_first(group, [&] { try_room(partial, file.bytes + header_bytes); });
}

void discard(const std::vector<ExpectedFile>& files) {
  for (const ExpectedFile& file : files) discard_partial(file.path);
  for (const ExpectedFile& file : files) {
    std::error_code ignored;
    fs::remove(file.path.parent_path(), ignored);  // does nothing where there is something in it
  }
}

}  // namespace

void try_output(const std::vector<ExpectedFile>& files, const Group& group) {
  try {
    for (const ExpectedFile& file : files) try_file(file, group);
  } catch (const InputError&) {
    if (group.is_first()) discard(files);
    throw;
  }
  on_first(group, [&] { discard(files); });
}

}  // namespace mappm
