#include "cli/point_table.h"

#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>

#include "core/base/error.h"
#include "core/io/input_file.h"

namespace adamas {

namespace {

bool is_separator(char c) { return c == ',' || c == ';' || c == ' ' || c == '\t' || c == '\r'; }

std::optional<Vec3> parse_point(std::string_view line) {
  Vec3 p;
  const char* at = line.data();
  const char* const end = at + line.size();
  for (int axis = 0; axis < 3; ++axis) {
    while (at != end && is_separator(*at)) ++at;
    const auto [next, code] = std::from_chars(at, end, p[axis]);
    if (code != std::errc() || !std::isfinite(p[axis])) return {};
    if (next != end && !is_separator(*next)) return {};
    at = next;
  }
  return p;
}

/// A cell of text: in quotes where it would be taken for several.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

void append_number(std::string& line, double value) {
  line += ',';
  if (std::isfinite(value)) fmt::format_to(std::back_inserter(line), "{:.10g}", value);
}

}  // namespace

std::vector<Vec3> read_points(const std::filesystem::path& path) {
  check_input_file(path);
  const std::string text = read_file(path);
  std::vector<Vec3> points;
  std::size_t number = 0;
  bool names_allowed = true;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line(text.data() + begin, end - begin);
    begin = end + 1;
    ++number;
    while (!line.empty() && is_separator(line.back())) line.remove_suffix(1);
    if (line.empty() || line.front() == '#') continue;
    if (const auto p = parse_point(line)) {
      points.push_back(*p);
    } else if (!names_allowed || line.find_first_of("0123456789") == 0) {
      fail("{}:{}: expected three finite numbers, found '{}'", path.string(), number, line.substr(0, 60));
    }
    names_allowed = false;
  }
  if (points.empty()) fail("{}: expected points x,y,z, found none", path.string());
  return points;
}

std::string PointTable::csv() const {
  std::string text = "x,y,z,material,interface distance";
  for (const FieldInfo& f : fields) {
    const std::string unit = f.unit.empty() ? "" : " [" + f.unit + "]";
    for (int c = 0; c < f.components; ++c) {
      const std::string index = f.components > 1 ? fmt::format(":{}", c) : std::string();
      text += ',' + quoted(f.name + index + unit);
    }
  }
  text += '\n';
  for (const ProbeSample& s : samples) {
    fmt::format_to(std::back_inserter(text), "{:.10g},{:.10g},{:.10g},", s.point.x, s.point.y, s.point.z);
    if (s.inside) text += quoted(materials[s.material]);
    append_number(text, s.interface_distance);
    for (const double value : s.values) append_number(text, value);
    text += '\n';
  }
  return text;
}

}  // namespace adamas
