#include "core/io/referred_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "adamas/text.h"
#include "core/io/header_text.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"

namespace adamas::io {

namespace {

/// A sensible header has fewer names than this.
constexpr std::int64_t kMostNames = 10'000;

/// The value of a line that states the data file, under any name of that field; empty for other lines.
std::optional<std::string_view> data_field(std::string_view line) {
  for (const std::string_view name : {"data file:", "datafile:", "ElementDataFile"}) {
    if (!line.starts_with(name)) continue;
    std::string_view value = trimmed(line.substr(name.size()));
    if (name.back() == ':') return value;
    if (value.starts_with('=')) return trimmed(value.substr(1));
  }
  return {};
}

/// The names that "slice%03d.raw 1 20 1" stands for: a pattern with a number, the first, the last and the
/// step.
std::vector<std::string> names_of_pattern(std::string_view value) {
  const std::size_t percent = value.find('%');
  std::size_t end = percent + 1;
  while (end < value.size() && std::isdigit(static_cast<unsigned char>(value[end])) != 0) ++end;
  const std::size_t blank = std::min(value.find_first_of(" \t", end), value.size());
  const auto range = parse_number_list<std::int64_t>(value.substr(blank));
  if (end >= value.size() || value[end] != 'd' || !range || range->size() < 2) return {};
  const std::string digits(value.substr(percent + 1, end - percent - 1));
  // The width is the one asked for, but no more than a name may have.
  const std::size_t width =
      std::min<std::size_t>(digits.empty() ? 0 : std::strtoul(digits.c_str(), nullptr, 10), 255);
  const char fill = digits.starts_with('0') ? '0' : ' ';
  const std::int64_t first = (*range)[0], last = (*range)[1], step = range->size() > 2 ? (*range)[2] : 1;
  std::vector<std::string> names;
  for (std::int64_t n = first; step > 0 && n <= last && std::ssize(names) < kMostNames;) {
    std::string number = std::to_string(n);
    if (number.size() < width) number.insert(0, width - number.size(), fill);
    names.push_back(
        fmt::format("{}{}{}", value.substr(0, percent), number, value.substr(end + 1, blank - end - 1)));
    if (static_cast<std::uint64_t>(last) - static_cast<std::uint64_t>(n) < static_cast<std::uint64_t>(step))
      break;
    n += step;
  }
  return names;
}

std::vector<std::string> names_in_header(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::string text(kLongestHeader, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  std::vector<std::string> names;
  bool listed = false;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = trimmed(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (listed) {
      if (!line.empty()) names.emplace_back(line);
      continue;
    }
    // The header ends here, and samples follow.
    if (line.empty()) break;
    const auto value = data_field(line);
    if (!value) continue;
    listed = *value == "LIST" || value->starts_with("LIST ");
    if (listed) continue;
    if (value->find('%') != std::string_view::npos) return names_of_pattern(*value);
    return {std::string(*value)};
  }
  return names;
}

}  // namespace

std::vector<std::filesystem::path> files_in_header(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files;
  for (const std::string& name : names_in_header(path)) files.push_back(path.parent_path() / name);
  return files;
}

std::vector<std::filesystem::path> referred_files(const std::filesystem::path& path) {
  std::error_code code;
  const InputFormat* format = find_format_by_name(path);
  if (format == nullptr || format->referred_files == nullptr) return {};
  return std::filesystem::is_regular_file(path, code) ? format->referred_files(path)
                                                      : std::vector<std::filesystem::path>();
}

}  // namespace adamas::io
