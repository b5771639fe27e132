#include "core/distance/hausdorff.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/assert.h"
#include "core/base/digest_numbers.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "core/distance/closest_point_tree.h"

namespace adamas::inline core {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The surface from which distances are bounded.
struct Target {
  const ClosestPointTree& tree;
  /// Tells whether a triangle of the tree serves a triangle that is bounded; null if each does.
  const ServesTriangle* serves = nullptr;

  [[nodiscard]] bool is_served(std::uint32_t triangle, std::uint32_t found) const {
    return serves == nullptr || found == ClosestPointTree::kNoTriangle || (*serves)(triangle, found);
  }
};

/// A part of a polygon whose distance from the surface is to be bounded by the plane of one triangle.
using CoverPart = std::vector<Vec3>;

constexpr int kMostParts = 24;

Vec3 middle(const CoverPart& part) {
  Vec3 sum;
  for (const Vec3& p : part) sum += p;
  return 1 / static_cast<double>(part.size()) * sum;
}

/// The greatest distance of a polygon from one triangle, which is at a corner since the distance is convex.
double greatest_distance(const CoverPart& part, const std::array<Vec3, 3>& triangle) {
  double greatest = 0;
  for (const Vec3& p : part) greatest = std::max(greatest, closest_on_triangle(p, triangle).squared_distance);
  return std::sqrt(greatest);
}

/// Clips a convex polygon to the part where dot(normal, p - origin) <= 0, and returns the rest.
CoverPart cut(CoverPart& part, const Vec3& origin, const Vec3& normal) {
  CoverPart kept, rest;
  for (std::size_t i = 0; i < part.size(); ++i) {
    const Vec3 &a = part[i], &b = part[(i + 1) % part.size()];
    const double x = dot(normal, a - origin), y = dot(normal, b - origin);
    if (x <= 0) kept.push_back(a);
    if (x >= 0) rest.push_back(a);
    if ((x < 0 && y > 0) || (x > 0 && y < 0)) {
      const Vec3 p = a + (x / (x - y)) * (b - a);
      kept.push_back(p);
      rest.push_back(p);
    }
  }
  part.swap(kept);
  return rest;
}

/// Clips the polygon to what lies above or below the triangle, and appends the rest, in convex parts, to
/// `parts`.
void cut_along_edges(CoverPart& part, const std::array<Vec3, 3>& triangle, std::vector<CoverPart>& parts) {
  const Vec3 normal = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& a = triangle[i];
    CoverPart rest = cut(part, a, cross(triangle[(i + 1) % 3] - a, normal));
    if (rest.size() >= 3) parts.push_back(std::move(rest));
  }
}

/// An upper bound of the distance of a convex plane polygon from the surface in the tree. The polygon is cut
/// along the edges of triangles close to it. The bound is the greatest distance of a part from one triangle
/// if all these are at most `enough`, and else infinity. So a polygon beside several triangles of one plane
/// is bounded by its distance from the plane. The number of parts is limited. `is_served`: whether the
/// triangles found serve; else there is no bound.
template <class IsServed>
double covered_distance(std::span<const Vec3> polygon, const ClosestPointTree& to, double enough,
                        IsServed&& is_served) {
  std::vector<CoverPart> parts{CoverPart(polygon.begin(), polygon.end())};
  double greatest = 0;
  for (int tried = 0; !parts.empty(); ++tried) {
    if (tried == kMostParts) return kInfinity;
    CoverPart part = std::move(parts.back());
    parts.pop_back();
    const auto closest = to.closest(middle(part));
    if (!closest || !is_served(closest->triangle)) return kInfinity;
    if (!(closest->squared_distance <= enough * enough)) return kInfinity;
    const std::array<Vec3, 3> triangle = to.triangle(closest->triangle);
    double distance = greatest_distance(part, triangle);
    if (distance > enough) {
      const std::size_t before = parts.size();
      cut_along_edges(part, triangle, parts);
      if (parts.size() == before) return kInfinity;
      distance = greatest_distance(part, triangle);
      if (distance > enough) return kInfinity;
    }
    greatest = std::max(greatest, distance);
  }
  return greatest;
}

/// Covers by several triangles are tried only where the greatest distance found is at most this part of the
/// accepted one.
constexpr double kMuchCloser = 0.01;
/// The number of triangles that tighten_distance_bound() examines first.
constexpr std::size_t kFirstTriangles = 1024;

/// The closest point of the target, as far as it is needed.
struct Closest {
  double distance = -1;  ///< negative: not known yet
  std::uint32_t triangle = ClosestPointTree::kNoTriangle;
};

/// `guess`: a triangle that may be close.
Closest find_closest(const ClosestPointTree& to, const Vec3& p,
                     std::uint32_t guess = ClosestPointTree::kNoTriangle) {
  const auto closest = to.closest_from(p, guess);
  return closest ? Closest{std::sqrt(closest->squared_distance), closest->triangle} : Closest{kInfinity};
}

struct Piece {
  std::array<Vec3, 3> corners;
  std::array<Closest, 3> closest;  ///< closest point of the target for each corner
  std::uint32_t triangle;
};

struct Measure {
  double upper = 0;  ///< infinite where a triangle found does not serve
  double lower = 0;
  Vec3 worst;
};

/// A triangle clipped to a box has at most nine corners.
struct Polygon {
  std::array<Vec3, 10> corners;
  std::array<Closest, 10> closest;  ///< closest point of the target for each corner
  std::size_t count = 0;
  [[nodiscard]] std::span<const Vec3> points() const { return {corners.data(), count}; }
  void add(const Vec3& p, const Closest& of_p) {
    ADAMAS_ASSERT(count < corners.size());
    corners[count] = p;
    closest[count++] = of_p;
  }
};

/// Clips a polygon to the side of `wall` where sign * (x - wall) <= 0.
Polygon clip(const Polygon& polygon, int axis, double wall, double sign) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Vec3 &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.count];
    const double x = sign * (a[axis] - wall), y = sign * (b[axis] - wall);
    if (x <= 0) kept.add(a, polygon.closest[i]);
    if ((x < 0 && y > 0) || (x > 0 && y < 0)) {
      Vec3 p = a + (x / (x - y)) * (b - a);
      p[axis] = wall;
      kept.add(p, {});
    }
  }
  return kept;
}

bool is_inside(const Piece& piece, const std::optional<Box3>& domain) {
  return !domain || std::all_of(piece.corners.begin(), piece.corners.end(),
                                [&](const Vec3& p) { return domain->contains(p); });
}

Polygon clipped(const Piece& piece, const ClosestPointTree& to, const std::optional<Box3>& domain) {
  Polygon polygon;
  for (std::size_t i = 0; i < 3; ++i) polygon.add(piece.corners[i], piece.closest[i]);
  if (is_inside(piece, domain)) return polygon;
  for (int axis = 0; axis < 3; ++axis) {
    polygon = clip(polygon, axis, domain->max[axis], 1);
    polygon = clip(polygon, axis, domain->min[axis], -1);
  }
  for (std::size_t i = 0; i < polygon.count; ++i) {
    if (polygon.closest[i].distance < 0) polygon.closest[i] = find_closest(to, polygon.corners[i]);
  }
  return polygon;
}

/// A radius about the corners of a triangle that covers it: that of its circumscribed circle or, where an
/// angle is obtuse, at most half the longest edge.
double covering_radius(const Vec3& a, const Vec3& b, const Vec3& c) {
  std::array<double, 3> squared{squared_norm(b - a), squared_norm(c - b), squared_norm(a - c)};
  std::sort(squared.begin(), squared.end());
  const double half_longest = 0.5 * std::sqrt(squared[2]);
  if (squared[0] + squared[1] <= squared[2]) return half_longest;
  const double circumscribed =
      std::sqrt(squared[0] * squared[1] * squared[2]) / (2 * norm(cross(b - a, c - a)));
  // If the greatest angle is acute, the radius is at most that of an equilateral triangle, but for round-off.
  return std::min(circumscribed, 2 / std::sqrt(3.0) * half_longest);
}

/// Computes the bound of the distance over one piece.
class PieceMeasure {
 public:
  PieceMeasure(const Polygon& polygon, std::uint32_t triangle, const Target& target)
      : polygon_(polygon), triangle_(triangle), target_(target) {
    double radius = 0;
    for (std::size_t i = 0; i < polygon.count; ++i) {
      consider(polygon.corners[i], polygon.closest[i]);
      if (i < 2) continue;
      const auto& p = polygon.corners;
      radius = std::max(radius, covering_radius(p[0], p[i - 1], p[i]));
    }
    result_.upper = std::min(result_.upper, result_.lower + radius);
  }

  /// Adds the closest point to the middle of the piece.
  void look_closer() {
    Vec3 center;
    for (std::size_t i = 0; i < polygon_.count; ++i) center += polygon_.corners[i];
    center = 1 / static_cast<double>(polygon_.count) * center;
    double spread = 0;
    for (std::size_t i = 0; i < polygon_.count; ++i)
      spread = std::max(spread, distance(polygon_.corners[i], center));
    const Closest closest = find_closest(target_.tree, center, polygon_.closest[0].triangle);
    result_.upper = std::min(result_.upper, closest.distance + spread);
    consider(center, closest);
  }

  /// Tries whether several triangles together are close enough, if all distances found are much below
  /// `enough`.
  void look_for_cover(double enough) {
    if (result_.lower > kMuchCloser * enough) return;
    const double covered = covered_distance(polygon_.points(), target_.tree, enough,
                                            [this](std::uint32_t found) { return is_served(found); });
    result_.upper = std::min(result_.upper, covered);
  }

  /// Whether all triangles found serve.
  [[nodiscard]] bool is_served() const { return served_; }
  /// The bounds; against round-off, the upper one is at least the greatest distance found.
  [[nodiscard]] Measure result() const {
    if (!served_) return {kInfinity, 0, {}};
    return {std::max(result_.upper, result_.lower), result_.lower, result_.worst};
  }

 private:
  /// Over the piece, the greatest distance to one triangle S is that at a corner; the distance to the whole
  /// target is at most that, for any S.
  void consider(const Vec3& p, const Closest& of_p) {
    if (!is_served(of_p.triangle)) return;
    if (of_p.distance > result_.lower) {
      result_.lower = of_p.distance;
      result_.worst = p;
    }
    const std::uint32_t candidate = of_p.triangle;
    const auto last = candidates_.begin() + static_cast<std::ptrdiff_t>(count_);
    if (candidate == ClosestPointTree::kNoTriangle || std::find(candidates_.begin(), last, candidate) != last)
      return;
    candidates_[count_++] = candidate;
    double greatest = 0;
    for (std::size_t i = 0; i < polygon_.count; ++i)
      greatest = std::max(greatest, corner_distance(i, candidate));
    result_.upper = std::min(result_.upper, greatest);
  }

  bool is_served(std::uint32_t found) {
    served_ = served_ && target_.is_served(triangle_, found);
    return served_;
  }

  [[nodiscard]] double corner_distance(std::size_t i, std::uint32_t candidate) const {
    const Closest& closest = polygon_.closest[i];
    if (closest.triangle == candidate) return closest.distance;
    return std::sqrt(
        closest_on_triangle(polygon_.corners[i], target_.tree.triangle(candidate)).squared_distance);
  }

  const Polygon& polygon_;
  std::uint32_t triangle_;
  const Target& target_;
  bool served_ = true;
  std::array<std::uint32_t, 11> candidates_{};
  std::size_t count_ = 0;
  Measure result_{kInfinity, -1, {}};
};

/// Bounds the distance over one piece. The piece does not matter if the bound is at most `accept`, or
/// `factor` times the greatest distance found.
Measure measure(const Piece& piece, const Target& to, const std::optional<Box3>& domain, double accept,
                double factor, double seen) {
  const Polygon polygon = clipped(piece, to.tree, domain);
  if (polygon.count == 0) return {};
  PieceMeasure result(polygon, piece.triangle, to);
  const Measure first = result.result();
  if (!result.is_served() || first.upper <= std::max(accept, factor * std::max(seen, first.lower)))
    return first;
  result.look_closer();
  const double enough = std::max(accept, factor * seen);
  if (result.result().upper > enough) result.look_for_cover(enough);
  return result.result();
}

/// Whether a piece is a line: a triangle whose second and third corner are equal.
bool is_line(const Piece& piece) { return piece.corners[1] == piece.corners[2]; }

std::size_t parts_of(const Piece& piece) { return is_line(piece) ? 2 : 4; }

/// The middles of a piece's edges. That of a line is the first one, and the others are its ends.
std::array<Vec3, 3> middles(const Piece& piece) {
  const auto& [a, b, c] = piece.corners;
  return {0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)};
}

/// The closest points of the middles of pieces' edges. Edges that pieces share are looked at once.
class MiddleDistances {
 public:
  /// `chosen`: those of the pieces that are divided.
  MiddleDistances(const std::vector<Piece>& pieces, const std::vector<std::size_t>& chosen,
                  const ClosestPointTree& to) {
    std::vector<Digest> digests(3 * chosen.size());
    const auto for_each_middle = [&](auto&& visit) {
      parallel_for(chosen.size(), 256, [&](std::size_t i) {
        const std::array<Vec3, 3> at = middles(pieces[chosen[i]]);
        for (std::size_t edge = 0; edge < 3; ++edge) visit(3 * i + edge, at[edge]);
      });
    };
    for_each_middle([&](std::size_t place, const Vec3& p) { digests[place].take(p); });
    DigestNumbers::Added added = DigestNumbers().add(digests);
    number_ = std::move(added.numbers);
    closest_.resize(added.firsts.size());
    parallel_for(added.firsts.size(), 64, [&](std::size_t n) {
      const std::uint32_t place = added.firsts[n];
      const Piece& piece = pieces[chosen[place / 3]];
      closest_[n] = find_closest(to, middles(piece)[place % 3], piece.closest[place % 3].triangle);
    });
  }

  /// Returns those of the piece at this place among the chosen ones.
  [[nodiscard]] std::array<Closest, 3> of(std::size_t i) const {
    return {closest_[number_[3 * i]], closest_[number_[3 * i + 1]], closest_[number_[3 * i + 2]]};
  }

 private:
  std::vector<std::uint32_t> number_;  ///< by chosen piece and edge
  std::vector<Closest> closest_;
};

/// Divides a line into two parts, or a triangle into four. `closest`: those of the middles of the edges.
void divide(const Piece& piece, const std::array<Closest, 3>& closest, Piece* parts) {
  const auto& [a, b, c] = piece.corners;
  const auto& [at_a, at_b, at_c] = piece.closest;
  const auto [ab, bc, ca] = middles(piece);
  const auto& [at_ab, at_bc, at_ca] = closest;
  if (is_line(piece)) {
    parts[0] = {{a, ab, ab}, {at_a, at_ab, at_ab}, piece.triangle};
    parts[1] = {{ab, b, b}, {at_ab, at_b, at_b}, piece.triangle};
    return;
  }
  parts[0] = {{a, ab, ca}, {at_a, at_ab, at_ca}, piece.triangle};
  parts[1] = {{ab, b, bc}, {at_ab, at_b, at_bc}, piece.triangle};
  parts[2] = {{ca, bc, c}, {at_ca, at_bc, at_c}, piece.triangle};
  parts[3] = {{ab, bc, ca}, {at_ab, at_bc, at_ca}, piece.triangle};
}

/// What a part of a divided triangle counts as progress.
constexpr double kPieceOfTriangle = 0.25;
/// Loops are divided into blocks of so many items between which progress is counted.
constexpr std::size_t kProgressBlock = std::size_t{1} << 14;

/// Divides pieces until their bounds are good enough, or `most` of them have been examined. The bound of a
/// triangle is infinite where a triangle found does not serve.
void bound_pieces(std::vector<Piece> pieces, const Target& to, const HausdorffOptions& options, double accept,
                  std::size_t most, const Progress& progress, DistanceBound& bound) {
  std::vector<Piece> next;
  std::vector<Measure> measures;
  std::vector<std::size_t> loose, places;
  double open = static_cast<double>(pieces.size());  // the triangles that are not bounded, parts as parts
  double part = 1;                                   // what a piece is of a triangle
  for (std::size_t measured = 0; !pieces.empty(); pieces.swap(next)) {
    progress.check();
    measures.assign(pieces.size(), {});
    const auto seen_of = [&](const Piece& piece) {
      return options.each ? bound.triangle_lower[piece.triangle] : bound.lower;
    };
    for (std::size_t first = 0; first < pieces.size(); first += kProgressBlock) {
      const std::size_t count = std::min(kProgressBlock, pieces.size() - first);
      parallel_for(count, 256, [&](std::size_t n) {
        const std::size_t i = first + n;
        const double seen = seen_of(pieces[i]);
        measures[i] = measure(pieces[i], to, options.domain, accept, 1 + options.relative, seen);
      });
      // A triangle counts as half when it is measured, and as the rest when its bound is good enough.
      if (part == 1) LoopProgress::count_items(0.5 * static_cast<double>(count));
    }
    measured += pieces.size();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const Measure& m = measures[i];
      if (m.lower > bound.lower) bound.lower = m.lower, bound.worst = m.worst;
      if (!options.each) continue;
      double& lower = bound.triangle_lower[pieces[i].triangle];
      lower = std::max(lower, m.lower);
    }
    loose.clear();
    const bool last = measured + 4 * pieces.size() > most;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const double upper = measures[i].upper;
      const double enough = std::max(accept, (1 + options.relative) * seen_of(pieces[i]));
      if (upper <= enough || last || upper == kInfinity) {
        double& of_triangle = bound.triangle_upper[pieces[i].triangle];
        of_triangle = std::max(of_triangle, upper);
      } else {
        loose.push_back(i);
      }
    }
    const double left = part * static_cast<double>(loose.size());
    LoopProgress::count_items(0.5 * (open - left));
    open = left, part *= kPieceOfTriangle;
    places.assign(1, 0);
    for (const std::size_t i : loose) places.push_back(places.back() + parts_of(pieces[i]));
    next.resize(places.back());
    const MiddleDistances middles(pieces, loose, to.tree);
    parallel_for(loose.size(), 64,
                 [&](std::size_t i) { divide(pieces[loose[i]], middles.of(i), next.data() + places[i]); });
  }
}

/// The closest points of the corners of some triangles of a list.
class CornerDistances {
 public:
  /// `places`: those of the triangles in the list.
  CornerDistances(const TriangleList& triangles, const std::vector<std::uint32_t>& places)
      : triangles_(triangles) {
    std::uint32_t last = 0;
    for_each_corner(places, [&](std::uint32_t p) { first_ = std::min(first_, p), last = std::max(last, p); });
    const std::size_t range = last - std::min(first_, last) + std::size_t{1};
    if (range / kWide > places.size()) {
      for_each_corner(places, [&](std::uint32_t p) { points_.push_back(p); });
      sort_unique(points_);
      closest_.resize(points_.size());
      return;
    }
    number_.assign(range, kUnused);
    for_each_corner(places, [&](std::uint32_t p) {
      std::uint32_t& number = number_[p - first_];
      if (number != kUnused) return;
      number = static_cast<std::uint32_t>(points_.size());
      points_.push_back(p);
    });
    closest_.resize(points_.size());
  }

  void measure(const ClosestPointTree& to, const Progress& progress) {
    for (std::size_t first = 0; first < points_.size(); first += kProgressBlock) {
      progress.check();
      const std::size_t count = std::min(kProgressBlock, points_.size() - first);
      parallel_chunks(count, 256, [&](std::size_t begin, std::size_t end) {
        // Points that follow each other are often close.
        std::uint32_t last = ClosestPointTree::kNoTriangle;
        for (std::size_t i = first + begin; i < first + end; ++i) {
          closest_[i] = find_closest(to, triangles_.point(points_[i]), last);
          last = closest_[i].triangle;
        }
      });
      LoopProgress::count_items(static_cast<double>(count));
    }
  }

  [[nodiscard]] const Closest& at(std::uint32_t point) const {
    if (!number_.empty()) return closest_[number_[point - first_]];
    return closest_[static_cast<std::size_t>(std::ranges::lower_bound(points_, point) - points_.begin())];
  }

 private:
  static constexpr std::uint32_t kUnused = 0xffffffffu;
  /// Points are numbered by a list of those from the lowest to the highest corner unless these are more than
  /// this many for a triangle, as where a part has few of all triangles.
  static constexpr std::size_t kWide = 64;

  template <class Visit>
  void for_each_corner(const std::vector<std::uint32_t>& places, Visit&& visit) const {
    for (const std::uint32_t place : places) {
      for (const std::uint32_t p : triangles_[place]) visit(p);
    }
  }

  const TriangleList& triangles_;
  std::uint32_t first_ = kUnused;      ///< the lowest corner
  std::vector<std::uint32_t> number_;  ///< by point from the lowest corner on; empty if points_ is sorted
  std::vector<std::uint32_t> points_;
  std::vector<Closest> closest_;
};

/// Bounds the distance of the triangles at these places of a list, a block at a time. The bounds are those of
/// the triangles at these places or, if some triangles do not serve, follow the order of the places.
void bound_triangles(const TriangleList& triangles, const std::vector<std::uint32_t>& places,
                     const Target& to, const HausdorffOptions& options, const Progress& progress,
                     DistanceBound& bound) {
  const double accept = options.accept > 0 ? options.accept : 1e-4 * to.tree.bounds().diagonal();
  constexpr std::size_t kBlock = std::size_t{1} << 15;
  const double share = static_cast<double>(options.most_pieces) / static_cast<double>(places.size());
  CornerDistances corners(triangles, places);
  corners.measure(to.tree, progress);
  for (std::size_t first = 0; first < places.size(); first += kBlock) {
    std::vector<Piece> pieces;
    const std::size_t last = std::min(places.size(), first + kBlock);
    pieces.reserve(last - first);
    for (std::size_t i = first; i < last; ++i) {
      const auto& v = triangles[places[i]];
      pieces.push_back({triangles.corners(places[i]),
                        {corners.at(v[0]), corners.at(v[1]), corners.at(v[2])},
                        to.serves == nullptr ? places[i] : static_cast<std::uint32_t>(i)});
    }
    const auto most = static_cast<std::size_t>(share * static_cast<double>(last - first));
    bound_pieces(std::move(pieces), to, options, accept, most, progress, bound);
  }
}

/// The middle of a box is tried for its group where the box's half diagonal is at most this part of the
/// accepted distance.
constexpr double kGroupSize = 0.5;

/// A part of a surface that has changed, and how far bounds depend on it.
struct Changes {
  const ClosestPointTree& surface;
  double reach;
};

/// Bounds the distance of groups of a tree's triangles: that of the middle of the box round a group and half
/// of the box's diagonal together are one bound for all of them, which serves if it is at most `accept`.
/// Groups out of reach of changes (null: none is) keep their bounds. Returns the places of the triangles for
/// which no group serves.
std::vector<std::uint32_t> bound_groups(const TriangleList& triangles, const ClosestPointTree& to,
                                        double accept, const Changes* changes, const Progress& progress,
                                        DistanceBound& bound) {
  const ClosestPointTree& tree = *triangles.tree();
  std::vector<std::uint32_t> left;
  std::vector<ClosestPointTree::Group> groups{tree.whole()}, parts;
  std::vector<char> is_done;
  const auto keeps_bounds = [&](const Vec3& center, double radius) {
    return changes != nullptr && !changes->surface.is_within(center, changes->reach + radius);
  };
  const auto serves = [&](const Vec3& center, double radius, const ClosestPointTree::Group& group) {
    if (!(radius <= kGroupSize * accept)) return false;
    const auto closest = to.closest(center, accept - radius);
    if (!closest) return false;
    const double upper = std::sqrt(closest->squared_distance) + radius;
    if (!(upper <= accept)) return false;
    tree.for_each_triangle(group, [&](std::uint32_t t) {
      const std::uint32_t place = triangles.place(t);
      bound.triangle_upper[place] = upper;
      if (!bound.triangle_lower.empty()) bound.triangle_lower[place] = 0;
    });
    return true;
  };
  while (!groups.empty()) {
    progress.check();
    is_done.assign(groups.size(), 0);
    parallel_for(groups.size(), 64, [&](std::size_t i) {
      const Vec3 center = groups[i].box.center();
      const double radius = 0.5 * groups[i].box.diagonal();
      if (keeps_bounds(center, radius) || serves(center, radius, groups[i])) is_done[i] = 1;
    });
    parts.clear();
    for (std::size_t i = 0; i < groups.size(); ++i) {
      if (is_done[i] != 0) continue;
      if (!ClosestPointTree::is_leaf(groups[i])) {
        tree.divide(groups[i], parts);
      } else {
        tree.for_each_triangle(groups[i], [&](std::uint32_t t) { left.push_back(triangles.place(t)); });
      }
    }
    groups.swap(parts);
  }
  std::sort(left.begin(), left.end());
  return left;
}

double greatest_of(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

}  // namespace

std::vector<std::uint32_t> begin_distance_bound(const TriangleList& triangles, const ClosestPointTree& to,
                                                const HausdorffOptions& options, DistanceBound& bound,
                                                const Progress& progress) {
  bound = {};
  const double first = to.empty() ? kInfinity : 0;
  bound.triangle_upper.assign(triangles.size(), first);
  if (options.each) bound.triangle_lower.assign(triangles.size(), first);
  std::vector<std::uint32_t> places;
  if (to.empty()) {
    bound.lower = triangles.size() == 0 ? 0 : kInfinity;
  } else if (triangles.tree() != nullptr && options.accept > 0) {
    places = bound_groups(triangles, to, options.accept, nullptr, progress, bound);
    // A triangle counts as one item, its corners as half of one.
    LoopProgress::count_items(1.5 * static_cast<double>(triangles.size() - places.size()));
  } else {
    places.resize(triangles.size());
    std::iota(places.begin(), places.end(), 0u);
  }
  return places;
}

std::vector<std::uint32_t> begin_distance_update(const TriangleList& triangles,
                                                 const ClosestPointTree& changes, const ClosestPointTree& to,
                                                 const HausdorffOptions& options, DistanceBound& bound,
                                                 const Progress& progress) {
  if (to.empty()) return begin_distance_bound(triangles, to, options, bound, progress);
  std::vector<std::uint32_t> list;
  if (!changes.empty()) {
    const Changes near{changes, (1 + options.relative) * options.accept};
    for (const std::uint32_t place : bound_groups(triangles, to, options.accept, &near, progress, bound))
      bound.triangle_upper[place] = kInfinity;
  }
  for (std::uint32_t place = 0; place < triangles.size(); ++place) {
    if (!(bound.triangle_upper[place] > options.accept)) continue;
    list.push_back(place);
    bound.triangle_upper[place] = bound.triangle_lower[place] = 0;
  }
  // The place of the greatest distance is found again if it is on a triangle that keeps its bounds.
  const auto farthest = std::max_element(bound.triangle_lower.begin(), bound.triangle_lower.end());
  if (farthest != bound.triangle_lower.end() && *farthest > 0) {
    list.push_back(static_cast<std::uint32_t>(farthest - bound.triangle_lower.begin()));
    bound.triangle_upper[list.back()] = bound.triangle_lower[list.back()] = 0;
  }
  bound.lower = 0;
  return list;
}

void finish_distance_bound(const TriangleList& triangles, const std::vector<std::uint32_t>& places,
                           const ClosestPointTree& to, const HausdorffOptions& options, DistanceBound& bound,
                           const Progress& progress) {
  if (!places.empty()) bound_triangles(triangles, places, {to}, options, progress, bound);
  bound.upper = greatest_of(bound.triangle_upper);
}

DistanceBound bound_served_triangles(const TriangleList& triangles, const std::vector<std::uint32_t>& places,
                                     const ClosestPointTree& to, const ServesTriangle& serves,
                                     const HausdorffOptions& options, const Progress& progress) {
  const ServesTriangle serves_place = [&](std::uint32_t i, std::uint32_t found) {
    return serves(places[i], found);
  };
  DistanceBound bound;
  bound.triangle_upper.assign(places.size(), 0.0);
  bound.triangle_lower.assign(places.size(), 0.0);
  bound_triangles(triangles, places, {to, &serves_place}, options, progress, bound);
  return bound;
}

DistanceBound directed_distance_bound(const TriangleList& triangles, const ClosestPointTree& to,
                                      const HausdorffOptions& options, const Progress& progress) {
  DistanceBound bound;
  const std::vector<std::uint32_t> places = begin_distance_bound(triangles, to, options, bound, progress);
  finish_distance_bound(triangles, places, to, options, bound, progress);
  return bound;
}

void tighten_distance_bound(const TriangleList& triangles, const ClosestPointTree& to,
                            const HausdorffOptions& options, DistanceBound& bound, const Progress& progress) {
  if (to.empty()) {
    bound.upper = greatest_of(bound.triangle_upper);
    bound.lower = triangles.size() == 0 ? 0 : kInfinity;
    return;
  }
  if (options.each) bound.triangle_lower.resize(triangles.size(), 0.0);
  const auto is_loose = [&](std::uint32_t t) {
    return bound.triangle_upper[t] > std::max(options.accept, (1 + options.relative) * bound.lower);
  };
  std::vector<std::uint32_t> loose;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (is_loose(t)) loose.push_back(t);
  }
  std::stable_sort(loose.begin(), loose.end(),
                   [&](auto a, auto b) { return bound.triangle_upper[a] > bound.triangle_upper[b]; });
  // The greatest distance is likely to be found on the first triangles; then others need no examination.
  std::vector<std::uint32_t> some;
  std::vector<double> before;
  for (std::size_t first = 0, count = kFirstTriangles; first < loose.size(); first += count, count *= 4) {
    some.clear();
    before.clear();
    for (std::size_t i = first; i < std::min(first + count, loose.size()); ++i) {
      if (!is_loose(loose[i])) continue;
      some.push_back(loose[i]);
      before.push_back(std::exchange(bound.triangle_upper[loose[i]], 0));
    }
    if (some.empty()) continue;
    HausdorffOptions for_some = options;
    for_some.most_pieces = options.most_pieces / loose.size() * some.size();
    bound_triangles(triangles, some, {to}, for_some, progress, bound);
    // Bounds from before hold too, and may be the tighter ones.
    for (std::size_t i = 0; i < some.size(); ++i) {
      double& upper = bound.triangle_upper[some[i]];
      upper = std::min(upper, before[i]);
    }
  }
  bound.upper = greatest_of(bound.triangle_upper);
}

}  // namespace adamas::inline core
