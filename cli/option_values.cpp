#include "cli/option_values.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "adamas/text.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

/// Returns a whole number from `least` on.
std::size_t parse_count_from(std::size_t least, const std::string& option, const std::string& text) {
  std::size_t value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || value < least) {
    wrong_usage("{}: expected a whole number of at least {}, found '{}'", option, least, text);
  }
  return value;
}

}  // namespace

std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

double parse_positive(const std::string& option, const std::string& text) {
  const auto value = to_number(text);
  if (!value || !(*value > 0)) wrong_usage("{}: expected a positive number, found '{}'", option, text);
  return *value;
}

double parse_up_to(const std::string& option, const std::string& text, double greatest) {
  const auto value = to_number(text);
  if (!value || !(*value >= 0 && *value <= greatest))
    wrong_usage("{}: expected a number from 0 to {}, found '{}'", option, greatest, text);
  return *value;
}

double parse_part(const std::string& option, const std::string& text, double greatest) {
  const bool percent = !text.empty() && text.back() == '%';
  const auto value = to_number(percent ? text.substr(0, text.size() - 1) : text);
  const double whole = percent ? 100 : 1;
  if (!value || !(*value >= 0 && *value <= greatest * whole))
    wrong_usage("{}: expected a part from 0 to {}, or from 0% to {}%, found '{}'", option, greatest,
                100 * greatest, text);
  return *value / whole;
}

double parse_percentage(const std::string& option, const std::string& text) {
  const auto value = text.ends_with('%') ? to_number(text.substr(0, text.size() - 1)) : std::nullopt;
  if (!value || !(*value > 0 && *value < 100))
    wrong_usage("{}: expected a part above 0% and below 100% as 1%, found '{}'", option, text);
  return *value / 100;
}

std::size_t parse_count(const std::string& option, const std::string& text) {
  return parse_count_from(1, option, text);
}

std::size_t parse_count_from_0(const std::string& option, const std::string& text) {
  return parse_count_from(0, option, text);
}

std::size_t parse_size(const std::string& option, const std::string& text) {
  constexpr std::string_view kUnits = "KMGT";
  std::size_t value = 0;
  const char* end = text.data() + text.size();
  const auto [at, code] = std::from_chars(text.data(), end, value);
  const std::size_t unit = at + 1 == end
                               ? kUnits.find(static_cast<char>(std::toupper(static_cast<unsigned char>(*at))))
                               : std::string_view::npos;
  const unsigned shift = unit == std::string_view::npos ? 0 : 10 * (static_cast<unsigned>(unit) + 1);
  const bool whole = at == end || unit != std::string_view::npos;
  if (code != std::errc() || !whole || value == 0 || value > (~std::size_t{0} >> shift)) {
    wrong_usage("{}: expected a size as 100000, 512K, 256M or 2G, found '{}'", option, text);
  }
  return value << shift;
}

std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count) {
  std::vector<double> values;
  for (const std::string& part : split_at_commas(text)) {
    if (const auto value = to_number(part)) values.push_back(*value);
  }
  if (values.size() != count || split_at_commas(text).size() != count) {
    if (count == 1) wrong_usage("{}: expected a finite number, found '{}'", option, text);
    wrong_usage("{}: expected {} finite numbers with commas between them, found '{}'", option, count, text);
  }
  return values;
}

double parse_number(const std::string& option, const std::string& text) {
  return parse_numbers(option, text, 1)[0];
}

std::array<double, 2> parse_two_numbers(const std::string& option, const std::string& text) {
  const auto values = parse_numbers(option, text, 2);
  return {values[0], values[1]};
}

Vec3 parse_vector(const std::string& option, const std::string& text) {
  const auto v = parse_numbers(option, text, 3);
  return {v[0], v[1], v[2]};
}

Plane parse_plane_option(const std::string& option, const std::string& text) {
  std::string lower = text;
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  try {
    return parse_plane(lower);
  } catch (const Error&) {
    wrong_usage("{}: expected x=NUMBER, y=NUMBER or z=NUMBER, found '{}'", option, text);
  }
}

std::array<double, 6> parse_bounds(const std::string& option, const std::string& text) {
  const auto v = parse_numbers(option, text, 6);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (v[2 * axis] < v[2 * axis + 1]) continue;
    wrong_usage("{}: expected {}0 < {}1 in x0,x1,y0,y1,z0,z1, found '{}'", option, "xyz"[axis], "xyz"[axis],
                text);
  }
  return {v[0], v[1], v[2], v[3], v[4], v[5]};
}

Box3 parse_box(const std::string& option, const std::string& text) {
  const auto b = parse_bounds(option, text);
  return {{b[0], b[2], b[4]}, {b[1], b[3], b[5]}};
}

ErrorTarget parse_distance(const std::string& option, const std::string& text) {
  return parse_error_target(option, text, true);
}

std::array<std::size_t, 3> parse_dimensions(const std::string& option, const std::string& text) {
  std::vector<std::string> parts = split_at_commas(text);
  if (parts.size() == 1) parts.resize(3, parts[0]);
  std::array<std::size_t, 3> counts{};
  bool good = parts.size() == 3;
  for (std::size_t i = 0; good && i < 3; ++i) {
    const char* end = parts[i].data() + parts[i].size();
    const auto [at, code] = std::from_chars(parts[i].data(), end, counts[i]);
    good = code == std::errc() && at == end && counts[i] > 0;
  }
  if (!good) wrong_usage("{}: expected whole numbers X,Y,Z of at least 1, found '{}'", option, text);
  return counts;
}

std::pair<std::string, std::string> parse_assignment(const std::string& option, const std::string& text,
                                                     bool at_last) {
  const std::size_t at = at_last ? text.rfind('=') : text.find('=');
  if (at == std::string::npos || at == 0 || at + 1 == text.size()) {
    wrong_usage("{}: expected two parts with '=' between them, found '{}'", option, text);
  }
  return {text.substr(0, at), text.substr(at + 1)};
}

}  // namespace adamas::cli
