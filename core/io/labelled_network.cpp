#include "core/io/labelled_network.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/io/header_text.h"

namespace adamas::io {

namespace {

constexpr std::string_view kSpaces = " \t\n\r\v\f";

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f'; }

/// The words of a text, with the numbers of their lines.
class Words {
 public:
  Words(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  /// The number of bytes not yet read.
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

namespace {

/// What a line says of a label.
struct RegionLine {
  std::string_view name;
  std::optional<std::array<double, 3>> colour;
};

/// The line of a table of ITK-SNAP, behind its label: three numbers of a colour up to 255, the opacity, two
/// that say how the label is shown, and the name in quotes. Its name is empty for other lines.
RegionLine table_line(std::string_view rest) {
  const std::size_t quote = rest.find('"');
  if (quote == std::string_view::npos || rest.back() != '"' || rest.size() < quote + 2) return {};
  std::string_view text = rest.substr(0, quote);
  std::array<double, 6> numbers{};
  std::size_t count = 0;
  for (text = trimmed(text, kSpaces); !text.empty(); ++count) {
    const std::size_t end = std::min(text.find_first_of(kSpaces), text.size());
    if (text.substr(0, end).find_first_not_of("0123456789.-+e") != std::string_view::npos) return {};
    if (count < numbers.size()) std::from_chars(text.data(), text.data() + end, numbers[count]);
    text = trimmed(text.substr(end), kSpaces);
  }
  if (count != numbers.size()) return {};
  RegionLine line{trimmed(rest.substr(quote + 1, rest.size() - quote - 2), kSpaces), {}};
  const auto in_range = [](double part) { return part >= 0 && part <= 255; };
  if (numbers[3] > 0 && std::all_of(numbers.begin(), numbers.begin() + 3, in_range))
    line.colour = {numbers[0] / 255, numbers[1] / 255, numbers[2] / 255};
  return line;
}

}  // namespace

RegionTable parse_region_table(std::string_view text, const std::string& name) {
  RegionTable regions;
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    line = trimmed(line, kSpaces);
    if (line.empty() || line[0] == '#' || line[0] == '(') continue;
    std::int64_t label = 0;
    const auto [rest, code] = std::from_chars(line.data(), line.data() + line.size(), label);
    std::string_view label_name = line.substr(static_cast<std::size_t>(rest - line.data()));
    const bool separated = !label_name.empty() && is_space(label_name[0]);
    label_name = trimmed(label_name, kSpaces);
    RegionLine region = table_line(label_name);
    if (region.name.empty()) region = {label_name, {}};
    if (code != std::errc() || !separated || region.name.empty()) {
      fail("{}: line {}: expected a label and its region's name, found '{}'", name, number,
           printable(line, 20));
    }
    if (!regions.names.try_emplace(label, region.name).second) {
      fail("{}: line {}: expected one name for each label, found a second for {}", name, number, label);
    }
    if (region.colour) regions.colours.emplace(label, *region.colour);
  }
  return regions;
}

namespace {

struct Region {
  double volume = 0;  ///< the volume if the first label were the front
  Vec3 center;
  std::size_t corners = 0;
  std::size_t open_edges = 0;
};

/// Counts, per region, the edges whose triangles do not traverse it equally often in both directions.
void count_open_edges(const LabelledNetwork& network, std::map<std::int32_t, Region>& regions) {
  std::vector<std::array<std::int64_t, 4>> edges;  // smaller point, greater point, label, direction
  edges.reserve(network.triangles.size() * 6);
  for (std::size_t t = 0; t < network.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t a = network.triangles[t][i], b = network.triangles[t][(i + 1) % 3];
      const std::int64_t direction = a < b ? 1 : -1;
      edges.push_back({std::min(a, b), std::max(a, b), network.labels[t][0], -direction});
      edges.push_back({std::min(a, b), std::max(a, b), network.labels[t][1], direction});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    std::int64_t sum = 0;
    std::size_t j = i;
    for (; j < edges.size() && std::equal(edges[i].begin(), edges[i].begin() + 3, edges[j].begin()); ++j) {
      sum += edges[j][3];
    }
    if (sum != 0) ++regions[static_cast<std::int32_t>(edges[i][2])].open_edges;
    i = j;
  }
}

std::map<std::int32_t, Region> measure(const LabelledNetwork& network) {
  std::map<std::int32_t, Region> regions;
  const auto each = [&network](const auto& visit) {
    for (std::size_t t = 0; t < network.triangles.size(); ++t) {
      if (network.labels[t][0] == network.labels[t][1]) continue;
      for (std::size_t side = 0; side < 2; ++side) visit(network.labels[t][side], network.triangles[t], side);
    }
  };
  each([&](std::int32_t label, const std::array<std::uint32_t, 3>& corners, std::size_t) {
    Region& region = regions[label];
    for (const std::uint32_t corner : corners) region.center += network.points[corner];
    region.corners += 3;
  });
  for (auto& [label, region] : regions) region.center *= 1.0 / static_cast<double>(region.corners);
  each([&](std::int32_t label, const std::array<std::uint32_t, 3>& corners, std::size_t side) {
    Region& region = regions[label];
    const auto& p = network.points;
    const double volume = signed_volume(region.center, p[corners[0]], p[corners[1]], p[corners[2]]);
    region.volume += side == 0 ? -volume : volume;
  });
  count_open_edges(network, regions);
  return regions;
}

}  // namespace

bool first_label_is_front(const LabelledNetwork& network) {
  const auto regions = measure(network);
  const bool any_closed = std::any_of(regions.begin(), regions.end(),
                                      [](const auto& entry) { return entry.second.open_edges == 0; });
  std::ptrdiff_t votes = 0;
  const Region* smallest = nullptr;
  for (const auto& [label, region] : regions) {
    if (any_closed && region.open_edges != 0) continue;
    if (smallest == nullptr) smallest = &region;
    votes += region.volume > 0 ? 1 : region.volume < 0 ? -1 : 0;
  }
  if (votes != 0) return votes > 0;
  return smallest == nullptr || smallest->volume <= 0;
}

InterfaceMesh to_interface_mesh(const LabelledNetwork& network,
                                const std::map<std::int64_t, std::string>& names, const std::string& source) {
  InterfaceMesh mesh;
  mesh.source = source;
  mesh.points = network.points;
  std::map<std::int32_t, MaterialId> materials;
  for (const auto& pair : network.labels) {
    for (const std::int32_t label : pair) materials.try_emplace(label);
  }
  std::set<std::string> taken;
  for (auto& [label, material] : materials) {
    material = mesh.materials.next_id();
    const auto name = names.find(label);
    mesh.materials.push_back(name != names.end() ? name->second : std::to_string(label));
    if (!taken.insert(mesh.materials.back()).second) {
      fail("{}: expected regions of different names, found '{}' twice", source, mesh.materials.back());
    }
  }
  const bool first_is_front = first_label_is_front(network);
  for (std::size_t t = 0; t < network.triangles.size(); ++t) {
    const auto [first, second] = network.labels[t];
    if (first == second) continue;
    const MaterialId a = materials.at(first), b = materials.at(second);
    mesh.triangles.push_back({network.triangles[t], first_is_front ? a : b, first_is_front ? b : a});
  }
  return mesh;
}

}  // namespace adamas::io
