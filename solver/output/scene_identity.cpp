#include "output/scene_identity.hpp"

#include <sstream>
#include <vector>

#include "base/digest.hpp"

namespace mappm {

namespace {

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
}

std::string key_of(const std::string& line) { return trimmed(line.substr(0, line.find('='))); }

/// "run = { steps = 5, relax = 2 }" as the lines of a table; any other line as it is.
std::vector<std::string> expanded(const std::string& line) {
  const std::string key = key_of(line);
  const std::size_t open = line.find('{');
  if ((key != "run" && key != "output") || open == std::string::npos) return {line};
  std::vector<std::string> lines{"[" + key + "]"};
  std::istringstream entries(line.substr(open + 1, line.rfind('}') - open - 1));
  for (std::string entry; std::getline(entries, entry, ',');) lines.push_back(trimmed(entry));
  lines.push_back("[]");  // what follows belongs to the top table again
  return lines;
}

/// "" for the top table, "run" for [run], "body" for [[body]].
std::string table_of(const std::string& header) {
  const std::size_t begin = header.find_first_not_of('[');
  if (begin == std::string::npos) return "";
  return header.substr(begin, header.find(']') - begin);
}

}  // namespace

std::string scene_identity(const std::string& text) {
  std::string identity;
  std::string table;
  std::istringstream lines(text);
  for (std::string raw; std::getline(lines, raw);) {
    for (const std::string& line : expanded(trimmed(raw))) {
      if (line.empty()) continue;
      const bool header = line[0] == '[' && line.find('=') == std::string::npos && table_of(line) != "";
      if (header || line == "[]") table = header ? table_of(line) : "";
      if (table == "output" || line == "[]") continue;
      if (table == "run" && (header || key_of(line) == "steps" || key_of(line) == "duration")) continue;
      identity += (table == "run" ? "run." : "") + line + '\n';
    }
  }
  return identity;
}

std::uint64_t text_hash(const std::string& text) {
  ParticleHash hash(text.size());
  for (const char letter : text) hash.add(static_cast<std::uint64_t>(static_cast<unsigned char>(letter)));
  return hash.value();
}

std::string first_difference(const std::string& found, const std::string& expected) {
  std::istringstream found_lines(found), expected_lines(expected);
  while (true) {
    std::string a, b;
    const bool more_a = static_cast<bool>(std::getline(found_lines, a));
    const bool more_b = static_cast<bool>(std::getline(expected_lines, b));
    if (!more_a && !more_b) return "";
    if (a != b || more_a != more_b)
      return (more_a ? "'" + a + "'" : "nothing") + " instead of " + (more_b ? "'" + b + "'" : "nothing");
  }
}

}  // namespace mappm
