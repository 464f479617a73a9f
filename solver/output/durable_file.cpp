#include "output/durable_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "base/error.hpp"

namespace mappm {

void refuse_to_write(const std::filesystem::path& path, int code) {
  throw InputError(path.string() + ": cannot be written: " + std::strerror(code) +
                   "; free space, or choose another folder with --out");
}

namespace {

class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags) : path_(path), number_(::open(path.c_str(), flags, 0666)) {
    if (number_ < 0) refuse_to_write(path, errno);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  void write(const std::string& text) {
    std::size_t done = 0;
    while (done < text.size()) {
      const ssize_t written = ::write(number_, text.data() + done, text.size() - done);
      if (written < 0) refuse_to_write(path_, errno);
      done += static_cast<std::size_t>(written);
    }
  }
  void reserve(std::uint64_t first, std::uint64_t count) {
    const int done = ::fallocate(number_, FALLOC_FL_KEEP_SIZE, static_cast<off_t>(first), static_cast<off_t>(count));
    if (done != 0 && (errno == ENOSPC || errno == EDQUOT || errno == EFBIG)) refuse_to_write(path_, errno);
  }
  void sync_and_close() {
    if (::fsync(number_) != 0) refuse_to_write(path_, errno);
    const int closed = ::close(number_);
    number_ = -1;
    if (closed != 0) refuse_to_write(path_, errno);
  }

 private:
  std::filesystem::path path_;
  int number_;
};

}  // namespace

std::filesystem::path partial_name(const std::filesystem::path& path) { return path.string() + ".partial"; }

void publish(const std::filesystem::path& path) {
  const std::filesystem::path partial = partial_name(path);
  Descriptor(partial, O_RDONLY).sync_and_close();
  std::error_code failed;
  std::filesystem::rename(partial, path, failed);
  if (failed) refuse_to_write(path, failed.value());
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  Descriptor(folder, O_RDONLY | O_DIRECTORY).sync_and_close();
}

void write_durably(const std::filesystem::path& path, const std::string& text) {
  const std::filesystem::path partial = partial_name(path);
  try {
    Descriptor file(partial, O_WRONLY | O_CREAT | O_TRUNC);
    file.write(text);
    publish(path);
  } catch (const InputError&) {
    discard_partial(path);
    throw;
  }
}

void discard_partial(const std::filesystem::path& path) {
  const std::filesystem::path partial = partial_name(path);
  std::error_code ignored;
  std::filesystem::resize_file(partial, 0, ignored);
  std::filesystem::remove(partial, ignored);
}

void reserve_room(const std::filesystem::path& path, std::uint64_t first, std::uint64_t end) {
  if (end > first) Descriptor(path, O_WRONLY).reserve(first, end - first);
}

void append(const std::filesystem::path& path, const std::string& text) {
  Descriptor(path, O_WRONLY | O_APPEND).write(text);
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    throw InputError(folder.string() + ": folder cannot be made: " + failed.message() +
                     "; choose another one with --out");
}

}  // namespace mappm
