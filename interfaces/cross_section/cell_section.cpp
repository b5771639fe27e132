#include <algorithm>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "core/base/parallel.h"
#include "interfaces/cross_section/cross_section.h"

namespace adamas::interfaces {

namespace {

using Index = PolyhedralMesh::Index;
using Edge = std::pair<Index, Index>;

/// Cuts the cells of a mesh by a plane.
class CellSection {
 public:
  CellSection(const MeshData& data, const Plane& plane, const std::optional<FieldChoice>& choice)
      : data_(data), sides_(plane, data.mesh.box(), data.source), choice_(choice) {
    distances_.reserve(data.mesh.points().size());
    for (const Vec3& p : data.mesh.points()) distances_.push_back(sides_.distance(p));
  }

  void cut_cell(std::size_t cell, std::vector<SectionPiece>& pieces) const {
    bool above = false, below = false;
    for (const Index p : data_.mesh.points_of_cell(cell))
      (sides_.above(distances_[p]) ? above : below) = true;
    if (!above || !below) return;
    const MaterialId material = main_material(cell);
    for (const std::vector<Edge>& loop : loops_of(cell)) {
      SectionPiece piece;
      piece.cell = cell;
      piece.material = material;
      for (const Edge& edge : loop) {
        const auto [a, b] = edge;
        piece.corners.push_back(PlaneSides::crossing(data_.mesh.points()[a], distances_[a],
                                                     data_.mesh.points()[b], distances_[b]));
        if (choice_) piece.values.push_back(value_at(cell, material, edge));
      }
      if (!(polygon_area(piece.corners) > 0)) continue;
      if (dot(normal_of(piece.corners), sides_.normal()) < 0) {
        std::ranges::reverse(piece.corners);
        std::ranges::reverse(piece.values);
      }
      pieces.push_back(std::move(piece));
    }
  }

 private:
  /// Follows the plane from face to face through the edges of a cell that it crosses: each of them has two
  /// faces of the cell.
  [[nodiscard]] std::vector<std::vector<Edge>> loops_of(std::size_t cell) const {
    std::map<Edge, std::vector<Edge>> beside;
    for (const Index f : data_.mesh.faces_of_cell(cell)) {
      const auto points = data_.mesh.face(f);
      std::vector<Edge> crossed;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto [a, b] = std::minmax(points[i], points[(i + 1) % points.size()]);
        if (sides_.above(distances_[a]) != sides_.above(distances_[b])) crossed.emplace_back(a, b);
      }
      for (std::size_t i = 0; i + 1 < crossed.size(); i += 2) {
        beside[crossed[i]].push_back(crossed[i + 1]);
        beside[crossed[i + 1]].push_back(crossed[i]);
      }
    }
    std::vector<std::vector<Edge>> loops;
    while (!beside.empty()) {
      std::vector<Edge>& loop = loops.emplace_back();
      Edge at = beside.begin()->first;
      for (auto found = beside.find(at); found != beside.end(); found = beside.find(at)) {
        loop.push_back(at);
        const std::vector<Edge> next = std::move(found->second);
        beside.erase(found);
        for (const Edge& edge : next) {
          if (beside.contains(edge)) at = edge;
        }
      }
    }
    return loops;
  }

  [[nodiscard]] MaterialId main_material(std::size_t cell) const {
    MaterialId most(0);
    for (MaterialId m(1); m.value < data_.materials.size(); ++m.value) {
      if (data_.fraction(m, cell) > data_.fraction(most, cell)) most = m;
    }
    return most;
  }

  /// The value where the plane crosses an edge: that of the cell, or linear between points.
  [[nodiscard]] double value_at(std::size_t cell, MaterialId material, const Edge& edge) const {
    const MeshField& field = data_.fields[choice_->field];
    const FieldValues* values = &field.values;
    if (field.per_material()) {
      if (material.value >= field.material_values.size() || field.material_values[material].empty())
        return std::numeric_limits<double>::quiet_NaN();
      values = &field.material_values[material];
    }
    const auto components = static_cast<std::size_t>(field.components);
    const auto [a, b] = edge;
    const double t = distances_[a] / (distances_[a] - distances_[b]);
    std::vector<double> row(components);
    for (std::size_t c = 0; c < components; ++c) {
      const auto of_point = [&](Index p) { return (*values)[p * components + c]; };
      row[c] = field.centering == Centering::kCells ? (*values)[cell * components + c]
                                                    : (1 - t) * of_point(a) + t * of_point(b);
    }
    return choice_->scalar(row);
  }

  static Vec3 normal_of(const std::vector<Vec3>& corners) {
    Vec3 sum;
    for (std::size_t i = 0; i < corners.size(); ++i)
      sum += cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
    return sum;
  }

  const MeshData& data_;
  PlaneSides sides_;
  std::optional<FieldChoice> choice_;
  std::vector<double> distances_;  // of points from the plane
};

}  // namespace

CrossSection cross_section(const MeshData& data, const Plane& plane, const std::optional<FieldChoice>& field,
                           bool cell_edges) {
  constexpr std::size_t kChunk = 4096;
  const CellSection cells(data, plane, field);
  std::vector<std::vector<SectionPiece>> parts((data.mesh.cell_count() + kChunk - 1) / kChunk);
  parallel_chunks(data.mesh.cell_count(), kChunk, [&](std::size_t first, std::size_t last) {
    for (std::size_t cell = first; cell < last; ++cell) cells.cut_cell(cell, parts[first / kChunk]);
  });
  CrossSection section;
  for (auto& pieces : parts) std::ranges::move(pieces, std::back_inserter(section.pieces));
  if (cell_edges) section.cell_edges = piece_edges(section.pieces);
  section.material_area.assign(data.materials.size(), 0);
  for (const SectionPiece& piece : section.pieces) {
    const double area = polygon_area(piece.corners);
    section.area += area;
    for (MaterialId m(0); m.value < data.materials.size(); ++m.value)
      section.material_area[m] += area * static_cast<double>(data.fraction(m, piece.cell));
  }
  return section;
}

}  // namespace adamas::interfaces
