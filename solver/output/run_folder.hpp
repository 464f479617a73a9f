// The output folder of a run, which belongs to it alone.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "base/group.hpp"

namespace mappm {

class RunFolder {
 public:
  /// What a run means to do with a folder that holds the output of another.
  enum class Entry { refuse, resume, overwrite };

  /// Collective. Makes the folder and locks it for as long as this object lives, and no longer than the process of the
  /// first rank does. Throws InputError where that cannot be done, where another run is at work in the folder, and
  /// where it holds what the entry refuses. Folders that were made here and are empty at the end are removed.
  RunFolder(std::filesystem::path path, Entry entry, const Group& group);
  RunFolder(RunFolder&&) noexcept;
  RunFolder& operator=(RunFolder&&) noexcept;
  ~RunFolder();

  /// Collective. To be called before anything is written: with `overwrite` removes what an earlier run left, and
  /// nothing else. Throws InputError where a resumed run is of another scene than the one whose output the folder
  /// holds.
  void open(const std::string& scene_identity, const Group& group) const;

  const std::filesystem::path& path() const { return path_; }

 private:
  class Lock;

  std::filesystem::path path_;
  Entry entry_;
  std::unique_ptr<Lock> lock_;  // of the first process
};

}  // namespace mappm
