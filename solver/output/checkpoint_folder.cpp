#include "output/checkpoint_folder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

#include "base/error.hpp"
#include "output/durable_file.hpp"
#include "output/together.hpp"

namespace mappm {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kept_checkpoints = 2;
constexpr const char* name_prefix = "checkpoint_";
constexpr const char* name_ending = ".h5";

/// The list of the first process, on every process.
std::vector<fs::path> agreed_list(const fs::path& folder, const Group& group) {
  std::string text;
  on_first(group, [&] {
    for (const fs::path& path : list_checkpoints(folder)) text += path.string() + '\n';
  });
  std::istringstream lines(group.broadcast(text, 0));
  std::vector<fs::path> paths;
  for (std::string line; std::getline(lines, line);) paths.emplace_back(line);
  return paths;
}

/// The first sound one of a list; what was wrong with each before it goes to `refused`.
template <int D>
bool first_sound(const std::vector<fs::path>& paths, const std::string& scene_text, const Model<D>& model,
                 const Region<D>& region, const Group& group, std::vector<std::string>& refused,
                 FoundCheckpoint<D>& found) {
  for (const fs::path& path : paths) {
    try {
      found.checkpoint = read_checkpoint<D>(path.string(), scene_text, model, region, group);
      found.path = path;
      return true;
    } catch (const InputError& error) {
      refused.emplace_back(error.what());
    }
  }
  return false;
}

/// Where the checkpoints of `from` lie: in it, or in its folder "checkpoints".
fs::path folder_of(const fs::path& from) {
  const fs::path inner = from / checkpoint_folder_name;
  std::error_code failed;
  return fs::is_directory(inner, failed) ? inner : from;
}

/// Removes what a killed run left half written.
void remove_partial(const fs::path& folder) {
  const std::string ending = partial_name(name_ending).string();
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(name_prefix) && name.ends_with(ending)) fs::remove(entry.path(), failed);
  }
}

}  // namespace

std::vector<fs::path> list_checkpoints(const fs::path& folder) {
  std::vector<std::pair<fs::file_time_type, fs::path>> found;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(name_prefix) && name.ends_with(name_ending))
      found.emplace_back(entry.last_write_time(failed), entry.path());
  }
  std::sort(found.rbegin(), found.rend());
  std::vector<fs::path> paths;
  paths.reserve(found.size());
  for (auto& [time, path] : found) paths.push_back(std::move(path));
  return paths;
}

fs::path checkpoint_path(const fs::path& folder, std::uint64_t step) {
  return folder / fmt::format("{}{:09}{}", name_prefix, step, name_ending);
}

template <int D>
fs::path save_checkpoint(const fs::path& folder, const std::string& scene_text, const State<D>& state,
                         std::uint64_t sampled_step, const Group& group) {
  fs::path path = checkpoint_path(folder, state.step);
  on_first(group, [&] { make_folder(folder); });
  try {
    write_checkpoint(partial_name(path).string(), scene_text, state, sampled_step, group);
    on_first(group, [&] { publish(path); });
  } catch (const InputError& error) {
    const std::vector<fs::path> kept = agreed_list(folder, group);
    if (group.is_first()) discard_partial(path);
    throw InputError(error.what() +
                     (kept.empty() ? "" : "; the last checkpoint is kept: --resume " + kept[0].string()));
  }
  on_first(group, [&] {
    const std::vector<fs::path> all = list_checkpoints(folder);
    std::error_code ignored;
    for (std::size_t k = kept_checkpoints; k < all.size(); ++k) fs::remove(all[k], ignored);
    remove_partial(folder);
  });
  return path;
}

template <int D>
FoundCheckpoint<D> find_checkpoint(const fs::path& from, const std::string& scene_text, const Model<D>& model,
                                   const Region<D>& region, const Group& group) {
  FoundCheckpoint<D> found;
  std::vector<std::string> refused;
  std::error_code failed;
  if (!fs::is_directory(from, failed)) {
    if (first_sound<D>({from}, scene_text, model, region, group, refused, found)) return found;
    std::vector<std::string> ignored;
    std::vector<fs::path> others = agreed_list(from.has_parent_path() ? from.parent_path() : ".", group);
    std::erase_if(others, [&](const fs::path& path) { return path.filename() == from.filename(); });
    if (first_sound<D>(others, scene_text, model, region, group, ignored, found))
      throw InputError(refused[0] + "; an older checkpoint is sound, of step " +
                       std::to_string(found.checkpoint.state.step) + ": --resume " + found.path.string());
    throw InputError(refused[0]);
  }
  const std::vector<fs::path> paths = agreed_list(folder_of(from), group);
  if (paths.empty())
    throw InputError(from.string() + ": holds no checkpoint; give a file checkpoint_*.h5 or the folder of a run");
  if (!first_sound<D>(paths, scene_text, model, region, group, refused, found))
    throw InputError(refused[0] + (refused.size() > 1 ? "; the older ones there cannot be used either" : ""));
  found.warning = fmt::format("{}", fmt::join(refused, "; "));
  return found;
}

template fs::path save_checkpoint<2>(const fs::path&, const std::string&, const State<2>&, std::uint64_t, const Group&);
template fs::path save_checkpoint<3>(const fs::path&, const std::string&, const State<3>&, std::uint64_t, const Group&);
template FoundCheckpoint<2> find_checkpoint<2>(const fs::path&, const std::string&, const Model<2>&, const Region<2>&,
                                               const Group&);
template FoundCheckpoint<3> find_checkpoint<3>(const fs::path&, const std::string&, const Model<3>&, const Region<3>&,
                                               const Group&);

}  // namespace mappm
