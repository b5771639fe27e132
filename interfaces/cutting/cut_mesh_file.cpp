#include "interfaces/cutting/cut_mesh_file.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/parallel.h"
#include "interfaces/probe/cell_locator.h"

namespace adamas::interfaces {

namespace {

using Integers = std::vector<std::int32_t>;
using Doubles = std::vector<double>;
using Strings = std::vector<std::string>;

/// Evaluates a body's fields at points of a cut mesh by the linear functions of the mesh that was cut.
class Rows {
 public:
  Rows(const ConformingMesh& cut, const ResampledMesh& mesh) : cut_(cut), mesh_(mesh), locator_(mesh) {
    for (const FieldInfo& field : mesh.fields) size_ += static_cast<std::size_t>(field.components);
  }

  [[nodiscard]] std::size_t size() const { return size_; }

  Doubles at(std::uint32_t point, BodyId body) const {
    if (size_ == 0) return {};
    // If snapping has moved a point out of its body, the function of the nearest cell that has one is used.
    const auto place = locator_.nearest(cut_.points[point], [&](std::uint32_t cell) {
      const auto& v = mesh_.cells[cell].vertices;
      return std::all_of(v.begin(), v.end(),
                         [&](std::uint32_t w) { return mesh_.vertices[w].find(body) != nullptr; });
    });
    Doubles row(size_, std::nan(""));
    if (!place) return row;
    for (std::size_t k = 0; k < size_; ++k) row[k] = mesh_.value(place->cell, body, k, place->weights);
    return row;
  }

 private:
  const ConformingMesh& cut_;
  const ResampledMesh& mesh_;
  CellLocator locator_;
  std::size_t size_ = 0;
};

/// Points of a cut mesh, once for each body round them, in the order of their first use.
struct SplitPoints {
  std::vector<std::pair<std::uint32_t, BodyId>> points;
  std::vector<std::uint32_t> corners;  ///< indices into `points`, four for each tetrahedron
};

SplitPoints split_points(const ConformingMesh& cut) {
  SplitPoints result;
  std::map<std::pair<std::uint32_t, BodyId>, std::uint32_t> numbers;
  for (std::size_t t = 0; t < cut.tetrahedra.size(); ++t) {
    for (const std::uint32_t v : cut.tetrahedra[t]) {
      const auto [entry, fresh] =
          numbers.try_emplace({v, cut.bodies[t]}, static_cast<std::uint32_t>(result.points.size()));
      if (fresh) result.points.emplace_back(v, cut.bodies[t]);
      result.corners.push_back(entry->second);
    }
  }
  return result;
}

/// Returns one array for each field, from rows of all fields.
std::vector<NamedArray> field_arrays(const ResampledMesh& mesh, const std::vector<Doubles>& rows) {
  std::vector<NamedArray> arrays;
  for (const FieldInfo& field : mesh.fields) {
    Doubles values;
    for (const Doubles& row : rows) {
      const auto first = row.begin() + static_cast<std::ptrdiff_t>(field.offset);
      values.insert(values.end(), first, first + field.components);
    }
    arrays.push_back({field.name, field.components, std::move(values)});
  }
  return arrays;
}

std::vector<Doubles> rows_at(const SplitPoints& split, const Rows& rows) {
  std::vector<Doubles> values(split.points.size());
  parallel_for(values.size(), 256,
               [&](std::size_t i) { values[i] = rows.at(split.points[i].first, split.points[i].second); });
  return values;
}

/// Returns the side of the box on which three points lie; 6 if there is none.
std::size_t side_of_box(const Box3& box, const std::array<Vec3, 3>& face) {
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t end = 0; end < 2; ++end) {
      const double wall = end == 0 ? box.min[axis] : box.max[axis];
      if (std::all_of(face.begin(), face.end(), [&](const Vec3& p) { return p[axis] == wall; }))
        return 2 * static_cast<std::size_t>(axis) + end;
    }
  }
  return 6;
}

/// Returns the sides of the box and the faces between bodies. The latter are listed once, seen from the
/// lesser material, or twice, if bodies have points of their own.
std::vector<SolverMesh::FaceGroup> face_groups(const ConformingMesh& cut, const ResampledMesh& mesh,
                                               PointsOfBodies points) {
  std::vector<SolverMesh::FaceGroup> sides{{"x min", {}}, {"x max", {}}, {"y min", {}},
                                           {"y max", {}}, {"z min", {}}, {"z max", {}}};
  std::map<std::pair<MaterialId, MaterialId>, SolverMesh::FaceGroup> interfaces;
  const auto neighbours = find_neighbours(cut.tetrahedra, "cut mesh");
  for (std::uint32_t t = 0; t < cut.tetrahedra.size(); ++t) {
    const MaterialId material = mesh.table.material(cut.bodies[t]);
    for (std::uint8_t i = 0; i < 4; ++i) {
      const std::uint32_t other = neighbours[t][i];
      if (other == kNoNeighbour) {
        const auto& v = cut.tetrahedra[t];
        const std::size_t side = side_of_box(
            mesh.box, {cut.points[v[(i + 1) % 4]], cut.points[v[(i + 2) % 4]], cut.points[v[(i + 3) % 4]]});
        if (side < sides.size()) sides[side].faces.push_back({t, i});
        continue;
      }
      if (cut.bodies[other] == cut.bodies[t]) continue;
      const MaterialId beyond = mesh.table.material(cut.bodies[other]);
      const bool first = std::pair(material, cut.bodies[t]) < std::pair(beyond, cut.bodies[other]);
      if (first || points == PointsOfBodies::kSplit) interfaces[{material, beyond}].faces.push_back({t, i});
    }
  }
  for (auto& [pair, group] : interfaces) {
    group.name = mesh.materials[pair.first] + " | " + mesh.materials[pair.second];
    sides.push_back(std::move(group));
  }
  return sides;
}

}  // namespace

std::vector<VertexRecord> fields_at_vertices(const ConformingMesh& cut, const ResampledMesh& mesh) {
  const SplitPoints split = split_points(cut);
  std::vector<Doubles> rows = rows_at(split, Rows(cut, mesh));
  std::vector<VertexRecord> vertices(cut.points.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    vertices[split.points[i].first].rows.push_back({split.points[i].second, std::move(rows[i])});
  for (VertexRecord& vertex : vertices) {
    std::sort(vertex.rows.begin(), vertex.rows.end(),
              [](const auto& a, const auto& b) { return a.body < b.body; });
  }
  return vertices;
}

SolverMesh to_solver_mesh(const ConformingMesh& cut, const ResampledMesh& mesh, PointsOfBodies points) {
  SolverMesh result;
  const bool split = points == PointsOfBodies::kSplit;
  result.points = cut.points;
  result.tetrahedra = cut.tetrahedra;
  result.blocks.assign(mesh.materials.begin(), mesh.materials.end());
  for (const BodyId body : cut.bodies) {
    result.block.push_back(mesh.table.material(body).value);
    result.body.push_back(static_cast<std::int32_t>(body.value));
  }
  result.face_groups = face_groups(cut, mesh, points);
  const SplitPoints split_points_of_bodies = split_points(cut);
  const Rows rows(cut, mesh);
  const std::vector<Doubles> at_points = rows_at(split_points_of_bodies, rows);
  std::vector<Doubles> means(cut.tetrahedra.size(), Doubles(rows.size(), 0.0));
  for (std::size_t i = 0; i < split_points_of_bodies.corners.size(); ++i) {
    for (std::size_t k = 0; k < rows.size(); ++k)
      means[i / 4][k] += at_points[split_points_of_bodies.corners[i]][k] / 4;
  }
  result.fields = field_arrays(mesh, means);
  if (!split) return result;
  result.point_fields = field_arrays(mesh, at_points);
  result.points.clear();
  for (const auto& [v, body] : split_points_of_bodies.points) result.points.push_back(cut.points[v]);
  for (std::size_t i = 0; i < split_points_of_bodies.corners.size(); ++i)
    result.tetrahedra[i / 4][i % 4] = split_points_of_bodies.corners[i];
  return result;
}

}  // namespace adamas::interfaces
