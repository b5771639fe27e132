#include "core/io/volume_stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "core/base/error.h"
#include "core/io/volume_import.h"

namespace adamas::io {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// A part of a pattern: text, or a placeholder.
struct Part {
  enum class Kind { kText, kAny, kOne, kNumber } kind = Kind::kText;
  std::string text;
  std::size_t digits = 0;  ///< the least number of digits of a number
};

/// Counted numbers have at most this many digits.
constexpr std::size_t kMostDigits = 20;

/// Parses "%d", "%i", "%4d" or "%04d" at `at`. Returns how many characters it takes, 0 if there is none
/// there, and sets `digits`, which is more than kMostDigits if the width is too great.
std::size_t number_format(const std::string& text, std::size_t at, std::size_t& digits) {
  std::size_t end = at + 1;
  while (end < text.size() && is_digit(text[end])) ++end;
  if (end >= text.size() || (text[end] != 'd' && text[end] != 'i' && text[end] != 'u')) return 0;
  digits = 1;
  const auto [stop, code] = std::from_chars(text.data() + at + 1, text.data() + end, digits);
  digits = code == std::errc::result_out_of_range ? kMostDigits + 1 : std::max<std::size_t>(digits, 1);
  return end + 1 - at;
}

std::vector<Part> parts_of(const std::string& pattern) {
  std::vector<Part> parts;
  for (std::size_t at = 0; at < pattern.size();) {
    const char c = pattern[at];
    std::size_t digits = 0, length = 1;
    if (c == '%' && (length = number_format(pattern, at, digits)) > 0) {
      parts.push_back({Part::Kind::kNumber, {}, digits});
    } else if (c == '#') {
      length = std::min(pattern.find_first_not_of('#', at), pattern.size()) - at;
      parts.push_back({Part::Kind::kNumber, {}, length});
    } else if (c == '*' || c == '?') {
      parts.push_back({c == '*' ? Part::Kind::kAny : Part::Kind::kOne, {}, 0});
    } else {
      length = 1;
      if (parts.empty() || parts.back().kind != Part::Kind::kText) parts.push_back({});
      parts.back().text += c;
    }
    at += length;
  }
  return parts;
}

bool has_too_wide_number(const std::vector<Part>& parts) {
  return std::any_of(parts.begin(), parts.end(), [](const Part& part) { return part.digits > kMostDigits; });
}

/// A name that fits the pattern, with an example for each number.
std::string example_of(const std::vector<Part>& parts) {
  std::string name;
  for (const Part& part : parts) {
    if (part.kind == Part::Kind::kAny) name += '*';
    if (part.kind == Part::Kind::kOne) name += '?';
    name += part.kind == Part::Kind::kNumber ? fmt::format("{:0{}}", 1, part.digits) : part.text;
  }
  return name;
}

/// Whether a name fits a pattern. A table of the prefixes that fit keeps the time short for any pattern.
bool fits(const std::string& name, const std::vector<Part>& parts) {
  const std::size_t size = name.size();
  std::vector<bool> reached(size + 1);
  reached[0] = true;
  for (const Part& part : parts) {
    std::vector<bool> next(size + 1);
    for (std::size_t at = 0; at <= size; ++at) {
      if (!reached[at]) continue;
      switch (part.kind) {
        case Part::Kind::kText:
          if (name.compare(at, part.text.size(), part.text) == 0) next[at + part.text.size()] = true;
          break;
        case Part::Kind::kAny:
          std::fill(next.begin() + static_cast<std::ptrdiff_t>(at), next.end(), true);
          break;
        case Part::Kind::kOne:
          if (at < size) next[at + 1] = true;
          break;
        case Part::Kind::kNumber: {
          std::size_t end = at;
          while (end < size && is_digit(name[end])) ++end;
          // A number longer than its width has no leading zeros.
          if (end - at == part.digits || (end - at > part.digits && name[at] != '0')) next[end] = true;
        }
      }
    }
    reached = std::move(next);
  }
  return reached[size];
}

/// The decimal number after `digits`, with at least as many digits.
std::string next_number(std::string digits) {
  for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit) {
    if (*digit != '9') {
      ++*digit;
      return digits;
    }
    *digit = '0';
  }
  return "1" + digits;
}

/// Throws Error, which names the first missing file, if the numbers of the names, which ascend, have gaps.
/// The number in a name is certain only if the pattern is text and one number.
void check_numbers(const std::filesystem::path& pattern, const std::vector<Part>& parts,
                   const std::vector<std::string>& names) {
  std::string before, behind;
  std::size_t numbers = 0;
  for (const Part& part : parts) {
    if (part.kind == Part::Kind::kAny || part.kind == Part::Kind::kOne) return;
    numbers += part.kind == Part::Kind::kNumber ? 1 : 0;
    (numbers == 0 ? before : behind) += part.text;
  }
  if (numbers != 1) return;
  for (std::size_t n = 1; n < names.size(); ++n) {
    const std::string& last = names[n - 1];
    const std::string next =
        before + next_number(last.substr(before.size(), last.size() - before.size() - behind.size())) +
        behind;
    if (names[n] != next)
      fail("{}: expected this file between {} and {}, found none", (pattern.parent_path() / next).string(),
           last, names[n]);
  }
}

}  // namespace

std::string numbered_name(const std::string& pattern, std::size_t number) {
  std::string name;
  std::size_t numbers = 0;
  const std::vector<Part> parts = parts_of(pattern);
  if (has_too_wide_number(parts)) return {};
  for (const Part& part : parts) {
    if (part.kind == Part::Kind::kAny || part.kind == Part::Kind::kOne) return {};
    if (part.kind == Part::Kind::kNumber) ++numbers;
    name += part.kind == Part::Kind::kNumber ? fmt::format("{:0{}}", number, part.digits) : part.text;
  }
  return numbers == 1 ? name : std::string();
}

bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (!is_digit(a[i]) || !is_digit(b[j])) {
      if (a[i] != b[j]) return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
      ++i, ++j;
      continue;
    }
    const auto number = [](const std::string& text, std::size_t& at) {
      while (at < text.size() && text[at] == '0') ++at;
      const std::size_t begin = at;
      while (at < text.size() && is_digit(text[at])) ++at;
      return text.substr(begin, at - begin);
    };
    const std::string left = number(a, i), right = number(b, j);
    if (left.size() != right.size()) return left.size() < right.size();
    if (left != right) return left < right;
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;  // they differ at most in leading zeros of numbers
}

std::vector<std::filesystem::path> match_stack(const std::filesystem::path& pattern) {
  const std::vector<Part> parts = parts_of(pattern.filename().string());
  if (std::all_of(parts.begin(), parts.end(), [](const Part& p) { return p.kind == Part::Kind::kText; })) {
    fail("{}: expected a pattern with *, ?, # or %d in the file's name, found none", pattern.string());
  }
  if (has_too_wide_number(parts))
    fail("{}: expected numbers of at most {} digits in the pattern, found more", pattern.string(),
         kMostDigits);
  const std::filesystem::path folder = pattern.has_parent_path() ? pattern.parent_path() : ".";
  std::error_code code;
  std::filesystem::directory_iterator entries(folder, code);
  if (code) fail("{}: expected a folder that can be read: {}", folder.string(), code.message());
  std::vector<std::string> names;
  std::size_t others = 0;
  for (; !code && entries != std::filesystem::directory_iterator(); entries.increment(code)) {
    std::error_code other;
    std::string name = entries->path().filename().string();
    if (!entries->is_regular_file(other)) continue;
    if (fits(name, parts)) {
      names.push_back(std::move(name));
    } else {
      ++others;
    }
  }
  if (names.empty()) {
    fail("{}: expected files with names such as '{}' in '{}', found none among its {} files",
         pattern.string(), example_of(parts), folder.string(), others);
  }
  std::sort(names.begin(), names.end(), natural_less);
  check_numbers(pattern, parts, names);
  std::vector<std::filesystem::path> paths;
  for (const std::string& name : names) {
    paths.push_back(pattern.has_parent_path() ? pattern.parent_path() / name : std::filesystem::path(name));
  }
  return paths;
}

VolumeReader open_volume_stack(const std::vector<std::filesystem::path>& paths, const Vec3& spacing,
                               const Vec3& origin, const VolumeOptions& options, Progress& progress) {
  return VolumeReader(import_stack(paths, spacing, origin, options, progress));
}

}  // namespace adamas::io
