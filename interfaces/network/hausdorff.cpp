#include "interfaces/network/hausdorff.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/assert.h"
#include "core/base/parallel.h"

namespace adamas {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Marks points whose closest point is to be found; no triangle has this number.
constexpr std::uint32_t kWanted = ClosestPointTree::kNoTriangle - 1;

/// The closest point of the target, as far as needed.
struct Closest {
  double distance = -1;  ///< negative: not known yet
  std::uint32_t triangle = ClosestPointTree::kNoTriangle;
};

Closest find_closest(const ClosestPointTree& to, const Vec3& p) {
  const auto closest = to.closest(p);
  return closest ? Closest{std::sqrt(closest->squared_distance), closest->triangle} : Closest{kInfinity};
}

struct Piece {
  std::array<Vec3, 3> corners;
  std::array<Closest, 3> closest;  ///< to the corners
  std::uint32_t triangle;
};

struct Measure {
  double upper = 0;
  double lower = 0;
  Vec3 worst;
};

/// A triangle clipped to a box has at most nine corners.
struct Polygon {
  std::array<Vec3, 10> corners;
  std::size_t count = 0;
  void add(const Vec3& p) {
    ADAMAS_ASSERT(count < corners.size());
    corners[count++] = p;
  }
};

/// Keeps what lies on the side of `wall` where sign * (x - wall) <= 0.
Polygon clip(const Polygon& polygon, int axis, double wall, double sign) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Vec3 &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.count];
    const double x = sign * (a[axis] - wall), y = sign * (b[axis] - wall);
    if (x <= 0) kept.add(a);
    if ((x < 0 && y > 0) || (x > 0 && y < 0)) {
      Vec3 p = a + (x / (x - y)) * (b - a);
      p[axis] = wall;
      kept.add(p);
    }
  }
  return kept;
}

bool is_inside(const Piece& piece, const std::optional<Box3>& domain) {
  return !domain || std::all_of(piece.corners.begin(), piece.corners.end(),
                                [&](const Vec3& p) { return domain->contains(p); });
}

Polygon clipped(const Piece& piece, const std::optional<Box3>& domain) {
  Polygon polygon;
  for (const Vec3& p : piece.corners) polygon.add(p);
  if (is_inside(piece, domain)) return polygon;
  for (int axis = 0; axis < 3; ++axis) {
    polygon = clip(polygon, axis, domain->max[axis], 1);
    polygon = clip(polygon, axis, domain->min[axis], -1);
  }
  return polygon;
}

/// Bounds of the distance over one piece. Its greatest distance to a triangle S is at a corner; to all of the
/// target it is at most that for any S.
Measure measure(const Piece& piece, const ClosestPointTree& to, const std::optional<Box3>& domain) {
  const Polygon polygon = clipped(piece, domain);
  Measure result;
  if (polygon.count == 0) return result;
  Vec3 center;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    center += (1 / static_cast<double>(polygon.count)) * polygon.corners[i];
  }
  std::array<std::uint32_t, 11> candidates;
  std::size_t count = 0;
  double at_center = 0, spread = 0, farthest = 0;
  const bool whole = is_inside(piece, domain);
  for (std::size_t i = 0; i <= polygon.count; ++i) {
    const Vec3& p = i < polygon.count ? polygon.corners[i] : center;
    const bool known = whole && i < 3 && piece.closest[i].distance >= 0;
    const Closest closest = known ? piece.closest[i] : find_closest(to, p);
    const double d = closest.distance;
    if (i == 0 || d > result.lower) {
      result.lower = d;
      result.worst = p;
    }
    if (i == polygon.count) at_center = d;
    farthest = std::max(farthest, d);
    spread = std::max(spread, distance(p, center));
    const auto last = candidates.begin() + count;
    if (closest.triangle != ClosestPointTree::kNoTriangle &&
        std::find(candidates.begin(), last, closest.triangle) == last) {
      candidates[count++] = closest.triangle;
    }
  }
  result.upper = at_center + spread;
  for (std::size_t k = 0; k < count; ++k) {
    const std::array<Vec3, 3>& s = to.triangle(candidates[k]);
    double greatest = 0;
    for (std::size_t i = 0; i < polygon.count; ++i) {
      greatest = std::max(greatest, closest_on_triangle(polygon.corners[i], s).squared_distance);
    }
    result.upper = std::min(result.upper, std::sqrt(greatest));
  }
  // Against round-off: the bound is at least what was seen.
  result.upper = std::max(result.upper, result.lower);
  return result;
}

void divide(const Piece& piece, std::vector<Piece>& out) {
  const auto& c = piece.corners;
  const auto& known = piece.closest;
  const Vec3 ab = 0.5 * (c[0] + c[1]), bc = 0.5 * (c[1] + c[2]), ca = 0.5 * (c[2] + c[0]);
  out.push_back({{c[0], ab, ca}, {known[0], {}, {}}, piece.triangle});
  out.push_back({{ab, c[1], bc}, {Closest{}, known[1], {}}, piece.triangle});
  out.push_back({{ca, bc, c[2]}, {Closest{}, {}, known[2]}, piece.triangle});
  out.push_back({{ab, bc, ca}, {}, piece.triangle});
}

/// Divides pieces until their bounds are good enough, or `most` of them have been looked at.
/// `triangle_lower`: what has been seen of each triangle; empty where that does not matter.
void bound_pieces(std::vector<Piece> pieces, const ClosestPointTree& to, const HausdorffOptions& options,
                  double accept, std::size_t most, const Progress& progress,
                  std::vector<double>& triangle_lower, DistanceBound& bound) {
  std::vector<Piece> next;
  std::vector<Measure> measures;
  for (std::size_t measured = 0; !pieces.empty(); pieces.swap(next)) {
    progress.check();
    measures.assign(pieces.size(), {});
    parallel_for(pieces.size(), 256,
                 [&](std::size_t i) { measures[i] = measure(pieces[i], to, options.domain); });
    measured += pieces.size();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const Measure& m = measures[i];
      if (m.lower > bound.lower) bound.lower = m.lower, bound.worst = m.worst;
      if (!options.each) continue;
      double& lower = triangle_lower[pieces[i].triangle];
      lower = std::max(lower, m.lower);
    }
    next.clear();
    const bool last = measured + 4 * pieces.size() > most;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const double lower = options.each ? triangle_lower[pieces[i].triangle] : bound.lower;
      const double upper = measures[i].upper, enough = std::max(accept, (1 + options.relative) * lower);
      if (upper <= enough || last) {
        double& of_triangle = bound.triangle_upper[pieces[i].triangle];
        of_triangle = std::max(of_triangle, upper);
      } else {
        divide(pieces[i], next);
      }
    }
  }
}

/// The triangles of the list, a block at a time.
void bound_triangles(std::span<const Vec3> points, std::span<const ClosestPointTree::Triangle> triangles,
                     const std::vector<std::uint32_t>& list, const ClosestPointTree& to,
                     const HausdorffOptions& options, const Progress& progress, DistanceBound& bound) {
  const double accept = options.accept > 0 ? options.accept : 1e-4 * to.bounds().diagonal();
  constexpr std::size_t kBlock = std::size_t{1} << 17;
  const double share = static_cast<double>(options.most_pieces) / static_cast<double>(list.size());
  std::vector<double> triangle_lower(options.each ? triangles.size() : 0, 0.0);
  std::vector<Closest> of_points(points.size());
  std::vector<std::uint32_t> unknown;
  for (const std::uint32_t t : list) {
    for (const std::uint32_t p : triangles[t]) {
      if (of_points[p].triangle == kWanted) continue;
      of_points[p].triangle = kWanted;
      unknown.push_back(p);
    }
  }
  for (std::size_t first = 0; first < unknown.size(); first += kBlock) {
    progress.check();
    parallel_for(std::min(kBlock, unknown.size() - first), 256, [&](std::size_t i) {
      of_points[unknown[first + i]] = find_closest(to, points[unknown[first + i]]);
    });
  }
  for (std::size_t first = 0; first < list.size(); first += kBlock) {
    std::vector<Piece> pieces;
    const std::size_t last = std::min(list.size(), first + kBlock);
    for (std::size_t i = first; i < last; ++i) {
      const auto& v = triangles[list[i]];
      pieces.push_back({{points[v[0]], points[v[1]], points[v[2]]},
                        {of_points[v[0]], of_points[v[1]], of_points[v[2]]},
                        list[i]});
    }
    const auto most = static_cast<std::size_t>(share * static_cast<double>(last - first));
    bound_pieces(std::move(pieces), to, options, accept, most, progress, triangle_lower, bound);
  }
  bound.upper = 0;
  for (const double upper : bound.triangle_upper) bound.upper = std::max(bound.upper, upper);
}

}  // namespace

DistanceBound directed_distance_bound(std::span<const Vec3> points,
                                      std::span<const ClosestPointTree::Triangle> triangles,
                                      const ClosestPointTree& to, const HausdorffOptions& options,
                                      const Progress& progress) {
  DistanceBound bound;
  bound.triangle_upper.assign(triangles.size(), 0.0);
  if (to.empty()) {
    std::fill(bound.triangle_upper.begin(), bound.triangle_upper.end(), kInfinity);
    bound.upper = bound.lower = triangles.empty() ? 0 : kInfinity;
    return bound;
  }
  std::vector<std::uint32_t> all(triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  bound_triangles(points, triangles, all, to, options, progress, bound);
  return bound;
}

void tighten_distance_bound(std::span<const Vec3> points,
                            std::span<const ClosestPointTree::Triangle> triangles, const ClosestPointTree& to,
                            const HausdorffOptions& options, DistanceBound& bound, const Progress& progress) {
  const double enough = std::max(options.accept, (1 + options.relative) * bound.lower);
  std::vector<std::uint32_t> loose;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (bound.triangle_upper[t] <= enough || to.empty()) continue;
    loose.push_back(t);
    bound.triangle_upper[t] = 0;
  }
  if (!loose.empty()) bound_triangles(points, triangles, loose, to, options, progress, bound);
}

}  // namespace adamas
