#include "viewer/contents/pair_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/parallel.h"

namespace adamas::viewer {

namespace {

/// The cosine of 35 degrees: triangles whose normals differ by more have a crease at their edge.
constexpr double kLeastSmoothCosine = 0.819152044288992;

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

/// Divides the triangles of one pair round their points.
class SurfaceMaker {
 public:
  SurfaceMaker(const InterfaceMesh& mesh, std::span<const std::uint32_t> triangles, PairSurface& surface)
      : mesh_(mesh), triangles_(triangles), surface_(surface) {
    surface.indices.resize(3 * triangles.size());
    for (const std::uint32_t t : triangles) add_triangle(mesh.triangles[t]);
    for (std::uint32_t c = 0; c < points_.size(); ++c) corners_.emplace_back(points_[c], c);
    std::sort(corners_.begin(), corners_.end());
  }

  void make_vertices() {
    for (std::size_t first = 0, last = 0; first < corners_.size(); first = last) {
      while (last < corners_.size() && corners_[last].first == corners_[first].first) ++last;
      divide(std::span(corners_).subspan(first, last - first));
    }
  }

 private:
  /// A point and a corner there: three for each triangle.
  using Corner = std::pair<std::uint32_t, std::uint32_t>;
  /// The point at the other end of an edge, and which of the corners at this end has it.
  using Spoke = std::pair<std::uint32_t, std::uint32_t>;

  void add_triangle(const InterfaceTriangle& triangle) {
    auto p = triangle.points;
    if (triangle.back < triangle.front) std::swap(p[1], p[2]);
    points_.insert(points_.end(), p.begin(), p.end());
    const Vec3 turn = cross(mesh_.points[p[1]] - mesh_.points[p[0]], mesh_.points[p[2]] - mesh_.points[p[0]]);
    surface_.area += norm(turn) / 2;
    normals_.push_back(normalized(turn));
  }

  [[nodiscard]] std::uint32_t next(std::uint32_t corner) const {
    return corner % 3 == 2 ? corner - 2 : corner + 1;
  }
  [[nodiscard]] double angle(std::uint32_t corner) const {
    const Vec3& p = mesh_.points[points_[corner]];
    return angle_between(mesh_.points[points_[next(corner)]] - p,
                         mesh_.points[points_[next(next(corner))]] - p);
  }

  /// Joins those corners at one point whose triangles share an edge without a crease.
  DisjointSets smooth_parts(std::span<const Corner> around) {
    DisjointSets parts(around.size());
    spokes_.clear();
    for (std::uint32_t i = 0; i < around.size(); ++i) {
      const std::uint32_t corner = around[i].second;
      spokes_.emplace_back(points_[next(corner)], i);
      spokes_.emplace_back(points_[next(next(corner))], i);
    }
    std::sort(spokes_.begin(), spokes_.end());
    for (std::size_t a = 0; a < spokes_.size(); ++a) {
      for (std::size_t b = a + 1; b < spokes_.size() && spokes_[b].first == spokes_[a].first; ++b) {
        const std::uint32_t i = spokes_[a].second, j = spokes_[b].second;
        if (dot(normals_[around[i].second / 3], normals_[around[j].second / 3]) >= kLeastSmoothCosine)
          parts.join(i, j);
      }
    }
    return parts;
  }

  void divide(std::span<const Corner> around) {
    DisjointSets parts = smooth_parts(around);
    vertex_of_.assign(around.size(), 0);
    const std::size_t fresh = surface_.vertices.size();
    for (std::uint32_t i = 0; i < around.size(); ++i) {
      const auto [point, corner] = around[i];
      const std::uint32_t part = parts.find(i);
      if (part == i) {
        vertex_of_[i] = static_cast<std::uint32_t>(surface_.vertices.size());
        surface_.vertices.push_back({point, triangles_[corner / 3], {}});
      }
      surface_.indices[corner] = vertex_of_[part];
      surface_.vertices[vertex_of_[part]].normal += angle(corner) * normals_[corner / 3];
    }
    for (std::size_t v = fresh; v < surface_.vertices.size(); ++v)
      surface_.vertices[v].normal = normalized(surface_.vertices[v].normal);
  }

  const InterfaceMesh& mesh_;
  std::span<const std::uint32_t> triangles_;
  PairSurface& surface_;
  std::vector<std::uint32_t> points_;  ///< point of each corner
  std::vector<Vec3> normals_;          ///< normal of each triangle
  std::vector<Corner> corners_;
  std::vector<Spoke> spokes_;
  std::vector<std::uint32_t> vertex_of_;
};

}  // namespace

std::vector<PairSurface> pair_surfaces(const InterfaceMesh& mesh) {
  std::map<std::pair<MaterialId, MaterialId>, std::vector<std::uint32_t>> triangles;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [front, back] = std::minmax(mesh.triangles[t].front, mesh.triangles[t].back);
    if (front != back) triangles[{front, back}].push_back(t);
  }
  std::vector<PairSurface> surfaces;
  std::vector<std::span<const std::uint32_t>> of_surface;
  for (const auto& [pair, some] : triangles) {
    PairSurface& surface = surfaces.emplace_back();
    surface.front = pair.first;
    surface.back = pair.second;
    of_surface.emplace_back(some);
  }
  parallel_for(surfaces.size(), 1,
               [&](std::size_t s) { SurfaceMaker(mesh, of_surface[s], surfaces[s]).make_vertices(); });
  return surfaces;
}

}  // namespace adamas::viewer
