#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "adamas/files.h"
#include "adamas/text.h"
#include "core/base/error.h"
#include "core/io/input_file.h"

namespace adamas {

using namespace io;

namespace {

/// Splits a line into cells at semicolons; without semicolons at commas; without either at blanks.
std::vector<std::string_view> split_cells(std::string_view line) {
  const char separator = line.find(';') != line.npos ? ';' : line.find(',') != line.npos ? ',' : ' ';
  std::vector<std::string_view> cells;
  for (std::string_view rest = trimmed(line); !rest.empty();) {
    const std::size_t end = separator == ' ' ? rest.find_first_of(" \t\r") : rest.find(separator);
    cells.push_back(trimmed(rest.substr(0, end)));
    rest = end == rest.npos ? std::string_view() : rest.substr(end + 1);
    if (separator == ' ') rest = trimmed(rest);
  }
  return cells;
}

std::optional<double> parse_cell(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

std::optional<Vec3> parse_point(const std::vector<std::string_view>& cells) {
  if (cells.size() < 3) return {};
  Vec3 p;
  for (int axis = 0; axis < 3; ++axis) {
    const auto value = parse_cell(cells[static_cast<std::size_t>(axis)]);
    if (!value || !std::isfinite(*value)) return {};
    p[axis] = *value;
  }
  return p;
}

/// Whether a first line holds the names of columns.
bool holds_names(const std::vector<std::string_view>& cells) {
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  return !cells.empty() && std::any_of(cells[0].begin(), cells[0].end(), is_letter) && !parse_cell(cells[0]);
}

}  // namespace

std::vector<Vec3> read_points(const std::filesystem::path& path) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  check_input_file(path);
  const std::string text = read_file(path);
  std::vector<Vec3> points;
  std::size_t number = 0;
  bool names_allowed = true;
  for (std::size_t begin = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
       begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = trimmed(std::string_view(text).substr(begin, end - begin));
    begin = end + 1;
    ++number;
    if (line.empty() || line.front() == '#') continue;
    const auto cells = split_cells(line);
    if (std::exchange(names_allowed, false) && holds_names(cells)) continue;
    if (line.find(';') != line.npos && line.find(',') != line.npos) {
      fail("{}:{}: expected numbers as 0.5 between semicolons, found a comma in '{}'", path.string(), number,
           line.substr(0, 60));
    }
    const auto p = parse_point(cells);
    if (!p) {
      fail("{}:{}: expected three finite numbers, found '{}'", path.string(), number, line.substr(0, 60));
    }
    points.push_back(*p);
  }
  if (points.empty()) fail("{}: expected points x,y,z, found none", path.string());
  return points;
}

}  // namespace adamas
