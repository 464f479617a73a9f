#include "output/scene_identity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "base/digest.hpp"

namespace mappm {

namespace {

constexpr std::size_t most_letters = 60;  // of a value in a message
constexpr const char* not_given = "not given";

std::map<std::string, std::string> entries_of(const std::string& identity) {
  std::map<std::string, std::string> entries;
  std::istringstream lines(identity);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t sign = line.find(" = ");
    if (sign != std::string::npos) entries[line.substr(0, sign)] = line.substr(sign + 3);
  }
  return entries;
}

/// Where it is long, the part about the letter at which it differs.
std::string shortened(const std::string& value, std::size_t at) {
  if (value.size() <= most_letters) return value;
  const std::size_t begin = at > most_letters / 2 ? at - most_letters / 2 : 0;
  const bool ends = begin + most_letters >= value.size();
  return (begin > 0 ? "..." : "") + value.substr(begin, most_letters) + (ends ? "" : "...");
}

std::string difference_text(const std::string& key, const std::string& here, const std::string& there,
                            const std::string& where) {
  const auto at = static_cast<std::size_t>(std::mismatch(here.begin(), here.end(), there.begin(), there.end()).first -
                                           here.begin());
  return fmt::format("{} = {} here and {} in {}", key, shortened(here, at), shortened(there, at), where);
}

}  // namespace

std::uint64_t text_hash(const std::string& text) {
  ParticleHash hash(text.size());
  for (const char letter : text) hash.add(static_cast<std::uint64_t>(static_cast<unsigned char>(letter)));
  return hash.value();
}

std::string first_difference(const std::string& here, const std::string& there, const std::string& where) {
  const auto ours = entries_of(here), theirs = entries_of(there);
  for (const auto& [key, value] : ours) {
    const auto other = theirs.find(key);
    if (other == theirs.end()) continue;
    if (other->second != value) return difference_text(key, value, other->second, where);
  }
  for (const auto& [key, value] : ours)
    if (!theirs.contains(key)) return difference_text(key, value, not_given, where);
  for (const auto& [key, value] : theirs)
    if (!ours.contains(key)) return difference_text(key, not_given, value, where);
  return "";
}

}  // namespace mappm
