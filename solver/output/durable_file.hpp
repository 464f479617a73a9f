// Files that are either there as a whole or not at all: written under a temporary name, synced, renamed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace mappm {

/// Throws InputError for a file that cannot be written; `code` is that of the system.
[[noreturn]] void refuse_to_write(const std::filesystem::path& path, int code);

/// The name under which a file is written before it is published.
std::filesystem::path partial_name(const std::filesystem::path& path);

/// Syncs partial_name(path) to the disk, renames it to `path` and syncs the folder. Throws InputError.
void publish(const std::filesystem::path& path);

/// Writes `text` to `path` as a whole. Throws InputError; the file that was there before is then untouched.
void write_durably(const std::filesystem::path& path, const std::string& text);

/// Removes partial_name(path) and frees its room, even where a process still holds it open.
void discard_partial(const std::filesystem::path& path);

/// Makes the disk promise room for the bytes [first, end) of a file, whose length stays. Does nothing where the file
/// system has no such promise. Throws InputError where there is no room.
void reserve_room(const std::filesystem::path& path, std::uint64_t first, std::uint64_t end);

/// Adds `text` to the end of a file. Throws InputError.
void append(const std::filesystem::path& path, const std::string& text);

/// Makes a folder and those above it. Throws InputError naming the folder.
void make_folder(const std::filesystem::path& folder);

}  // namespace mappm
