// Files that are either there as a whole or not at all: written under a temporary name, synced, renamed.
#pragma once

#include <filesystem>
#include <string>

namespace mappm {

/// The name under which a file is written before it is published.
std::filesystem::path partial_name(const std::filesystem::path& path);

/// Syncs partial_name(path) to the disk, renames it to `path` and syncs the folder. Throws InputError.
void publish(const std::filesystem::path& path);

/// Writes `text` to `path` as a whole. Throws InputError; the file that was there before is then untouched.
void write_durably(const std::filesystem::path& path, const std::string& text);

/// Adds `text` to the end of a file. Throws InputError.
void append(const std::filesystem::path& path, const std::string& text);

/// Makes a folder and those above it. Throws InputError naming the folder.
void make_folder(const std::filesystem::path& folder);

}  // namespace mappm
