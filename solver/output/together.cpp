#include "output/together.hpp"

#include <array>
#include <filesystem>
#include <new>
#include <stdexcept>

namespace mappm {

namespace {

constexpr char input_kind = 'i';
constexpr char range_kind = 'r';
constexpr char other_kind = 'o';

}  // namespace

std::string describe_failure(const std::exception& error) {
  if (dynamic_cast<const InputError*>(&error) != nullptr) return input_kind + std::string(error.what());
  if (dynamic_cast<const RangeError*>(&error) != nullptr) return range_kind + std::string(error.what());
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error))
    return input_kind + file->path1().string() + ": " + file->code().message() +
           "; see that nobody else changes the folder of the run, or choose another one with --out";
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return input_kind + std::string(memory_ran_out);
  return other_kind + std::string(error.what());
}

void agree(const Group& group, const std::string& failure) {
  std::array<double, 1> failed{static_cast<double>(failure.empty() ? group.size() : group.rank())};
  group.minimum(failed);
  const int lowest = static_cast<int>(failed[0]);
  if (lowest == group.size()) return;
  const std::string text = group.broadcast(failure, lowest);
  const std::string message = text.substr(1);
  switch (text[0]) {
    case input_kind:
      throw InputError(message);
    case range_kind:
      throw RangeError(message);
    default:
      throw AgreedError(message);
  }
}

}  // namespace mappm
