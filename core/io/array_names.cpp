#include "core/io/array_names.h"

#include <algorithm>
#include <cctype>

#include "adamas/text.h"
#include "core/io/header_text.h"

namespace adamas::io {

namespace {

constexpr std::string_view kSeparators = " _-:./";

bool is_separator(char c) { return kSeparators.find(c) != std::string_view::npos; }

std::string bare(std::string_view text) { return std::string(trimmed(text, kSeparators)); }

char plain(char c) { return c == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

bool alike(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (plain(a[i]) != plain(b[i])) return false;
  }
  return true;
}

/// The position of `word` in the text, in any case; npos if it is not there.
std::size_t find_alike(std::string_view text, std::string_view word) {
  for (std::size_t at = 0; at + word.size() <= text.size(); ++at) {
    if (alike(text.substr(at, word.size()), word)) return at;
  }
  return std::string_view::npos;
}

/// Removes "for", "of" or "in" at the text's end or start.
std::string without_preposition(std::string text) {
  for (const std::string_view word : {"for", "of", "in"}) {
    const std::size_t n = word.size();
    if (text.size() > n && alike(std::string_view(text).substr(0, n), word) && is_separator(text[n])) {
      return bare(std::string_view(text).substr(n));
    }
    if (text.size() > n && alike(std::string_view(text).substr(text.size() - n), word) &&
        is_separator(text[text.size() - n - 1])) {
      return bare(std::string_view(text).substr(0, text.size() - n));
    }
  }
  return text;
}

/// Moves a unit at the name's end, "(m/s)" or "[m/s]", out of the name.
std::string split_unit(std::string& name) {
  if (name.size() < 3 || (name.back() != ')' && name.back() != ']')) return {};
  const std::size_t open = name.rfind(name.back() == ')' ? '(' : '[');
  if (open == std::string::npos || open == 0 || (name.back() == ')' && name[open - 1] != ' ')) return {};
  std::string unit = name.substr(open + 1, name.size() - open - 2);
  name = bare(std::string_view(name).substr(0, open));
  return unit;
}

/// Removes a material's name from either end of the text.
std::optional<std::string> without_material(std::string_view text, std::string_view material) {
  const std::size_t n = material.size();
  if (n == 0 || text.size() <= n + 1) return {};
  if (alike(text.substr(text.size() - n), material) && is_separator(text[text.size() - n - 1])) {
    return without_preposition(bare(text.substr(0, text.size() - n)));
  }
  if (alike(text.substr(0, n), material) && is_separator(text[n])) return bare(text.substr(n));
  return {};
}

std::optional<int> split_axis(std::string& name) {
  if (name.size() < 3) return {};
  const auto axis_of = [](char c) -> std::optional<int> {
    const char lower = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return lower >= 'x' && lower <= 'z' ? std::optional<int>(lower - 'x') : std::nullopt;
  };
  std::optional<int> axis;
  if (is_separator(name[1])) axis = axis_of(name[0]);
  if (axis) {
    name = bare(std::string_view(name).substr(2));
  } else if (is_separator(name[name.size() - 2])) {
    axis = axis_of(name.back());
    if (axis) name = bare(std::string_view(name).substr(0, name.size() - 2));
  }
  return axis;
}

}  // namespace

std::string no_points_text(const std::vector<std::string>& on_cells) {
  if (on_cells.empty()) return "none";
  constexpr std::size_t kMostNamed = 3, kShown = 60;
  std::string text = "values on cells alone, which cannot be taken as samples of a volume: ";
  for (std::size_t n = 0; n < std::min(on_cells.size(), kMostNamed); ++n)
    text += (n == 0 ? "'" : ", '") + printable(on_cells[n], kShown) + "'";
  return text + (on_cells.size() > kMostNamed ? ", ..." : "");
}

std::string plain_name(std::string_view name) {
  std::string result;
  for (const char c : name) {
    const char p = plain(c);
    if (p != ' ' || (!result.empty() && result.back() != ' ')) result += p;
  }
  while (!result.empty() && result.back() == ' ') result.pop_back();
  return result;
}

std::optional<std::string> fraction_material(const std::string& array) {
  for (const std::string_view pattern :
       {"volume fractions", "volume fraction", "volumefraction", "vol frac"}) {
    const std::size_t at = find_alike(array, pattern);
    if (at == std::string::npos) continue;
    const std::string before = bare(std::string_view(array).substr(0, at));
    const std::string after = bare(std::string_view(array).substr(at + pattern.size()));
    if (!before.empty() && after.empty()) return without_preposition(before);
    if (before.empty() && !after.empty()) return without_preposition(after);
    if (!before.empty()) return before + " " + without_preposition(after);
  }
  return {};
}

FieldName parse_field_name(const std::string& array, const std::vector<std::string>& materials) {
  FieldName field;
  field.name = array;
  field.unit = split_unit(field.name);
  std::size_t longest = 0;
  const std::string whole = field.name;
  for (std::size_t m = 0; m < materials.size(); ++m) {
    if (materials[m].size() <= longest) continue;
    const auto rest = without_material(whole, materials[m]);
    if (!rest || rest->empty()) continue;
    longest = materials[m].size();
    field.name = *rest;
    field.material = m;
  }
  if (field.material && field.unit.empty()) field.unit = split_unit(field.name);
  field.name_with_axis = field.name;
  field.axis = split_axis(field.name);
  return field;
}

}  // namespace adamas::io
