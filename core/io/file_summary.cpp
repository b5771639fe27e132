#include "adamas/file_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>

#include "adamas/geometry.h"
#include "adamas/text.h"
#include "adamas/volume.h"
#include "core/base/error.h"
#include "core/geometry/plane.h"
#include "core/io/array_names.h"
#include "core/io/dicom_reader.h"
#include "core/io/grid_centering.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/mesh_file.h"
#include "core/io/polygon_soup.h"
#include "core/io/reader_program.h"
#include "core/io/sent_grids.h"
#include "core/io/unstructured_mesh_io.h"

namespace adamas {

using namespace io;

namespace {

template <class T>
void set_range(const std::vector<T>& values, ArraySummary& summary) {
  summary.min = std::numeric_limits<double>::infinity();
  summary.max = -summary.min;
  if constexpr (std::is_arithmetic_v<T>) {
    for (const T v : values) {
      const auto value = static_cast<double>(v);
      if (!std::isfinite(value)) continue;
      summary.min = std::min(summary.min, value);
      summary.max = std::max(summary.max, value);
    }
  }
}

void set_points(const std::vector<Vec3>& points, FileSummary& summary) {
  summary.points = points.size();
  for (const Vec3& p : points) summary.box.extend(p);
}

void set_grid_box(const GridFile& file, FileSummary& summary) {
  Box3 nodes;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& along = file.nodes[static_cast<std::size_t>(axis)];
    nodes.min[axis] = along.front();
    nodes.max[axis] = along.back();
  }
  if (!file.aslant) {
    summary.box = nodes;
    return;
  }
  const auto& [a, b, c] = file.aslant->directions;
  for (const Vec3& p : nodes.corners()) summary.box.extend(file.aslant->origin + p.x * a + p.y * b + p.z * c);
  summary.directions = {normalized(a), normalized(b), normalized(c)};
  summary.origin = file.aslant->origin + nodes.min.x * a + nodes.min.y * b + nodes.min.z * c;
}

void add_arrays(std::vector<GridArray> arrays, FileSummary& summary) {
  for (const GridArray& array : arrays) {
    ArraySummary item{array.name, array.type, array.centering == Centering::kCells ? "cells" : "points",
                      array.components};
    item.fraction_of = fraction_material(array.name);
    std::visit([&item](const auto& values) { set_range(values, item); }, array.values);
    if (item.min <= item.max)
      std::tie(item.min, item.max) = std::minmax({array.value(item.min), array.value(item.max)});
    summary.arrays.push_back(std::move(item));
  }
}

FileSummary summarize_grid(const std::filesystem::path& path, std::optional<Centering> wanted,
                           Centering otherwise, const RawVolume* raw) {
  GridFile file = read_grid_file(path, {.raw = raw});
  choose_centering(path.string(), wanted, otherwise, file);
  FileSummary summary;
  summary.kind = file.kind;
  summary.points = summary.cells = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& nodes = file.nodes[axis];
    summary.nodes[axis] = nodes.size();
    summary.points *= nodes.size();
    summary.cells *= nodes.size() - std::min<std::size_t>(nodes.size(), 1);
  }
  if (summary.points > 0) set_grid_box(file, summary);
  summary.space = file.space;
  summary.length_unit = file.length_unit;
  summary.value_unit = file.value_unit;
  summary.remark = file.remark;
  add_arrays(std::move(file.arrays), summary);
  return summary;
}

/// The area of a side of a cell, of which the triangles from the middle of its points consist, or the length
/// of an edge.
double extent_of(std::span<const std::uint32_t> side, const std::vector<Vec3>& points) {
  if (side.size() == 2) return distance(points[side[0]], points[side[1]]);
  Vec3 middle;
  for (const std::uint32_t p : side) middle += (1.0 / static_cast<double>(side.size())) * points[p];
  double area = 0;
  for (std::size_t i = 0; i < side.size(); ++i)
    area += polygon_area({middle, points[side[i]], points[side[(i + 1) % side.size()]]});
  return area;
}

void add_sets(const MeshFile& file, FileSummary& summary) {
  for (const MeshSet& set : file.sets) {
    SetSummary& item = summary.sets.emplace_back(SetSummary{set.name, set.of_nodes, set.size()});
    if (set.of_nodes) continue;
    item.extent = 0;
    for (std::size_t n = 0; n < set.size(); ++n) *item.extent += extent_of(set.side(n), file.points);
  }
}

FileSummary summarize_cells(const std::filesystem::path& path, std::optional<std::uint64_t> time) {
  MeshFile file = read_mesh_file(path, time);
  FileSummary summary;
  summary.kind = file.kind;
  set_points(file.points, summary);
  summary.cells = file.cell_ends.size();
  summary.blocks = file.blocks.size();
  summary.flat = file.flat;
  add_sets(file, summary);
  summary.remark = file.remark;
  summary.times = file.times;
  add_arrays(std::move(file.arrays), summary);
  return summary;
}

void add_arrays(const char* location, const std::vector<NamedArray>& arrays, FileSummary& summary) {
  constexpr std::array kTypes{"float64", "float32", "int32", "uint8", "string"};
  for (const NamedArray& array : arrays) {
    ArraySummary item{array.name, kTypes.at(array.values.index()), location, array.components};
    item.fraction_of = fraction_material(array.name);
    std::visit([&item](const auto& values) { set_range(values, item); }, array.values);
    summary.arrays.push_back(std::move(item));
  }
}

FileSummary summarize_mesh(const std::filesystem::path& path) {
  const UnstructuredMesh mesh = read_unstructured_mesh(path);
  FileSummary summary;
  summary.kind = mesh.kind == CellKind::kTetrahedra ? "tetrahedra"
                 : mesh.kind == CellKind::kPolygons ? "polygons"
                                                    : "lines";
  set_points(mesh.points, summary);
  summary.cells = mesh.cell_count();
  add_arrays("points", mesh.point_arrays, summary);
  add_arrays("cells", mesh.cell_arrays, summary);
  add_arrays("mesh", mesh.field_arrays, summary);
  return summary;
}

}  // namespace

std::vector<SeriesSummary> folder_series(const std::filesystem::path& path) {
  std::error_code unknown;
  if (!std::filesystem::is_directory(path, unknown) || !is_dicom_folder(path)) return {};
  auto series = receive_from_child<std::vector<SeriesSummary>>(request_of(LibraryReader::kDicomSeries, path));
  for (SeriesSummary& one : series) {
    one.name = visible_text(one.name);
    one.uid = visible_text(one.uid);
    one.kind = visible_text(one.kind);
  }
  return series;
}

void check_readable(const std::filesystem::path& path) { check_input_file(path); }

FileSummary summarize_file(const std::filesystem::path& path, std::optional<Centering> wanted,
                           Centering otherwise, const std::optional<RawVolume>& raw,
                           std::optional<std::uint64_t> time) {
  FileSummary summary;
  switch (kind_by_format(path)) {
    case InputKind::kMesh:
    case InputKind::kPolygons:
      return summarize_mesh(path);
    case InputKind::kCells:
      if (file_extension(path) != ".vtu" || time) return summarize_cells(path, time);
      try {
        return summarize_mesh(path);
      } catch (const Cancelled&) {
        throw;
      } catch (const Error&) {
        // It may have other cells than tetrahedra; other faults are found again.
        return summarize_cells(path, time);
      }
    case InputKind::kNetwork: {
      const InterfaceMesh mesh = read_interface_mesh(path);
      summary.kind = is_network_file(path) ? "labelled network" : "interfaces";
      set_points(mesh.points, summary);
      summary.cells = mesh.triangles.size();
      return summary;
    }
    case InputKind::kSurface: {
      const PolygonSoup soup = read_polygon_soup(path);
      summary.kind = "surface";
      set_points(soup.points, summary);
      summary.cells = soup.offsets.size() - 1;
      return summary;
    }
    case InputKind::kGrid:
      break;
  }
  return summarize_grid(path, wanted, otherwise, raw ? &*raw : nullptr);
}

}  // namespace adamas
