// This file computes the two-sided Hausdorff distance of two sets of triangles, as an independent check of
// the certified interface error. It uses nothing of core/distance, which certifies: the distance is that of
// CGAL's bounded_error_Hausdorff_distance. That takes surface meshes, which interfaces are not where three
// materials meet; so each triangle gets vertices of its own, which changes no distance.

#include <CGAL/Kernel/global_functions_3.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "interfaces/reference_program/answers.h"

namespace adamas::interfaces::reference {

namespace {

using Point = CGAL::Simple_cartesian<double>::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

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

/// Appends a triangle with vertices of its own to a mesh. If it is narrower than `least`, it becomes its
/// longest side, in the form in which CGAL accepts triangles of two points: ascending along some axis, with
/// the last point twice.
void append(Mesh& mesh, std::array<Vec3, 3> t, double least) {
  const auto side = [&t](std::size_t i) { return t[(i + 1) % 3] - t[i]; };
  std::size_t longest = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (norm(side(i)) > norm(side(longest))) longest = i;
  }
  if (norm(cross(side(0), side(1))) <= least * norm(side(longest))) {
    const Vec3 a = t[longest], b = t[(longest + 1) % 3], along = b - a;
    const bool ascends = std::max({along.x, along.y, along.z}) > 0;
    t = {ascends ? a : b, ascends ? b : a, ascends ? b : a};
  }
  const auto vertex = [&mesh](const Vec3& p) { return mesh.add_vertex({p.x, p.y, p.z}); };
  const auto first = vertex(t[0]), second = vertex(t[1]), third = vertex(t[2]);
  mesh.add_face(first, second, third);
}

/// One set of triangles, translated so that the middle of all data is the origin.
struct Surface {
  Mesh whole;
  Mesh part;  ///< what lies in the box
};

Surface make_surface(const DistanceRequest::Triangles& set, const Vec3& middle, double least, const Vec3& low,
                     const Vec3& high) {
  Surface result;
  for (const auto& [a, b, c] : set.triangles) {
    const std::array<Vec3, 3> t{set.points[a] - middle, set.points[b] - middle, set.points[c] - middle};
    append(result.whole, t, least);
    const std::vector<Vec3> polygon = cut_to_box({t.begin(), t.end()}, low, high);
    for (std::size_t i = 2; i < polygon.size(); ++i)
      append(result.part, {polygon[0], polygon[i - 1], polygon[i]}, least);
  }
  return result;
}

/// Returns the greatest distance from `to` of a point of the part of `from`, with this greatest error.
double directed_distance(const Surface& from, const Surface& to, double error) {
  if (from.part.is_empty()) return 0;
  if (to.whole.is_empty()) return std::numeric_limits<double>::infinity();
  namespace processing = CGAL::Polygon_mesh_processing;
  const auto options = CGAL::parameters::match_faces(false);
  return processing::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(from.part, to.whole, error,
                                                                            options, options);
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
  const auto surface = [&](const DistanceRequest::Triangles& set) {
    return make_surface(set, middle, round_off, request.box_min - middle, request.box_max - middle);
  };
  const Surface first = surface(request.sets[0]), second = surface(request.sets[1]);
  if (first.part.is_empty() && second.part.is_empty()) return {"", 0, 0};
  const double error = std::max(0.5 * request.bound, round_off);
  const double distance =
      std::max(directed_distance(first, second, error), directed_distance(second, first, error));
  return {"", std::max(0.0, distance - error - 2 * round_off), distance + error + 2 * round_off};
}

}  // namespace adamas::interfaces::reference
