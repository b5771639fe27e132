#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/geometry/place_text.h"
#include "interfaces/network/check.h"
#include "interfaces/network/domain_faces.h"
#include "interfaces/network/mending.h"

namespace adamas::interfaces {

namespace {

using Corners = std::array<std::uint32_t, 3>;
/// Front and back of a triangle that runs through its corners in ascending order.
using Sides = std::pair<MaterialId, MaterialId>;

struct Item {
  Corners corners;  ///< places in the order of coordinates, ascending
  std::uint32_t triangle;
  Sides sides;
};

/// Triangles on the same points: `items[begin, end)`.
struct Group {
  std::size_t begin, end;
};

bool is_odd(const Corners& c) { return (c[0] > c[1]) != ((c[1] > c[2]) != (c[0] > c[2])); }

/// The sides of a stack of layers: the materials that are in front once more than behind, and behind once
/// more than in front. Both are invalid where it has the same material on either side; none where this is no
/// stack.
std::optional<Sides> ends_of_stack(const std::vector<Sides>& sides) {
  std::vector<std::pair<MaterialId, int>> balance;
  const auto count = [&balance](MaterialId m, int step) {
    const auto at = std::find_if(balance.begin(), balance.end(), [m](const auto& b) { return b.first == m; });
    if (at == balance.end()) {
      balance.emplace_back(m, step);
    } else {
      at->second += step;
    }
  };
  for (const auto& [front, back] : sides) count(front, 1), count(back, -1);
  Sides ends;
  for (const auto& [material, n] : balance) {
    if (n == 0) continue;
    MaterialId& end = n > 0 ? ends.first : ends.second;
    if (std::abs(n) > 1 || end.valid()) return std::nullopt;
    end = material;
  }
  return ends;
}

class Merging {
 public:
  Merging(InterfaceMesh& mesh, const Box3* domain, bool tolerant)
      : mesh_(mesh), domain_(domain), tolerant_(tolerant) {}

  CoincidentTriangles run() {
    find_groups();
    if (groups_.empty()) return {};
    removed_.assign(mesh_.triangles.size(), 0);
    for (const Group& g : groups_) merge(g);
    if (!tolerant_ && !cancelled_.empty()) check_holes();
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (removed_[t] == 0) mesh_.triangles[kept++] = mesh_.triangles[t];
    }
    mesh_.triangles.resize(kept);
    return result_;
  }

 private:
  void find_groups() {
    const std::vector<std::uint32_t> place = order_points();
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const InterfaceTriangle& triangle = mesh_.triangles[t];
      Corners c;
      for (std::size_t i = 0; i < 3; ++i) c[i] = place[triangle.points[i]];
      if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
      const bool odd = is_odd(c);
      std::sort(c.begin(), c.end());
      items_.push_back(
          {c, t, odd ? Sides{triangle.back, triangle.front} : Sides{triangle.front, triangle.back}});
    }
    std::sort(items_.begin(), items_.end(), [](const Item& a, const Item& b) {
      return std::tie(a.corners, a.triangle) < std::tie(b.corners, b.triangle);
    });
    for (std::size_t begin = 0, end = 0; begin < items_.size(); begin = end) {
      while (end < items_.size() && items_[end].corners == items_[begin].corners) ++end;
      if (end - begin > 1) groups_.push_back({begin, end});
    }
    std::sort(groups_.begin(), groups_.end(), [this](const Group& a, const Group& b) {
      return items_[a.begin].triangle < items_[b.begin].triangle;
    });
  }

  /// Of each point its place in the order of coordinates, the same for equal ones: so what remains does not
  /// depend on the order of the points.
  std::vector<std::uint32_t> order_points() {
    std::vector<std::uint32_t> place(mesh_.points.size());
    std::iota(place.begin(), place.end(), 0u);
    at_ = place;
    const std::vector<Vec3>& p = mesh_.points;
    std::sort(at_.begin(), at_.end(), [&p](std::uint32_t a, std::uint32_t b) {
      return std::tie(p[a].x, p[a].y, p[a].z) < std::tie(p[b].x, p[b].y, p[b].z);
    });
    for (std::uint32_t i = 0; i < at_.size(); ++i)
      place[at_[i]] = i > 0 && p[at_[i]] == p[at_[i - 1]] ? place[at_[i - 1]] : i;
    return place;
  }
  [[nodiscard]] const Vec3& point(std::uint32_t place) const { return mesh_.points[at_[place]]; }

  void merge(const Group& group) {
    std::vector<Sides> sides;
    for (std::size_t i = group.begin; i < group.end; ++i) sides.push_back(items_[i].sides);
    std::optional<Sides> ends = ends_of_stack(sides);
    if (!ends) {
      std::sort(sides.begin(), sides.end());
      const auto same = std::unique(sides.begin(), sides.end());
      for (auto i = same; i != sides.end(); ++i) result_.duplicates.add(place(group));
      sides.erase(same, sides.end());
      ends = ends_of_stack(sides);
    }
    if (!ends && !tolerant_) refuse(group, "materials that contradict each other");
    const auto [front, back] = ends.value_or(sides.front());
    const bool remains = front.valid();
    Mended& kind = !ends ? result_.contradictions : (remains ? result_.thin_layers : result_.cancelled);
    for (std::size_t i = remains ? 1 : 0; i < sides.size(); ++i) kind.add(place(group));
    for (std::size_t i = group.begin; i < group.end; ++i) removed_[items_[i].triangle] = 1;
    if (!remains) return cancelled_.push_back(group);
    const Item& first = items_[group.begin];
    removed_[first.triangle] = 0;
    InterfaceTriangle& triangle = mesh_.triangles[first.triangle];
    const bool upwards = Sides{triangle.front, triangle.back} == first.sides;
    triangle.front = upwards ? front : back;
    triangle.back = upwards ? back : front;
  }

  /// Of parts that touch, the faces between them may go; of a sound surface none can be missed.
  void check_holes() const {
    std::vector<std::array<std::uint32_t, 2>> edges;
    const auto for_each_edge = [](const Corners& c, const auto& visit) {
      visit(c[0], c[1]);
      visit(c[0], c[2]);
      visit(c[1], c[2]);
    };
    for (const Item& item : items_) {
      if (removed_[item.triangle] != 0) continue;
      for_each_edge(item.corners, [&](std::uint32_t a, std::uint32_t b) { edges.push_back({a, b}); });
    }
    std::sort(edges.begin(), edges.end());
    for (const Group& group : cancelled_) {
      for_each_edge(items_[group.begin].corners, [&](std::uint32_t a, std::uint32_t b) {
        const std::array<std::uint32_t, 2> edge{a, b};
        const auto [first, last] = std::equal_range(edges.begin(), edges.end(), edge);
        if (last - first != 1 || outward_of_edge(domain_, point(a), point(b)) != Vec3{}) return;
        refuse(group, "opposite faces");
      });
    }
  }

  [[nodiscard]] Vec3 place(const Group& group) const {
    const Corners& c = items_[group.begin].corners;
    return (1.0 / 3) * (point(c[0]) + point(c[1]) + point(c[2]));
  }

  [[noreturn]] void refuse(const Group& group, const char* what) const {
    std::string found;
    for (std::size_t i = group.begin; i < group.end; ++i) {
      const auto& [front, back] = items_[i].sides;
      found += fmt::format("{}{}: {}|{}", found.empty() ? "" : ", ", items_[i].triangle,
                           mesh_.materials[front], mesh_.materials[back]);
    }
    throw TolerableFault(fmt::format("{}: expected one triangle on the three points round {}, found {}, {}",
                                     mesh_.source, place_text(place(group)), what, found));
  }

  InterfaceMesh& mesh_;
  const Box3* domain_;
  bool tolerant_;
  std::vector<std::uint32_t> at_;  ///< the point at each place
  std::vector<Item> items_;
  std::vector<Group> groups_;  ///< by their first triangles
  std::vector<Group> cancelled_;
  std::vector<char> removed_;
  CoincidentTriangles result_;
};

}  // namespace

CoincidentTriangles merge_coincident_triangles(InterfaceMesh& mesh, const Box3* domain, bool tolerant) {
  return Merging(mesh, domain, tolerant).run();
}

}  // namespace adamas::interfaces
