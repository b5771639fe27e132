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
#include "core/base/stable_vector.h"
#include "core/lattice/lattice_map.h"
#include "isosurface/contour/coinciding_patches.h"
#include "isosurface/contour/joined_point.h"
#include "isosurface/contour/triangle_stars.h"

namespace adamas::isosurface {

namespace {

using Triangle = TriangleStars::Triangle;
using Suspect = CoincidingPatches::Suspect;

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
    find_patches();
    for (bool found = separate_coinciding(); found;) found = separate_coinciding_once();
    replace();
  }

 private:
  /// Finds the nearest vertex of each point. Points at the border, which are not joined, each have a vertex
  /// of their own.
  void find_vertices() {
    const std::vector<bool> at_border = border_points(contour_.triangles, count_);
    reserve_in_large_pages(vertices_, count_);
    for (std::uint32_t p = 0; p < count_; ++p)
      vertices_.push_back(at_border[p] ? LatticePoint{kNoKey<LatticePoint>.i, static_cast<std::int32_t>(p), 0}
                                       : contour_.edge_points[p].nearer_end());
  }

  /// Finds patches: connected sets of edges and triangles between points of one vertex. The least of a
  /// patch's points represents it. Patches that are no discs are separated; a part of a surface is a disc if
  /// its Euler characteristic is 1.
  void find_patches() {
    DisjointSets sets(count_);
    // Each point has its contribution to the patch: 2, less one for each side of a triangle, since an edge
    // has two triangles, and two for the triangle.
    std::vector<std::int16_t> twice_euler = filled(count_, std::int16_t{2});
    reserve_in_large_pages(across_, contour_.triangles.size() / 2);
    for (std::uint32_t n = 0; n < contour_.triangles.size(); ++n) {
      const auto [p, q, r] = contour_.triangles[n];
      const LatticePoint near_p = vertices_[p], near_q = vertices_[q], near_r = vertices_[r];
      const bool first = is_same(near_p, near_q), second = is_same(near_q, near_r),
                 third = is_same(near_r, near_p);
      if (!first && !second && !third) {
        across_.push_back(n);
        continue;
      }
      const std::uint32_t in_patch = first || third ? p : q;
      --twice_euler[in_patch];
      sets.join(in_patch, first ? q : r);
      if (first && second) sets.join(q, r);
    }
    vertices_ = {};
    patch_ = std::move(sets).roots();
    is_joined_.resize(count_);
    for (std::uint32_t p = 0; p < count_; ++p) {
      if (patch_[p] == p) continue;
      is_joined_[patch_[p]] = true;
      twice_euler[patch_[p]] = static_cast<std::int16_t>(twice_euler[patch_[p]] + twice_euler[p]);
    }
    for (std::uint32_t p = 0; p < count_; ++p) {
      if (patch_[p] == p && twice_euler[p] != 2) to_separate_.push_back(p);
    }
    separate_patches();
  }

  /// Compares without branches, which would be unpredictable.
  static bool is_same(LatticePoint a, LatticePoint b) {
    return ((a.i ^ b.i) | (a.j ^ b.j) | (a.k ^ b.k)) == 0;
  }

  /// Turns all patches of `to_separate_` into single points.
  void separate_patches() {
    std::vector<bool> is_wanted(count_);
    for (const std::uint32_t patch : to_separate_) {
      is_wanted[patch] = true;
      is_joined_[patch] = false;
    }
    is_separated_.assign(count_, false);
    // A patch has the number of its first point, which is visited when all others of it still have this
    // number.
    for (std::uint32_t p = count_; !to_separate_.empty() && p-- > 0;) {
      if (!is_wanted[patch_[p]]) continue;
      is_separated_[p] = true;
      patch_[p] = p;
    }
    any_separated_ = !to_separate_.empty();
    to_separate_.clear();
  }

  [[nodiscard]] Triangle joined(const Triangle& t) const {
    return {patch_[t[0]], patch_[t[1]], patch_[t[2]]};
  }
  static bool has_area(const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }

  /// Separates patches that are joined by two edges, and those of two coinciding triangles. Returns whether
  /// there were any.
  bool separate_coinciding() {
    StableVector<Triangle> all;
    add_with_separated(all);
    for (const std::uint32_t n : across_) {
      const Triangle& triangle = contour_.triangles[n];
      if (!has_separated(triangle)) *all.add() = joined(triangle);
    }
    across_ = {};
    std::vector<Suspect> suspects;
    reserve_in_large_pages(suspects, count_ / 2);
    for (std::uint32_t p = 0; p < count_; ++p) {
      if (patch_[p] == p) suspects.push_back({p, is_joined_[p]});
    }
    return separate(suspects, all);
  }

  /// Does this once. After the first time, only points that were separated can be in coinciding patches, so
  /// they alone are suspect.
  bool separate_coinciding_once() {
    StableVector<Triangle> with_suspects;
    add_with_separated(with_suspects);
    std::vector<Suspect> suspects;
    for (std::uint32_t p = 0; p < count_; ++p) {
      if (is_separated_[p]) suspects.push_back({p, false});
    }
    return separate(suspects, with_suspects);
  }

  [[nodiscard]] bool has_separated(const Triangle& t) const {
    return is_separated_[t[0]] || is_separated_[t[1]] || is_separated_[t[2]];
  }
  /// Adds the triangles with an area at points that were separated last.
  void add_with_separated(StableVector<Triangle>& triangles) const {
    if (!any_separated_) return;
    for (const Triangle& triangle : contour_.triangles) {
      if (has_separated(triangle) && has_area(joined(triangle))) *triangles.add() = joined(triangle);
    }
  }

  bool separate(const std::vector<Suspect>& suspects, StableVector<Triangle>& triangles) {
    to_separate_ = coinciding_.find(count_, suspects, [&](const auto& visit) {
      for (std::size_t n = 0; n < triangles.size(); ++n) visit(triangles[n]);
    });
    const bool found = !to_separate_.empty();
    if (found) separate_patches();
    return found;
  }

  /// Replaces the points by the joined ones: first those that stay, in their order, then the means, in the
  /// order of the patches. The memory of the old contour is reused, since new memory takes as long to get as
  /// to fill.
  void replace() {
    const std::uint32_t singles = number_points();
    StableVector<JoinedPoint> means;
    for (std::uint32_t p = 0; p < count_; ++p) {
      if (numbers_[p] < singles) continue;
      const std::uint32_t mean = numbers_[p] - singles;
      if (mean == means.size()) means.add();
      means[mean].add(contour_.points[p], contour_.edge_points[p]);
    }
    replace_triangles(singles, means);
    for (std::uint32_t p = 0; p < count_; ++p) {
      if (numbers_[p] >= singles) continue;
      contour_.points[numbers_[p]] = contour_.points[p];
      contour_.edge_points[numbers_[p]] = contour_.edge_points[p];
    }
    contour_.points.resize(singles);
    contour_.edge_points.resize(singles);
    reserve_in_large_pages(contour_.vertex_points, means.size());
    for (std::size_t n = 0; n < means.size(); ++n) {
      contour_.points.push_back(means[n].position());
      contour_.vertex_points.push_back(means[n].vertex_point());
    }
  }

  /// Replaces the patch of each point by its final number. Returns the number of points that stay.
  std::uint32_t number_points() {
    std::uint32_t singles = 0;
    for (std::uint32_t p = 0; p < count_; ++p) singles += is_joined_[patch_[p]] ? 0 : 1;
    numbers_ = std::move(patch_);
    std::uint32_t next_single = 0, next_mean = singles;
    for (std::uint32_t p = 0; p < count_; ++p) {
      std::uint32_t& number = numbers_[p];
      if (number != p) {
        number = numbers_[number];
      } else {
        number = is_joined_[p] ? next_mean++ : next_single++;
      }
    }
    return singles;
  }

  /// Keeps the triangles that have an area, and adds all triangles to the means at their corners.
  void replace_triangles(std::uint32_t singles, StableVector<JoinedPoint>& means) {
    std::size_t kept = 0;
    for (const Triangle& triangle : contour_.triangles) {
      const Triangle t{numbers_[triangle[0]], numbers_[triangle[1]], numbers_[triangle[2]]};
      if (std::max({t[0], t[1], t[2]}) >= singles) {
        const Vec3 &a = contour_.points[triangle[0]], &b = contour_.points[triangle[1]],
                   &c = contour_.points[triangle[2]];
        const Vec3 area_vector = 0.5 * cross(b - a, c - a);
        const double area = norm(area_vector), moment = dot(area_vector, a);
        for (std::size_t n = 0; n < 3; ++n) {
          const bool is_first = n == 0 || (t[n] != t[0] && (n == 1 || t[n] != t[1]));
          if (is_first && t[n] >= singles) means[t[n] - singles].add_triangle(area_vector, area, moment);
        }
      }
      // There is no branch here, since it would be unpredictable.
      contour_.triangles[kept] = t;
      kept += has_area(t) ? 1 : 0;
    }
    contour_.triangles.resize(kept);
  }

  Contour& contour_;
  std::uint32_t count_;
  std::vector<LatticePoint> vertices_;
  std::vector<std::uint32_t> patch_;
  std::vector<std::uint32_t> numbers_;      ///< final numbers of points
  std::vector<bool> is_joined_;             ///< whether a patch has several points, indexed by its number
  std::vector<std::uint32_t> to_separate_;  ///< patches that are to be separated
  CoincidingPatches coinciding_;
  std::vector<bool> is_separated_;  ///< points of patches that were separated last
  bool any_separated_ = false;
  std::vector<std::uint32_t> across_;  ///< triangles whose corners are near three vertices
};

}  // namespace

void join_points(Contour& contour) {
  ADAMAS_ASSERT(contour.points.size() == contour.edge_points.size());
  if (!contour.triangles.empty()) PointJoiner(contour).run();
}

}  // namespace adamas::isosurface
