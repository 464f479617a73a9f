// A table that grows by a row at a time and can be continued after a restart.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

namespace mappm {

class CsvFile {
 public:
  /// Starts the table anew, or, with `resumed_step`, continues the one at `path`: rows whose first field, the step, is
  /// beyond `resumed_step` are dropped. Throws InputError where the file cannot be written or has another header.
  CsvFile(std::filesystem::path path, const std::string& header, std::optional<std::uint64_t> resumed_step);

  /// Adds rows (each ended by a newline) and hands them to the operating system. Throws InputError; the table then ends
  /// with the row before.
  void add(const std::string& rows);

 private:
  void keep_until(std::uint64_t step, const std::string& header);
  void check(const std::ostream& stream) const;
  [[noreturn]] void refuse(int cause) const;

  std::filesystem::path path_;
  std::ofstream file_;
};

}  // namespace mappm
