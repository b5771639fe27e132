#include "interfaces/cutting/input_sets.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/distance/closest_point_tree.h"

namespace adamas::interfaces {

namespace {

using Index = std::uint32_t;

/// The boundary of a mesh and the sides of its sets, as triangles.
class InputFaces {
 public:
  explicit InputFaces(const MeshData& data) {
    // A side of several sets is there once, so that it is the nearest one for all of them.
    std::map<std::vector<Index>, std::vector<Index>> faces;   // the sets by the points of a face, ascending
    std::map<std::vector<Index>, std::vector<Index>> around;  // the points in order
    const auto add = [&](std::span<const Index> points) -> std::vector<Index>& {
      std::vector<Index> key(points.begin(), points.end());
      std::ranges::sort(key);
      around.try_emplace(key, points.begin(), points.end());
      return faces[key];
    };
    for (Index s = 0; s < data.sets.size(); ++s) {
      for (std::size_t n = 0; n < data.sets[s].side_ends.size(); ++n) {
        if (data.sets[s].side(n).size() >= 3) add(data.sets[s].side(n)).push_back(s);
      }
    }
    has_sets_ = !faces.empty();
    if (!has_sets_) return;
    for (std::size_t f = 0; f < data.mesh.face_count(); ++f) {
      if (data.mesh.cells_of_face(f)[1] == PolyhedralMesh::kNone) add(data.mesh.face(f));
    }
    std::vector<ClosestPointTree::Triangle> triangles;
    for (const auto& [key, points] : around) {
      for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        triangles.push_back({points[0], points[i], points[i + 1]});
        sets_.push_back(faces[key]);
      }
    }
    tree_ = ClosestPointTree(data.mesh.points(), triangles);
  }

  [[nodiscard]] bool has_sets() const { return has_sets_; }
  /// Returns the sets that have a triangle.
  [[nodiscard]] const std::vector<Index>& sets_of(const std::array<Vec3, 3>& corners,
                                                  double tolerance) const {
    static const std::vector<Index> kNothing;
    constexpr double kLeastCosine = 0.5;
    const Vec3 center = (1.0 / 3) * (corners[0] + corners[1] + corners[2]);
    const auto found = tree_.closest(center, tolerance);
    if (!found) return kNothing;
    const auto normal = [](const std::array<Vec3, 3>& t) {
      return normalized(cross(t[1] - t[0], t[2] - t[0]));
    };
    const double cosine = dot(normal(corners), normal(tree_.triangle(found->triangle)));
    return std::abs(cosine) >= kLeastCosine ? sets_[found->triangle] : kNothing;
  }

 private:
  bool has_sets_ = false;
  ClosestPointTree tree_;
  std::vector<std::vector<Index>> sets_;  // by triangle of the tree
};

}  // namespace

void add_input_sets(const MeshData& data, double tolerance, SolverMesh& mesh) {
  const InputFaces input(data);
  if (!input.has_sets()) return;
  std::vector<SolverMesh::FaceGroup> groups(data.sets.size());
  for (std::size_t s = 0; s < groups.size(); ++s) {
    const auto taken = [&](const SolverMesh::FaceGroup& group) { return group.name == data.sets[s].name; };
    groups[s].name = data.sets[s].name + (std::ranges::any_of(mesh.face_groups, taken) ? " (input)" : "");
  }
  for (const SolverMesh::FaceGroup& group : mesh.face_groups) {
    std::vector<std::vector<Index>> sets(group.faces.size());
    parallel_for(sets.size(), 256, [&](std::size_t n) {
      const auto [a, b, c] = mesh.corners(group.faces[n]);
      sets[n] = input.sets_of({mesh.points[a], mesh.points[b], mesh.points[c]}, tolerance);
    });
    for (std::size_t n = 0; n < sets.size(); ++n) {
      for (const Index s : sets[n]) groups[s].faces.push_back(group.faces[n]);
    }
  }
  for (SolverMesh::FaceGroup& group : groups) {
    if (!group.faces.empty()) mesh.face_groups.push_back(std::move(group));
  }
}

}  // namespace adamas::interfaces
