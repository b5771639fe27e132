#include "core/io/network_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/error.h"
#include "core/io/header_text.h"

namespace adamas::io {

namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f'; }

/// Words of a text, with the line they are on.
class Words {
 public:
  Words(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  /// Bytes not yet read.
  [[nodiscard]] std::size_t left() const { return text_.size() - at_; }

  std::size_t count(const std::string& items, std::size_t least_bytes) {
    const auto value = number<std::int64_t>("number of " + items);
    if (value < 0 || static_cast<std::uint64_t>(value) > 0xfffffffeull) {
      fail("{}: line {}: expected the number of {}, found {}", name_, line_, items, value);
    }
    const auto result = static_cast<std::size_t>(value);
    if (result > left() / least_bytes + 1) {
      fail("{}: line {}: expected {} {}, found {} bytes before the file's end", name_, line_, value, items,
           left());
    }
    return result;
  }

  template <class T>
  T number(const std::string& what) {
    std::string_view word = next();
    if (word.empty()) fail("{}: line {}: expected the {}, found the file's end", name_, line_, what);
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    T value{};
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (code != std::errc() || end != word.data() + word.size()) {
      fail("{}: line {}: expected the {}, found '{}'", name_, line_, what, printable(word, 20));
    }
    return value;
  }

  double coordinate() {
    const double value = number<double>("coordinate of a point");
    if (!std::isfinite(value))
      fail("{}: line {}: expected a finite coordinate, found {}", name_, line_, value);
    return value;
  }

  std::uint32_t index(std::size_t points) {
    const auto value = number<std::int64_t>("index of a point");
    if (value < 0 || static_cast<std::uint64_t>(value) >= points) {
      fail("{}: line {}: expected the index of one of {} points, found {}", name_, line_, points, value);
    }
    return static_cast<std::uint32_t>(value);
  }

  void expect_end() {
    const std::string_view word = next();
    if (!word.empty())
      fail("{}: line {}: expected the file's end, found '{}'", name_, line_, printable(word, 20));
  }

  [[nodiscard]] std::size_t line() const { return line_; }

 private:
  std::string_view next() {
    for (; at_ < text_.size() && is_space(text_[at_]); ++at_) {
      if (text_[at_] == '\n') ++line_;
    }
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};

}  // namespace

LabelledNetwork parse_labelled_network(std::string_view text, const std::string& name) {
  Words words(text, name);
  LabelledNetwork network;
  const std::size_t points = words.count("points", 6);
  network.points.reserve(points);
  for (std::size_t i = 0; i < points; ++i) {
    const double x = words.coordinate(), y = words.coordinate();
    network.points.push_back({x, y, words.coordinate()});
  }
  const std::size_t triangles = words.count("triangles", 10);
  network.triangles.reserve(triangles);
  network.labels.reserve(triangles);
  for (std::size_t i = 0; i < triangles; ++i) {
    const std::uint32_t a = words.index(points), b = words.index(points), c = words.index(points);
    if (a == b || b == c || c == a) {
      fail("{}: line {}: expected three different points, found {} {} {}", name, words.line(), a, b, c);
    }
    const auto left = words.number<std::int32_t>("label of a region");
    network.triangles.push_back({a, b, c});
    network.labels.push_back({left, words.number<std::int32_t>("label of a region")});
  }
  words.expect_end();
  return network;
}

std::map<std::int32_t, std::string> parse_region_names(std::string_view text, const std::string& name) {
  std::map<std::int32_t, std::string> names;
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    while (!line.empty() && is_space(line.front())) line.remove_prefix(1);
    while (!line.empty() && is_space(line.back())) line.remove_suffix(1);
    if (line.empty() || line[0] == '#' || line[0] == '(') continue;
    std::int32_t label = 0;
    const auto [rest, code] = std::from_chars(line.data(), line.data() + line.size(), label);
    std::string_view label_name = line.substr(static_cast<std::size_t>(rest - line.data()));
    const bool separated = !label_name.empty() && is_space(label_name[0]);
    while (!label_name.empty() && is_space(label_name.front())) label_name.remove_prefix(1);
    if (code != std::errc() || !separated || label_name.empty()) {
      fail("{}: line {}: expected a label and its region's name, found '{}'", name, number,
           printable(line, 20));
    }
    if (!names.try_emplace(label, label_name).second) {
      fail("{}: line {}: expected one name for each label, found a second for {}", name, number, label);
    }
  }
  return names;
}

}  // namespace adamas::io
