#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace adamas::isosurface {

/// The triangles at each point of a surface, while triangles are removed or get other corners.
class TriangleStars {
 public:
  using Triangle = std::array<std::uint32_t, 3>;
  static constexpr std::uint32_t kNone = 0xffffffffu;  ///< the first corner of a removed triangle

  TriangleStars(std::vector<Triangle>& triangles, std::size_t points)
      : triangles_(triangles), first_(points, kNone), next_(3 * triangles.size(), kNone) {
    // The loop runs from the last to the first, so that lists are in order.
    for (std::size_t n = triangles.size(); n-- > 0;) {
      for (std::size_t c = 3; c-- > 0;) {
        next_[3 * n + c] = first_[triangles[n][c]];
        first_[triangles[n][c]] = static_cast<std::uint32_t>(3 * n + c);
      }
    }
  }

  /// Calls visit(after, before) with the other two corners of each triangle at a point.
  template <class Visit>
  void for_each(std::uint32_t p, Visit&& visit) {
    std::uint32_t* link = &first_[p];
    while (*link != kNone) {
      const std::uint32_t corner = *link, n = corner / 3, c = corner % 3;
      const Triangle& t = triangles_[n];
      if (t[0] == kNone) {
        *link = next_[corner];  // the triangle was removed
        continue;
      }
      visit(t[c == 2 ? 0 : c + 1], t[c == 0 ? 2 : c - 1]);
      link = &next_[corner];
    }
  }

  /// Removes the triangles at a point. Returns their number.
  std::size_t remove(std::uint32_t p) {
    std::size_t lost = 0;
    for (std::uint32_t corner = first_[p]; corner != kNone; corner = next_[corner]) {
      std::uint32_t& first = triangles_[corner / 3][0];
      lost += first == kNone ? 0 : 1;
      first = kNone;
    }
    first_[p] = kNone;
    return lost;
  }

  /// Replaces the point `from` by `to`. Returns the number of triangles that this removes.
  std::size_t collapse(std::uint32_t from, std::uint32_t to) {
    std::size_t lost = 0;
    std::uint32_t* link = &first_[from];
    while (*link != kNone) {
      const std::uint32_t corner = *link;
      Triangle& t = triangles_[corner / 3];
      if (t[0] == kNone || t[0] == to || t[1] == to || t[2] == to) {
        lost += t[0] == kNone ? 0 : 1;
        t[0] = kNone;
        *link = next_[corner];
      } else {
        t[corner % 3] = to;
        link = &next_[corner];
      }
    }
    *link = first_[to];
    first_[to] = first_[from];
    first_[from] = kNone;
    return lost;
  }

 private:
  std::vector<Triangle>& triangles_;  ///< the first corner of removed ones is kNone
  std::vector<std::uint32_t> first_, next_;
};

/// Finds the points of a surface at its border, where the triangles do not surround the point.
std::vector<bool> border_points(std::span<const TriangleStars::Triangle> triangles, std::size_t points);

}  // namespace adamas::isosurface
