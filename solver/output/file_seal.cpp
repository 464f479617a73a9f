#include "output/file_seal.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "base/digest.hpp"
#include "base/error.hpp"
#include "output/durable_file.hpp"
#include "output/together.hpp"

namespace mappm {

namespace {

using Words = std::vector<std::uint64_t>;

constexpr std::uint64_t mark = 0x646e654d5050614d;  // "MaPPMend" in memory
constexpr std::uint64_t block_words = 1 << 17;      // hashed at a time: 1 MiB
constexpr std::uint64_t block_bytes = block_words * sizeof(std::uint64_t);

using Seal = std::array<std::uint64_t, 3>;

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw InputError(path.string() + ": cannot be read: " + why);
}

std::ifstream open_to_read(const std::filesystem::path& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) refuse(path, errno == 0 ? "is no file" : std::strerror(errno));
  return file;
}

void read_bytes(std::ifstream& file, const std::filesystem::path& path, std::uint64_t first, void* to,
                std::uint64_t count) {
  file.seekg(static_cast<std::streamoff>(first));
  file.read(static_cast<char*>(to), static_cast<std::streamsize>(count));
  if (!file) refuse(path, std::strerror(errno));
}

/// Sum over the blocks of a process: block n belongs to process n modulo their number.
std::uint64_t hash_share(const std::filesystem::path& path, std::uint64_t length, const Group& group) {
  std::ifstream file = open_to_read(path);
  const auto size = static_cast<std::uint64_t>(group.size());
  std::uint64_t sum = 0;
  Words words;
  for (auto block = static_cast<std::uint64_t>(group.rank()); block * block_bytes < length; block += size) {
    const std::uint64_t count = std::min(block_bytes, length - block * block_bytes);
    words.assign((count + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t), 0);
    read_bytes(file, path, block * block_bytes, words.data(), count);
    ParticleHash hash(block);
    for (const std::uint64_t word : words) hash.add(word);
    sum += hash.value();
  }
  return sum;
}

/// Hash of the first `length` bytes.
std::uint64_t content_hash(const std::filesystem::path& path, std::uint64_t length, const Group& group) {
  std::array<std::uint64_t, 1> sum{together(group, [&] { return hash_share(path, length, group); })};
  group.sum(std::span<std::uint64_t>(sum));
  return sum[0];
}

Seal read_seal(const std::filesystem::path& path) {
  std::ifstream file = open_to_read(path);
  const std::uint64_t size = std::filesystem::file_size(path);
  Seal seal{};
  if (size >= sizeof seal) read_bytes(file, path, size - sizeof seal, seal.data(), sizeof seal);
  if (size < sizeof seal || seal[0] != mark || seal[1] != size - sizeof seal)
    refuse(path, "it is cut short, damaged or no checkpoint of this version of the program");
  return seal;
}

}  // namespace

void seal_file(const std::filesystem::path& path, const Group& group) {
  const std::uint64_t length = together(group, [&] {
    open_to_read(path);
    return std::filesystem::file_size(path);
  });
  const Seal seal{mark, length, content_hash(path, length, group)};
  on_first(group, [&] { append(path, std::string(reinterpret_cast<const char*>(seal.data()), sizeof seal)); });
}

void check_seal(const std::filesystem::path& path, const Group& group) {
  const Seal seal = together(group, [&] { return read_seal(path); });
  if (content_hash(path, seal[1], group) != seal[2])
    throw InputError(path.string() + ": is damaged: its bytes are not those that were written");
}

}  // namespace mappm
