#include "isosurface/contour/join_points.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/assert.h"
#include "core/base/disjoint_sets.h"
#include "core/base/large_pages.h"
#include "core/lattice/point_numbers.h"
#include "isosurface/contour/coinciding_patches.h"
#include "isosurface/contour/joined_point.h"
#include "isosurface/contour/triangle_stars.h"

namespace adamas {

namespace {

using Triangle = TriangleStars::Triangle;
constexpr std::uint32_t kNone = TriangleStars::kNone;

template <class T>
std::vector<T> filled(std::size_t size, T value) {
  std::vector<T> result;
  reserve_in_large_pages(result, size);
  result.resize(size, value);
  return result;
}

class PointJoiner {
 public:
  explicit PointJoiner(Contour& contour)
      : contour_(contour), count_(static_cast<std::uint32_t>(contour.points.size())) {}

  void run() {
    find_vertices();
    keep_border_points();
    find_patches();
    keep_patches_that_are_no_discs();
    is_suspect_.assign(count_, true);
    while (separate_what_would_coincide()) {
    }
    replace();
  }

 private:
  /// The vertex that each point is near, as a number.
  void find_vertices() {
    vertices_ = filled(count_, kNone);
    PointNumbers numbers;
    numbers.expect(count_ / 3);
    std::uint32_t next = 0;
    for (std::uint32_t p = 0; p < count_; ++p) {
      const auto [number, is_new] = numbers.insert(contour_.edge_points[p].nearer_end());
      if (is_new) *number = next++;
      vertices_[p] = *number;
    }
  }

  /// Takes the vertices away from the points at the border, which are not joined.
  void keep_border_points() {
    const std::vector<bool> at_border = border_points(contour_.triangles, count_);
    for (std::uint32_t p = 0; p < count_; ++p) {
      if (at_border[p]) vertices_[p] = kNone;
    }
  }

  [[nodiscard]] bool same_vertex(std::uint32_t p, std::uint32_t q) const {
    return vertices_[p] == vertices_[q] && vertices_[p] != kNone;
  }

  /// Patches are the parts that hang together of the edges and triangles among points of one vertex. The
  /// least of a patch's points stands for it.
  void find_patches() {
    DisjointSets sets(count_);
    for (const Triangle& t : contour_.triangles) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t p = t[c], q = t[(c + 1) % 3];
        if (same_vertex(p, q)) sets.join(p, q);
      }
    }
    patch_.resize(count_);
    is_joined_.resize(count_);
    for (std::uint32_t p = 0; p < count_; ++p) {
      patch_[p] = sets.find(p);
      if (patch_[p] != p) is_joined_[patch_[p]] = true;
    }
  }

  /// A part of a surface whose Euler characteristic is 1 is a disc.
  void keep_patches_that_are_no_discs() {
    // Each edge is a side of two triangles.
    std::vector<std::int32_t> twice_euler = filled(count_, std::int32_t{0});
    for (std::uint32_t p = 0; p < count_; ++p) twice_euler[patch_[p]] += 2;
    for (const Triangle& t : contour_.triangles) {
      const std::array<std::uint32_t, 3> in{patch_[t[0]], patch_[t[1]], patch_[t[2]]};
      const bool first = in[0] == in[1], second = in[1] == in[2], third = in[2] == in[0];
      if (first) --twice_euler[in[0]];
      if (second) --twice_euler[in[1]];
      if (third) --twice_euler[in[2]];
      if (first && second) twice_euler[in[0]] += 2;
    }
    for (std::uint32_t p = 0; p < count_; ++p) {
      if (twice_euler[patch_[p]] != 2) apart_.push_back(patch_[p]);
    }
    take_apart();
  }

  /// Makes single points of all that are in the patches of `apart_`.
  void take_apart() {
    std::vector<bool> is_wanted(count_);
    for (const std::uint32_t patch : apart_) {
      is_wanted[patch] = true;
      is_joined_[patch] = false;
    }
    apart_.clear();
    is_suspect_.assign(count_, false);
    // A patch has the number of its first point, which is looked at when all others of it still have it.
    for (std::uint32_t p = count_; p-- > 0;) {
      if (!is_wanted[patch_[p]]) continue;
      is_suspect_[p] = true;
      patch_[p] = p;
    }
  }

  [[nodiscard]] Triangle joined(const Triangle& t) const {
    return {patch_[t[0]], patch_[t[1]], patch_[t[2]]};
  }
  static bool has_area(const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }

  /// Two edges that begin at one patch and end at one, and two triangles at the same three, are kept apart by
  /// taking those patches apart. What was taken apart may coincide with something else then, and nothing else
  /// may, so that these points alone are suspect the next time. Returns whether there were any.
  bool separate_what_would_coincide() {
    std::vector<CoincidingPatches::Suspect> suspects;
    for (std::uint32_t p = 0; p < count_; ++p) {
      if (is_suspect_[p] && patch_[p] == p) suspects.push_back({p, is_joined_[p]});
    }
    apart_ = coinciding_.find(count_, suspects, [&](const auto& visit) {
      for (const Triangle& triangle : contour_.triangles) {
        const Triangle t = joined(triangle);
        if (has_area(t)) visit(t);
      }
    });
    const bool found = !apart_.empty();
    if (found) take_apart();
    return found;
  }

  /// Joins the points: first those that stay, in their order, then the means, in the order of the patches.
  void replace() {
    std::vector<std::uint32_t> sizes = filled(count_, std::uint32_t{0});
    for (std::uint32_t p = 0; p < count_; ++p) ++sizes[patch_[p]];
    Contour result;
    std::vector<std::uint32_t> numbers = filled(count_, kNone);
    for (std::uint32_t p = 0; p < count_; ++p) {
      if (sizes[patch_[p]] != 1) continue;
      numbers[p] = static_cast<std::uint32_t>(result.points.size());
      result.points.push_back(contour_.points[p]);
      result.edge_points.push_back(contour_.edge_points[p]);
    }
    std::vector<JoinedPoint> means;
    const auto edge_count = static_cast<std::uint32_t>(result.points.size());
    for (std::uint32_t p = 0; p < count_; ++p) {
      const std::uint32_t patch = patch_[p];
      if (sizes[patch] == 1) continue;
      if (patch == p) {
        numbers[p] = edge_count + static_cast<std::uint32_t>(means.size());
        means.emplace_back();
      }
      means[numbers[patch] - edge_count].add(contour_.points[p], contour_.edge_points[p]);
    }
    for (const Triangle& triangle : contour_.triangles) {
      const Vec3 &a = contour_.points[triangle[0]], &b = contour_.points[triangle[1]],
                 &c = contour_.points[triangle[2]];
      const Vec3 area_vector = 0.5 * cross(b - a, c - a);
      const double area = norm(area_vector), moment = dot(area_vector, a);
      const Triangle t = joined(triangle);
      for (std::size_t n = 0; n < 3; ++n) {
        const bool is_first = n == 0 || (t[n] != t[0] && (n == 1 || t[n] != t[1]));
        if (is_first && sizes[t[n]] > 1)
          means[numbers[t[n]] - edge_count].add_triangle(area_vector, area, moment);
      }
    }
    for (const JoinedPoint& mean : means) {
      result.points.push_back(mean.position());
      result.vertex_points.push_back(mean.vertex_point());
    }
    for (const Triangle& triangle : contour_.triangles) {
      const Triangle t = joined(triangle);
      if (has_area(t)) result.triangles.push_back({numbers[t[0]], numbers[t[1]], numbers[t[2]]});
    }
    contour_ = std::move(result);
  }

  Contour& contour_;
  std::uint32_t count_;
  std::vector<std::uint32_t> vertices_;
  std::vector<std::uint32_t> patch_;
  std::vector<bool> is_joined_;       ///< whether a patch has several points, by its number
  std::vector<std::uint32_t> apart_;  ///< patches that are to be taken apart
  CoincidingPatches coinciding_;
  std::vector<bool> is_suspect_;  ///< patches with which something may coincide
};

}  // namespace

void join_points(Contour& contour) {
  ADAMAS_ASSERT(contour.points.size() == contour.edge_points.size());
  if (!contour.triangles.empty()) PointJoiner(contour).run();
}

}  // namespace adamas
