// This file computes the two-sided Hausdorff distance of two sets of triangles, as an independent check of
// the certified interface error. It uses nothing of core/distance, which certifies: nearest triangles and
// distances are CGAL's. CGAL's own bounded_error_Hausdorff_distance needs manifold meshes, which interfaces
// are not.

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "interfaces/reference_program/answers.h"

namespace adamas::interfaces::reference {

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using Triangles = std::vector<Triangle>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

/// The relative accuracy of distances, in relation to the size of the data. Narrower triangles are replaced
/// by their longest sides.
constexpr double kRoundOff = 1e-9;

/// Returns a polygon cut by the six planes of a box. Corners on a plane have exactly its coordinate.
std::vector<Vec3> cut_to_box(std::vector<Vec3> polygon, const Vec3& low, const Vec3& high) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const double level = sign > 0 ? low[axis] : high[axis];
      std::vector<Vec3> inside;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double at_a = sign * (a[axis] - level), at_b = sign * (b[axis] - level);
        if (at_a >= 0) inside.push_back(a);
        if ((at_a < 0) == (at_b < 0) || at_a == 0 || at_b == 0) continue;
        Vec3 crossing = a + at_a / (at_a - at_b) * (b - a);
        crossing[axis] = level;
        inside.push_back(crossing);
      }
      polygon = std::move(inside);
    }
  }
  return polygon;
}

Point to_point(const Vec3& p) { return {p.x, p.y, p.z}; }

/// Returns a triangle for trees. If it is narrower than `least`, it becomes its longest side, in the form in
/// which CGAL accepts triangles of two points: ascending along some axis, with the last point twice.
Triangle to_triangle(const std::array<Vec3, 3>& t, double least) {
  std::size_t longest = 0;
  const auto side = [&t](std::size_t i) { return t[(i + 1) % 3] - t[i]; };
  for (std::size_t i = 1; i < 3; ++i) {
    if (norm(side(i)) > norm(side(longest))) longest = i;
  }
  if (norm(cross(side(0), side(1))) > least * norm(side(longest)))
    return {to_point(t[0]), to_point(t[1]), to_point(t[2])};
  Vec3 a = t[longest], b = t[(longest + 1) % 3];
  const Vec3 along = b - a;
  if (std::max({along.x, along.y, along.z}) <= 0) std::swap(a, b);
  return {to_point(a), to_point(b), to_point(b)};
}

/// The nearest triangle to a point, and its distance.
struct Nearest {
  double distance = 0;
  const Triangle* triangle = nullptr;
};

/// One set of triangles, translated so that the middle of all data is the origin.
class Surface {
 public:
  Surface(const DistanceRequest::Triangles& set, const Vec3& middle, double least) : corners_(set.triangles) {
    points_.reserve(set.points.size());
    for (const Vec3& p : set.points) points_.push_back(p - middle);
    triangles_.reserve(corners_.size());
    for (const auto& [a, b, c] : corners_)
      triangles_.push_back(to_triangle({points_[a], points_[b], points_[c]}, least));
    tree_.rebuild(triangles_.begin(), triangles_.end());
    if (!triangles_.empty()) tree_.accelerate_distance_queries();
  }
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  [[nodiscard]] const std::vector<Vec3>& points() const { return points_; }
  /// Returns the indices of each triangle's points.
  [[nodiscard]] const std::vector<std::array<std::uint32_t, 3>>& corners() const { return corners_; }
  [[nodiscard]] bool empty() const { return triangles_.empty(); }
  [[nodiscard]] Nearest nearest(const Point& p) const {
    const auto [closest, triangle] = tree_.closest_point_and_primitive(p);
    return {std::sqrt(CGAL::squared_distance(p, closest)), &*triangle};
  }

 private:
  const std::vector<std::array<std::uint32_t, 3>>& corners_;
  std::vector<Vec3> points_;
  Triangles triangles_;
  Tree tree_;
};

/// A triangle that is a part of a surface: its corners, and the nearest triangle of the other surface to
/// each.
struct Piece {
  std::array<Point, 3> corners;
  std::array<Nearest, 3> nearest;
};

/// The bounds of a distance, which are tightened step by step.
class Bracket {
 public:
  explicit Bracket(double bound) : bound_(bound) {}

  /// Includes the greatest distance, from `to`, of a point of `from` in a box.
  void add(const Surface& from, const Surface& to, const Vec3& low, const Vec3& high);
  [[nodiscard]] double lower() const { return lower_; }
  [[nodiscard]] double upper() const { return upper_; }

 private:
  void add(Piece piece, const Surface& to);
  [[nodiscard]] Nearest see(const Point& p, const Surface& to) {
    const Nearest result = to.nearest(p);
    lower_ = std::max(lower_, result.distance);
    return result;
  }

  double bound_, lower_ = 0, upper_ = 0;
};

/// Returns an upper bound of the distance of a piece's points: the distance to one triangle is a convex
/// function, which is greatest at a corner.
double upper_bound(const Piece& piece) {
  const auto project = Kernel().construct_projected_point_3_object();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < 3; ++n) {
    const Triangle* triangle = piece.nearest[n].triangle;
    if (n > 0 && triangle == piece.nearest[n - 1].triangle) continue;
    double greatest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const Point& p = piece.corners[c];
      const bool known = triangle == piece.nearest[c].triangle;
      greatest = std::max(greatest, known ? piece.nearest[c].distance
                                          : std::sqrt(CGAL::squared_distance(p, project(*triangle, p))));
    }
    least = std::min(least, greatest);
  }
  return least;
}

/// Divides the piece at its longest side until all parts are bounded. This ends, since the bound of a piece
/// is at most its diameter above the distance of its corners.
void Bracket::add(Piece piece, const Surface& to) {
  std::vector<Piece> pieces{piece};
  while (!pieces.empty()) {
    piece = pieces.back();
    pieces.pop_back();
    const double bound = upper_bound(piece);
    if (bound <= lower_ + bound_) {
      upper_ = std::max(upper_, bound);
      continue;
    }
    std::size_t longest = 0;
    double length = -1;
    for (std::size_t i = 0; i < 3; ++i) {
      const double of_side = CGAL::squared_distance(piece.corners[i], piece.corners[(i + 1) % 3]);
      if (of_side > length) longest = i, length = of_side;
    }
    const std::size_t other = (longest + 1) % 3;
    Piece half = piece;
    half.corners[longest] = CGAL::midpoint(piece.corners[longest], piece.corners[other]);
    half.nearest[longest] = see(half.corners[longest], to);
    piece.corners[other] = half.corners[longest];
    piece.nearest[other] = half.nearest[longest];
    pieces.push_back(piece);
    pieces.push_back(half);
  }
}

void Bracket::add(const Surface& from, const Surface& to, const Vec3& low, const Vec3& high) {
  // All corners come first: the better the lower bound, the fewer pieces have to be divided.
  std::vector<Piece> pieces;
  std::vector<Nearest> known(from.points().size());
  for (const auto& t : from.corners()) {
    std::vector<Vec3> polygon;
    for (const std::uint32_t i : t) polygon.push_back(from.points()[i]);
    const bool inside = std::all_of(polygon.begin(), polygon.end(), [&](const Vec3& p) {
      return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z;
    });
    if (!inside) polygon = cut_to_box(polygon, low, high);
    if (!polygon.empty() && to.empty()) {
      lower_ = upper_ = std::numeric_limits<double>::infinity();
      return;
    }
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      Piece piece{{to_point(polygon[0]), to_point(polygon[i - 1]), to_point(polygon[i])}, {}};
      for (std::size_t c = 0; c < 3; ++c) {
        if (!inside) {
          piece.nearest[c] = see(piece.corners[c], to);
          continue;
        }
        Nearest& of_point = known[t[c]];
        if (of_point.triangle == nullptr) of_point = see(piece.corners[c], to);
        piece.nearest[c] = of_point;
      }
      pieces.push_back(piece);
    }
  }
  for (const Piece& piece : pieces) add(piece, to);
}

}  // namespace

DistanceReply bracket_distance(const DistanceRequest& request) {
  Vec3 least = request.box_min, greatest = request.box_max;
  for (const DistanceRequest::Triangles& set : request.sets) {
    for (const Vec3& p : set.points) {
      for (int axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(p[axis])) return {"expected points that are finite, found others", 0, 0};
        least[axis] = std::min(least[axis], p[axis]), greatest[axis] = std::max(greatest[axis], p[axis]);
      }
    }
  }
  const Vec3 middle = 0.5 * (least + greatest);
  const double round_off = kRoundOff * norm(greatest - least);
  const Surface first(request.sets[0], middle, round_off), second(request.sets[1], middle, round_off);
  const Vec3 low = request.box_min - middle, high = request.box_max - middle;
  Bracket bracket(std::max(request.bound, round_off));
  bracket.add(first, second, low, high);
  bracket.add(second, first, low, high);
  return {"", std::max(0.0, bracket.lower() - 2 * round_off), bracket.upper() + 2 * round_off};
}

}  // namespace adamas::interfaces::reference
