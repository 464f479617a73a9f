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

/// `made`: the folders that were not there before.
void try_files(const std::vector<ExpectedFile>& files, std::vector<fs::path>& made) {
  for (const ExpectedFile& file : files) {
    const fs::path folder = file.path.parent_path(), partial = partial_name(file.path);
    const bool is_new = !fs::exists(fs::symlink_status(folder));
    make_folder(folder);
    if (is_new) made.push_back(folder);
    if (!std::ofstream(partial)) refuse_to_write(partial, errno);  // names a cause, which MPI does not
    try_room(partial, file.bytes + header_bytes);
  }
}

void discard(const std::vector<ExpectedFile>& files, const std::vector<fs::path>& made) {
  for (const ExpectedFile& file : files) discard_partial(file.path);
  std::error_code ignored;
  for (const fs::path& folder : made) fs::remove(folder, ignored);  // does nothing where there is something in it
}

}  // namespace

void try_output(const std::vector<ExpectedFile>& files, const Group& group) {
  std::vector<fs::path> made;
  try {
    on_first(group, [&] { try_files(files, made); });
    // Only where there is room: the library cannot be trusted to fail in order.
    for (const ExpectedFile& file : files) Hdf5Writer(partial_name(file.path).string(), group).close();
  } catch (const InputError&) {
    if (group.is_first()) discard(files, made);
    throw;
  }
  on_first(group, [&] { discard(files, made); });
}

}  // namespace mappm
