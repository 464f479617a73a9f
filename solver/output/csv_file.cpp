#include "output/csv_file.hpp"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>

#include "base/error.hpp"
#include "output/durable_file.hpp"

namespace mappm {

namespace {

/// The step that a row begins with; none for a row that was cut short.
std::optional<std::uint64_t> step_of(const std::string& row) {
  std::uint64_t step = 0;
  const auto [end, failed] = std::from_chars(row.data(), row.data() + row.size(), step);
  if (failed != std::errc{} || end == row.data() + row.size() || *end != ',') return std::nullopt;
  return step;
}

}  // namespace

CsvFile::CsvFile(std::filesystem::path path, const std::string& header, std::optional<std::uint64_t> resumed_step)
    : path_(std::move(path)) {
  const bool continued = resumed_step.has_value() && std::filesystem::exists(path_);
  if (continued) keep_until(*resumed_step, header);
  file_.open(path_, continued ? std::ios::app : std::ios::trunc);
  if (!continued) file_ << header << '\n' << std::flush;
  check(file_);
}

void CsvFile::add(const std::string& rows) {
  const std::uintmax_t whole = std::filesystem::file_size(path_);
  file_ << rows << std::flush;
  if (file_) return;
  const int cause = errno;
  file_.clear();
  file_.close();
  std::error_code ignored;
  std::filesystem::resize_file(path_, whole, ignored);  // no row in pieces
  refuse(cause);
}

void CsvFile::keep_until(std::uint64_t step, const std::string& header) {
  std::ifstream old(path_);
  std::string line;
  if (!std::getline(old, line) || line != header)
    throw InputError(path_.string() +
                     ": its columns are not those of this scene; resume in the folder of the run that wrote the "
                     "checkpoint, or choose a new one with --out");
  std::ofstream kept(partial_name(path_), std::ios::trunc);
  kept << header << '\n';
  while (std::getline(old, line) && !old.eof()) {  // a last line without its newline was cut short
    const auto row_step = step_of(line);
    if (row_step.has_value() && *row_step <= step) kept << line << '\n';
  }
  kept.close();
  check(kept);
  publish(path_);
}

void CsvFile::check(const std::ostream& stream) const {
  if (!stream) refuse(errno);
}

void CsvFile::refuse(int cause) const { refuse_to_write(path_, cause); }

}  // namespace mappm
