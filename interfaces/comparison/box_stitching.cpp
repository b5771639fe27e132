#include "interfaces/comparison/box_stitching.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/error.h"
#include "core/base/sort_unique.h"
#include "interfaces/network/edge_fans.h"
#include "interfaces/reference_client/program_messages.h"

namespace adamas::interfaces {

namespace {

/// The points, segments and triangles of the six sides of a box, each of which is triangulated.
class BoxSides {
 public:
  /// Adds the next side: the points that lie on it, including the box's corners, and the segments between
  /// them that have to be edges.
  void add(const std::vector<Vec3>& points, const std::vector<std::uint32_t>& on_side,
           const std::vector<std::pair<std::uint32_t, std::uint32_t>>& segments);
  /// Returns the triangles of the sides, whose corners are numbers of the given points, counterclockwise as
  /// seen from outside the box. They are made by adamas-reference, since the library for this is under the
  /// GPL. Throws Error if two segments cross or a point lies on one, ProgramFailure if the program fails.
  [[nodiscard]] std::vector<std::vector<std::array<std::uint32_t, 3>>> triangulate(
      const std::filesystem::path& program, const Progress& progress) const;

 private:
  [[nodiscard]] bool fits(const PlanarReply& reply) const;

  PlanarRequest request_;
  std::vector<std::uint32_t> numbers_;  ///< the numbers of the request's points among the given ones
};

void BoxSides::add(const std::vector<Vec3>& points, const std::vector<std::uint32_t>& on_side,
                   const std::vector<std::pair<std::uint32_t, std::uint32_t>>& segments) {
  const int side = static_cast<int>(request_.point_ends.size()), axis = side / 2;
  // With this choice of u and v, triangles that are counterclockwise in their plane are so as seen from
  // outside.
  const int u = (axis + (side % 2 == 1 ? 1 : 2)) % 3, v = (axis + (side % 2 == 1 ? 2 : 1)) % 3;
  std::unordered_map<std::uint32_t, std::uint32_t> position;
  for (const std::uint32_t i : on_side) {
    position.emplace(i, static_cast<std::uint32_t>(numbers_.size()));
    numbers_.push_back(i);
    request_.points.push_back({points[i][u], points[i][v]});
  }
  for (const auto& [a, b] : segments) request_.segments.push_back({position.at(a), position.at(b)});
  request_.point_ends.push_back(static_cast<std::uint32_t>(request_.points.size()));
  request_.segment_ends.push_back(static_cast<std::uint32_t>(request_.segments.size()));
}

bool BoxSides::fits(const PlanarReply& reply) const {
  const auto& ends = reply.triangle_ends;
  return ends.size() == request_.point_ends.size() && std::is_sorted(ends.begin(), ends.end()) &&
         ends.back() == reply.triangles.size() &&
         std::all_of(reply.triangles.begin(), reply.triangles.end(), [this](const auto& t) {
           return std::max({t[0], t[1], t[2]}) < numbers_.size();
         });
}

std::vector<std::vector<std::array<std::uint32_t, 3>>> BoxSides::triangulate(
    const std::filesystem::path& program, const Progress& progress) const {
  const auto answer = ask_program<PlanarReply>(program, request_, ChildLimits::none(), progress);
  if (!answer.reply) throw ProgramFailure(answer.failure);
  const PlanarReply& reply = *answer.reply;
  if (!reply.failure.empty()) throw Error(reply.failure);
  if (!fits(reply)) throw ProgramFailure("made triangles of points that are not there");
  std::vector<std::vector<std::array<std::uint32_t, 3>>> sides;
  std::size_t t = 0;
  for (const std::uint32_t end : reply.triangle_ends) {
    sides.emplace_back();
    for (; t < end; ++t) {
      const auto& [a, b, c] = reply.triangles[t];
      sides.back().push_back({numbers_[a], numbers_[b], numbers_[c]});
    }
  }
  return sides;
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;
using Patch = PiecewiseLinearComplex::Patch;

Edge edge_of(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

class Stitcher {
 public:
  Stitcher(const Box3& box, double tolerance) : box_(box), tolerance_(tolerance) {}

  void add_interfaces(std::span<const Vec3> points, std::span<const BodyTriangle> triangles);
  void add_sides(const std::filesystem::path& program, const Progress& progress);
  void name_bodies(const std::function<BodyId(const Vec3&)>& body_at);
  [[nodiscard]] PiecewiseLinearComplex finish(const std::string& source) const;

 private:
  struct SideTriangle {
    std::array<std::uint32_t, 3> points;
    int side;
    BodyId body;
  };

  [[nodiscard]] double level(int side) const {
    return side % 2 == 0 ? box_.min[side / 2] : box_.max[side / 2];
  }
  [[nodiscard]] bool on_side(std::uint32_t point, int side) const {
    return points_[point][side / 2] == level(side);
  }
  [[nodiscard]] Vec3 onto_box(Vec3 p) const;
  [[nodiscard]] bool within_a_side(const std::array<std::uint32_t, 3>& t) const;
  [[nodiscard]] std::vector<std::uint32_t> connected_sides() const;
  [[nodiscard]] BodyId body_beside(const SideTriangle& t, const Edge& edge) const;

  Box3 box_;
  double tolerance_;
  std::vector<Vec3> points_;
  std::vector<BodyTriangle> triangles_;
  /// the edges of interfaces on sides, with their triangles
  std::map<Edge, std::vector<std::uint32_t>> ends_;
  std::vector<SideTriangle> side_triangles_;
};

Vec3 Stitcher::onto_box(Vec3 p) const {
  for (int side = 0; side < 6; ++side) {
    if (std::abs(p[side / 2] - level(side)) <= tolerance_) p[side / 2] = level(side);
  }
  return p;
}

bool Stitcher::within_a_side(const std::array<std::uint32_t, 3>& t) const {
  for (int side = 0; side < 6; ++side) {
    if (on_side(t[0], side) && on_side(t[1], side) && on_side(t[2], side)) return true;
  }
  return false;
}

void Stitcher::add_interfaces(std::span<const Vec3> points, std::span<const BodyTriangle> triangles) {
  points_.reserve(points.size() + 8);
  for (const Vec3& p : points) points_.push_back(onto_box(p));
  for (const Vec3& corner : box_.corners()) points_.push_back(corner);
  const std::vector<std::uint32_t> welded = weld_points(points_);
  for (BodyTriangle t : triangles) {
    for (std::uint32_t& p : t.points) {
      p = welded[p];
      const Vec3& x = points_[p];
      if (!box_.contains(x))
        fail("expected interfaces within the box, found a point at ({:.6g}, {:.6g}, {:.6g})", x.x, x.y, x.z);
    }
    const auto& p = t.points;
    if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0] || within_a_side(p)) continue;
    triangles_.push_back(t);
  }
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const auto& p = triangles_[t].points;
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge edge = edge_of(p[i], p[(i + 1) % 3]);
      for (int side = 0; side < 6; ++side) {
        if (!on_side(edge.first, side) || !on_side(edge.second, side)) continue;
        ends_[edge].push_back(t);
        break;
      }
    }
  }
}

void Stitcher::add_sides(const std::filesystem::path& program, const Progress& progress) {
  std::vector<std::uint32_t> used;
  for (const BodyTriangle& t : triangles_) used.insert(used.end(), t.points.begin(), t.points.end());
  const std::vector<std::uint32_t> welded = weld_points(points_);
  for (std::size_t corner = points_.size() - 8; corner < points_.size(); ++corner)
    used.push_back(welded[corner]);
  sort_unique(used);
  BoxSides sides;
  for (int side = 0; side < 6; ++side) {
    std::vector<std::uint32_t> here;
    std::copy_if(used.begin(), used.end(), std::back_inserter(here),
                 [&](std::uint32_t p) { return on_side(p, side); });
    std::vector<Edge> segments;
    for (const auto& [edge, triangles] : ends_) {
      if (on_side(edge.first, side) && on_side(edge.second, side)) segments.push_back(edge);
    }
    sides.add(points_, here, segments);
  }
  int side = 0;
  for (const auto& triangles : sides.triangulate(program, progress)) {
    for (const auto& t : triangles) side_triangles_.push_back({t, side, BodyId()});
    ++side;
  }
}

/// Returns the body of a side's triangle, given by the interface that ends at its edge; if there are several,
/// by the one next to the triangle round the edge.
BodyId Stitcher::body_beside(const SideTriangle& t, const Edge& edge) const {
  const Vec3 a = points_[edge.first], along = normalized(points_[edge.second] - a);
  const auto direction = [&](const std::array<std::uint32_t, 3>& corners) {
    Vec3 middle;
    for (const std::uint32_t p : corners) {
      if (p != edge.first && p != edge.second) middle = points_[p] - a;
    }
    return normalized(middle - dot(middle, along) * along);
  };
  const Vec3 in_side = direction(t.points);
  BodyId result;
  double nearest = -2;
  for (const std::uint32_t i : ends_.at(edge)) {
    const auto& p = triangles_[i].points;
    const Vec3 up = direction(p);
    const double cosine = dot(up, in_side);
    if (!(cosine > nearest)) continue;
    nearest = cosine;
    const Vec3 normal = cross(points_[p[1]] - points_[p[0]], points_[p[2]] - points_[p[0]]);
    result = dot(normal, in_side) > 0 ? triangles_[i].front : triangles_[i].back;
  }
  return result;
}

/// Returns for each triangle of the box's sides the lowest triangle of its part. Parts are connected, and
/// interfaces separate them.
std::vector<std::uint32_t> Stitcher::connected_sides() const {
  DisjointSets parts(side_triangles_.size());
  std::map<Edge, std::uint32_t> first;
  for (std::uint32_t t = 0; t < side_triangles_.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge edge = edge_of(side_triangles_[t].points[i], side_triangles_[t].points[(i + 1) % 3]);
      if (ends_.contains(edge)) continue;
      const auto [entry, fresh] = first.try_emplace(edge, t);
      if (!fresh) parts.join(t, entry->second);
    }
  }
  return std::move(parts).roots();
}

void Stitcher::name_bodies(const std::function<BodyId(const Vec3&)>& body_at) {
  const std::vector<std::uint32_t> part = connected_sides();
  // For each part and body, this is the length of the edges with this body, since slivers may give a wrong
  // one.
  std::map<std::pair<std::uint32_t, BodyId>, double> votes;
  for (std::uint32_t t = 0; t < side_triangles_.size(); ++t) {
    const auto& p = side_triangles_[t].points;
    const double area = norm(cross(points_[p[1]] - points_[p[0]], points_[p[2]] - points_[p[0]]));
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge edge = edge_of(p[i], p[(i + 1) % 3]);
      if (!ends_.contains(edge)) continue;
      votes[{part[t], body_beside(side_triangles_[t], edge)}] += area;
    }
  }
  std::map<std::uint32_t, std::pair<double, BodyId>> greatest;
  for (const auto& [key, weight] : votes) {
    auto& found = greatest[key.first];
    if (!found.second.valid() || weight > found.first) found = {weight, key.second};
  }
  for (std::uint32_t t = 0; t < side_triangles_.size(); ++t) {
    const auto found = greatest.find(part[t]);
    if (found == greatest.end()) greatest[part[t]] = {0, body_at(points_[side_triangles_[t].points[0]])};
    side_triangles_[t].body = greatest[part[t]].second;
  }
}

PiecewiseLinearComplex Stitcher::finish(const std::string& source) const {
  PiecewiseLinearComplex result;
  result.source = source;
  result.box = box_;
  std::map<Patch, std::uint32_t> numbers;
  std::vector<std::uint32_t> number(points_.size(), 0xffffffffu);
  const auto add = [&](std::array<std::uint32_t, 3> corners, const Patch& patch) {
    for (std::uint32_t& p : corners) {
      if (number[p] == 0xffffffffu) {
        number[p] = static_cast<std::uint32_t>(result.points.size());
        result.points.push_back(points_[p]);
      }
      p = number[p];
    }
    const auto [entry, fresh] = numbers.try_emplace(patch, static_cast<std::uint32_t>(result.patches.size()));
    if (fresh) result.patches.push_back(patch);
    result.triangles.push_back({corners, entry->second});
  };
  for (const BodyTriangle& t : triangles_) {
    // Triangles between two bodies form one patch, independent of their orientation.
    if (t.front < t.back) {
      add(t.points, {t.front, t.back, -1});
    } else {
      add({t.points[0], t.points[2], t.points[1]}, {t.back, t.front, -1});
    }
  }
  for (const SideTriangle& t : side_triangles_) add(t.points, {BodyId(), t.body, t.side});
  return result;
}

}  // namespace

PiecewiseLinearComplex stitch_to_box(const std::string& source, std::span<const Vec3> points,
                                     std::span<const BodyTriangle> triangles, const Box3& box,
                                     double tolerance, const std::function<BodyId(const Vec3&)>& body_at,
                                     const std::filesystem::path& program, const Progress& progress) {
  try {
    Stitcher stitcher(box, tolerance);
    stitcher.add_interfaces(points, triangles);
    stitcher.add_sides(program, progress);
    stitcher.name_bodies(body_at);
    PiecewiseLinearComplex complex = stitcher.finish(source);
    complex.check_closed();
    return complex;
  } catch (const Cancelled&) {
    throw;
  } catch (const ProgramFailure&) {
    throw;
  } catch (const Error& error) {
    const std::string message = error.what();
    if (message.starts_with(source)) throw;
    throw Error(source + ": " + message);
  }
}

}  // namespace adamas::interfaces
