#include "output/run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "output/checkpoint_folder.hpp"
#include "output/durable_file.hpp"
#include "output/run_record.hpp"
#include "output/scene_identity.hpp"
#include "output/snapshot.hpp"
#include "output/together.hpp"

namespace mappm {

namespace {

namespace fs = std::filesystem;

constexpr const char* lock_name = "run.lock";

/// Files of a run by their folder and the ends of their names; each may also be there half written.
struct RunFiles {
  const char* folder;
  std::string_view prefix, ending;
};
constexpr std::array run_files{
    RunFiles{"", "run", ".json"},
    RunFiles{"", "series", ".csv"},
    RunFiles{"", "solids", ".csv"},
    RunFiles{"", "faces", ".csv"},
    RunFiles{"", "trace", ".csv"},
    RunFiles{snapshot_folder_name, "fluid_", ".vtkhdf"},
    RunFiles{snapshot_folder_name, "solids_", ".vtkhdf"},
    RunFiles{checkpoint_folder_name, "checkpoint_", ".h5"},
};

/// A whole name in the top folder, a numbered one below it.
bool is_of(const RunFiles& files, std::string_view name) {
  if (!name.starts_with(files.prefix) || !name.ends_with(files.ending)) return false;
  const std::size_t between = name.size() - std::min(name.size(), files.prefix.size() + files.ending.size());
  return (between > 0) == (*files.folder != '\0');
}

/// What runs left in a folder. `partial`: only what is half written.
std::vector<fs::path> left_by_runs(const fs::path& folder, bool partial) {
  std::vector<fs::path> found;
  const std::string mark = partial_name("").string();
  for (const RunFiles& files : run_files) {
    std::error_code failed;
    for (const auto& entry : fs::directory_iterator(folder / files.folder, failed)) {
      std::string name = entry.path().filename().string();
      const bool half_written = name.ends_with(mark);
      if (half_written) name.resize(name.size() - mark.size());
      if (is_of(files, name) && !entry.is_directory() && (half_written || !partial)) found.push_back(entry.path());
    }
  }
  return found;
}

void remove_file(const fs::path& path) {
  std::error_code failed;
  fs::remove(path, failed);
  if (failed)
    throw InputError(path.string() + ": cannot be removed: " + failed.message() + "; choose another folder with --out");
}

void check_same_scene(const fs::path& folder, const std::string& scene_identity) {
  const fs::path record = folder / run_record_name;
  if (!fs::exists(record)) return;
  const std::string difference = first_difference(scene_identity, recorded_identity(record), run_record_name);
  if (!difference.empty())
    throw InputError(record.string() + ": is of another scene: " + difference +
                     "; resume in the folder of its run, or choose a new one with --out");
}

[[noreturn]] void refuse(const fs::path& folder, const std::string& why) {
  throw InputError("command line", "--out", folder.string(), why);
}

}  // namespace

/// The system takes the lock away with the process, however that ends.
class RunFolder::Lock {
 public:
  explicit Lock(const fs::path& folder) : folder_(folder), path_(folder / lock_name) {
    std::error_code failed;
    for (fs::path missing = folder; !missing.empty() && !fs::exists(missing, failed); missing = missing.parent_path())
      made_.push_back(missing);
    make_folder(folder);
    try {
      do {
        take();
      } while (!is_in_place());  // the run before this one has just ended and taken its file away
    } catch (const InputError&) {
      leave();
      throw;
    }
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
  ~Lock() {
    std::error_code ignored;
    fs::remove(path_, ignored);
    leave();
  }

 private:
  void take() {
    release();
    number_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (number_ < 0) refuse_to_write(path_, errno);
    // A file system without locks can promise nothing: there the run goes on as if it were alone.
    if (::flock(number_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      refuse(folder_, "another run is at work in this folder; wait for its end, or choose another one");
  }
  bool is_in_place() const {
    struct stat held {
    }, there{};
    return ::fstat(number_, &held) == 0 && ::stat(path_.c_str(), &there) == 0 && held.st_ino == there.st_ino;
  }
  void release() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }
  void leave() {
    release();
    std::error_code ignored;
    for (const fs::path& folder : made_) fs::remove(folder, ignored);  // does nothing where there is something in it
  }

  fs::path folder_, path_;
  int number_ = -1;
  std::vector<fs::path> made_;  // folders, the innermost first
};

RunFolder::RunFolder(fs::path path, Entry entry, const Group& group) : path_(std::move(path)), entry_(entry) {
  on_first(group, [&] {
    lock_ = std::make_unique<Lock>(path_);
    const std::vector<fs::path> left = left_by_runs(path_, false);
    if (entry == Entry::refuse && !left.empty())
      refuse(path_, "holds " + left.front().filename().string() +
                        " of an earlier run; choose another folder, go on "
                        "with --resume, or replace it with --overwrite");
  });
}

RunFolder::RunFolder(RunFolder&&) noexcept = default;
RunFolder& RunFolder::operator=(RunFolder&&) noexcept = default;
RunFolder::~RunFolder() = default;

void RunFolder::open(const std::string& scene_identity, const Group& group) const {
  on_first(group, [&] {
    if (entry_ == Entry::resume) check_same_scene(path_, scene_identity);
    for (const fs::path& path : left_by_runs(path_, entry_ != Entry::overwrite)) remove_file(path);
    for (const char* folder : {snapshot_folder_name, checkpoint_folder_name}) {
      std::error_code failed;
      const bool is_folder = fs::is_directory(fs::symlink_status(path_ / folder, failed));
      if (entry_ == Entry::overwrite && is_folder && fs::is_empty(path_ / folder, failed)) remove_file(path_ / folder);
    }
  });
}

}  // namespace mappm
