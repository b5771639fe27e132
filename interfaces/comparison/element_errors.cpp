#include "interfaces/comparison/element_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "interfaces/cell_errors/field_error.h"
#include "interfaces/network/box_tree.h"

namespace adamas::interfaces {

namespace {

constexpr std::size_t kChunk = 512;

/// Returns the whole tetrahedron as a part with one owner.
OwnedTetrahedron whole(BodyId body) {
  return {body.value, {Weights{1, 0, 0, 0}, Weights{0, 1, 0, 0}, Weights{0, 0, 1, 0}, Weights{0, 0, 0, 1}}};
}

class ElementMeasurer {
 public:
  ElementMeasurer(const ResamplingSource& source, const MeasuredCells& cells, const Progress& progress)
      : source_(source), cells_(cells), progress_(progress), views_(cells.count) {
    std::vector<Box3> boxes(cells.count);
    for (std::size_t i = 0; i < cells.count; ++i) {
      for (const Vec3& corner : cells.corners(i)) boxes[i].extend(corner);
    }
    boxes_ = boxes;
    tree_ = BoxTree(boxes);
    result_.fields = source.fields->fields().size();
    const std::size_t elements = source.fields->native_elements().size();
    result_.errors.assign(elements * result_.fields, {});
    result_.cells.assign(elements, 0);
  }

  void locate();
  void measure(double half_width);
  [[nodiscard]] ElementErrors take() { return std::move(result_); }

 private:
  [[nodiscard]] std::uint32_t cell_at(const Vec3& p) const;
  const CellView& view(std::size_t cell) {
    return views_.get(cell, [&] { return cells_.view(cell); });
  }

  const ResamplingSource& source_;
  const MeasuredCells& cells_;
  const Progress& progress_;
  ViewCache views_;
  std::vector<Box3> boxes_;
  BoxTree tree_;
  ElementErrors result_;
};

/// Returns the cell that holds a point or is closest to it.
std::uint32_t ElementMeasurer::cell_at(const Vec3& p) const {
  thread_local std::vector<std::uint32_t> candidates;
  // A point may be outside all boxes by round-off.
  for (double reach = 0;; reach = std::max(2 * reach, 1e-12 * source_.box.diagonal())) {
    tree_.near(p, reach, candidates);
    std::uint32_t best = 0;
    double greatest = -std::numeric_limits<double>::infinity();
    for (const std::uint32_t cell : candidates) {
      const Tetrahedron frame(cells_.corners(cell));
      if (!(frame.volume > 0)) continue;
      const Weights w = frame.weights(p);
      const double least = std::min({w[0], w[1], w[2], w[3]});
      if (least > greatest) best = cell, greatest = least;
    }
    if (std::isfinite(greatest) || reach > source_.box.diagonal()) return best;
  }
}

void ElementMeasurer::locate() {
  const auto& elements = source_.fields->native_elements();
  parallel_chunks(elements.size(), kChunk, [&](std::size_t first, std::size_t last) {
    progress_.check();
    for (std::size_t e = first; e < last; ++e) result_.cells[e] = cell_at(elements[e].position);
  });
}

void ElementMeasurer::measure(double half_width) {
  const CellsInBox nearby = [&](const Box3& box, MaterialId, const auto& visit) {
    std::vector<std::uint32_t> found;
    tree_.near(box.center(), 0.5 * box.diagonal(), found);
    for (const std::uint32_t cell : found) {
      if (boxes_[cell].touches(box)) visit(view(cell));
    }
  };
  // Limits of 0 give the least error.
  const std::vector<double> limits(result_.fields, 0.0);
  parallel_chunks(result_.cells.size(), kChunk, [&](std::size_t first, std::size_t last) {
    progress_.check();
    for (std::size_t e = first; e < last; ++e) {
      const std::array<std::uint32_t, 1> element{static_cast<std::uint32_t>(e)};
      const CellView& cell = view(result_.cells[e]);
      const auto errors = std::span(result_.errors).subspan(e * result_.fields, result_.fields);
      const auto displaced = measure_field_errors(source_, cell, element, errors);
      if (!displaced.empty())
        measure_displaced_errors(source_, cell, displaced, half_width, nearby, limits, errors);
    }
  });
}

}  // namespace

MeasuredCells measured_cells(const ResampledMesh& mesh) {
  const auto view = [&mesh](std::size_t i) {
    const auto& v = mesh.cells[i].vertices;
    CellView result{Tetrahedron(mesh.corners(i)),
                    {},
                    {&mesh.vertices[v[0]], &mesh.vertices[v[1]], &mesh.vertices[v[2]], &mesh.vertices[v[3]]},
                    {}};
    mesh.ownership(i, result.owners);
    if (!result.owners.pure()) keep_owners(result.owners.problem);
    partition_cell(result.owners, result.parts);
    return result;
  };
  return {mesh.cells.size(), [&mesh](std::size_t i) { return mesh.corners(i); }, view};
}

MeasuredCells measured_cells(const ConformingMesh& mesh, const std::vector<VertexRecord>& vertices) {
  const auto view = [&](std::size_t i) {
    const auto& v = mesh.tetrahedra[i];
    CellView result{Tetrahedron(mesh.corners(i)),
                    {},
                    {&vertices[v[0]], &vertices[v[1]], &vertices[v[2]], &vertices[v[3]]},
                    {whole(mesh.bodies[i])}};
    result.owners.problem.add_candidate(mesh.bodies[i].value);
    return result;
  };
  return {mesh.tetrahedra.size(), [&mesh](std::size_t i) { return mesh.corners(i); }, view};
}

std::vector<VertexRecord> fields_at_vertices(const ConformingMesh& mesh, const ResamplingSource& source) {
  std::vector<VertexRecord> vertices(mesh.points.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (const std::uint32_t v : mesh.tetrahedra[t]) vertices[v].add_row(mesh.bodies[t]);
  }
  parallel_for(vertices.size(), 64, [&](std::size_t v) {
    for (auto& [body, row] : vertices[v].rows) {
      row.resize(source.fields->row_size());
      source.fields->values(source.network->table().material(body), mesh.points[v], row);
    }
  });
  return vertices;
}

std::vector<FieldFigures> ElementErrors::figures(const std::vector<char>& at_interface) const {
  std::vector<FieldFigures> result(fields);
  for (std::size_t e = 0; e < cells.size(); ++e) {
    for (std::size_t f = 0; f < fields; ++f) {
      result[f].all.add(errors[e * fields + f]);
      if (at_interface[e] != 0) result[f].at_interfaces.add(errors[e * fields + f]);
    }
  }
  return result;
}

ElementErrors measure_element_errors(const ResamplingSource& source, const MeasuredCells& cells,
                                     double half_width, const Progress& progress) {
  ElementMeasurer measurer(source, cells, progress);
  measurer.locate();
  measurer.measure(half_width);
  return measurer.take();
}

}  // namespace adamas::interfaces
