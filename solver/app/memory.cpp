#include "app/memory.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>

#include "base/error.hpp"
#include "output/together.hpp"
#include "scene/walls.hpp"

namespace mappm {

namespace {

namespace fs = std::filesystem;

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double solid_bytes = 2000.0;  // of a solid without its FPs

std::string bytes_text(double bytes) {
  const bool small = bytes < 1e9;
  return fmt::format("{:.2g} {}", bytes / (small ? 1e6 : 1e9), small ? "MB" : "GB");
}

/// The number in a file that holds one; `fallback` where there is none, as in "max".
double number_in(const fs::path& path, double fallback) {
  std::ifstream file(path);
  double number = 0.0;
  return file >> number ? number : fallback;
}

/// The number behind a word; 0 where the file has none.
double number_after(const fs::path& path, const std::string& word) {
  std::ifstream file(path);
  for (std::string read; file >> read;)
    if (double number = 0.0; read == word && file >> number) return number;
  return 0.0;
}

/// What a limit of this process leaves. `used`: column of what counts in proc/self/statm.
double left_of_limit(int resource, int column, const fs::path& root) {
  rlimit limit{};
  if (::getrlimit(static_cast<__rlimit_resource>(resource), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return unlimited;
  std::ifstream file(root / "proc/self/statm");
  double pages = 0.0;
  for (int k = 0; k <= column; ++k) file >> pages;
  return static_cast<double>(limit.rlim_cur) - pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

/// Names of the files of a control group: they are others in the two versions of the system.
struct GroupFiles {
  const char *mount, *most, *used, *idle;
};
constexpr GroupFiles second_version{"sys/fs/cgroup", "memory.max", "memory.current", "inactive_file"};
constexpr GroupFiles first_version{"sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes",
                                   "total_inactive_file"};

/// What a control group and those above it leave. Files that are only kept for the case may be dropped.
double left_of_group(const GroupFiles& files, fs::path group, const fs::path& root) {
  double left = unlimited;
  while (true) {
    const fs::path folder = root / files.mount / group.relative_path();
    const double idle = number_after(folder / "memory.stat", files.idle);
    left = std::min(left, number_in(folder / files.most, unlimited) - number_in(folder / files.used, 0.0) + idle);
    if (!group.has_relative_path()) return left;
    group = group.parent_path();
  }
}

double left_of_groups(const fs::path& root) {
  double left = unlimited;
  std::ifstream file(root / "proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {  // "0::/path", or "4:memory:/path"
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = fmt::format(",{},", line.substr(first + 1, second - first - 1));
    if (controllers == ",,") left = std::min(left, left_of_group(second_version, line.substr(second + 1), root));
    if (controllers.find(",memory,") != std::string::npos)
      left = std::min(left, left_of_group(first_version, line.substr(second + 1), root));
  }
  return left;
}

double left_of_machine(const fs::path& root) {
  const double kibibytes = number_after(root / "proc/meminfo", "MemAvailable:");
  return kibibytes > 0.0 ? 1024.0 * kibibytes : unlimited;
}

}  // namespace

std::string MemoryNeed::text() const { return bytes_text(bytes); }

MemoryNeed memory_need(const Scene& scene, const ParticleBytes& bytes) {
  MemoryNeed need;
  for (const BodyScene& body : scene.bodies) need.bytes += solid_bytes * static_cast<double>(body.positions.size());
  if (!scene.fluid.particles) return need;
  need.particles = 1.0;
  for (int axis = 0; axis < scene.dimension; ++axis) need.particles *= static_cast<double>(lattice_nodes(scene, axis));
  const double reach = scene.fluid.cutoff / scene.fluid.spacing;
  const double neighbours =
      scene.dimension == 2 ? std::numbers::pi * reach * reach : 4.0 / 3.0 * std::numbers::pi * reach * reach * reach;
  need.bytes += need.particles * (bytes.each + scene.dimension * bytes.an_axis + neighbours * bytes.a_neighbour);
  return need;
}

double memory_left(int processes, const fs::path& root) {
  constexpr int size_column = 0, data_column = 5;
  const double own =
      std::min(left_of_limit(RLIMIT_AS, size_column, root), left_of_limit(RLIMIT_DATA, data_column, root));
  return std::min(own, std::min(left_of_groups(root), left_of_machine(root)) / processes);
}

void check_memory(const Scene& scene, const MemoryNeed& need, const Group& group) {
  together(group, [&] {
    const double left = memory_left(group.on_this_machine()), share = need.bytes / group.size();
    if (share <= left) return;
    const std::string there = group.size() == 1 ? fmt::format("{} are there", bytes_text(left))
                                                : fmt::format("{} are there for each of {} processes, which needs {}",
                                                              bytes_text(left), group.size(), bytes_text(share));
    if (need.particles == 0.0)
      throw InputError(scene.file, "body", "", fmt::format("the solids need {}, {}; make fewer", need.text(), there));
    throw InputError(scene.file, "fluid.spacing", fmt::format("{}", scene.fluid.spacing),
                     fmt::format("makes {:.4g} PPs, which need {} ({:.4g} bytes), {}; enlarge it, or give the run more "
                                 "memory",
                                 need.particles, need.text(), need.bytes, there));
  });
}

}  // namespace mappm
