#include "adamas/summary.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <map>

#include "adamas/file_names.h"
#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/unstructured_mesh_io.h"
#include "core/io/volume_input.h"
#include "interfaces/api/interface_areas.h"
#include "interfaces/mesh/interface_extraction.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/network/interface_mesh_check.h"
#include "interfaces/selection/selection.h"
#include "isosurface/volume/samples.h"
#include "workflow/input/load_mesh.h"
#include "workflow/input/read_input.h"

namespace adamas {

using namespace interfaces;
using namespace io;
using namespace isosurface;

namespace {

std::vector<MaterialVolume> to_volumes(const IdVector<MaterialId, std::string>& names,
                                       const IdVector<MaterialId, double>& volumes) {
  std::vector<MaterialVolume> result;
  for (MaterialId m(0); m.value < names.size(); ++m.value) result.push_back({names[m], volumes[m]});
  return result;
}

/// Returns the least and the greatest value over all materials; for vectors, of their lengths.
std::pair<double, double> range_of(const Field& field) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const auto add = [&](const FieldValues& values) {
    const auto n = static_cast<std::size_t>(field.components);
    for (std::size_t i = 0; i + n <= values.size(); i += n) {
      double value = values[i];
      if (n > 1) {
        value = 0;
        for (std::size_t c = 0; c < n; ++c) value = std::hypot(value, values[i + c]);
      }
      low = std::min(low, value);
      high = std::max(high, value);
    }
  };
  add(field.values);
  for (const auto& values : field.material_values) add(values);
  return {low, high};
}

MeshSummary summarize(const ResampledMesh& mesh) {
  MeshSummary summary;
  summary.source = mesh.source;
  summary.bodies = mesh.table.body_count();
  summary.interfaces = mesh.table.interface_count();
  std::map<int, std::size_t> levels;
  for (const auto& cell : mesh.cells) ++levels[cell.level];
  summary.levels.assign(levels.begin(), levels.end());
  summary.materials =
      to_volumes(mesh.materials, material_volumes(mesh.table, mesh.cell_set(), mesh.materials.size()));
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    const FieldInfo& info = mesh.fields[f];
    double worst = 0;
    for (const double e : mesh.field_errors[f]) worst = std::max(worst, e);
    summary.fields.push_back({info.name, info.unit, info.components, true, info.min, info.max, worst});
  }
  return summary;
}

/// Sets the array's range to that of the finite samples.
void set_range(VolumeReader& reader, ArraySummary& array, Progress& progress) {
  std::vector<std::byte> plane(reader.grid().plane_bytes());
  array.min = std::numeric_limits<double>::infinity();
  array.max = -array.min;
  const std::uint64_t planes = reader.grid().dimensions[2];
  for (std::uint64_t k = 0; k < planes; ++k) {
    progress.step("reading", static_cast<double>(k) / static_cast<double>(planes));
    reader.read_plane(k, plane);
    with_sample_type(reader.grid().type, [&](auto sample) {
      for (std::size_t at = 0; at < plane.size(); at += sizeof(sample)) {
        std::memcpy(&sample, plane.data() + at, sizeof(sample));
        const auto value = static_cast<double>(sample);
        if (!std::isfinite(value)) continue;
        array.min = std::min(array.min, value);
        array.max = std::max(array.max, value);
      }
    });
  }
}

/// Returns whether a file is read as a volume although no option says so.
bool is_volume_by_itself(const std::string& path, bool grid_wanted) {
  const InputFormat* format = find_format_by_name(path);
  if (format != nullptr && format->gives_volumes() && !format->gives_grids()) return true;
  // A folder may have several channels, which are the arrays of a grid.
  if (grid_wanted || format == nullptr || !format->several_times || format->is_folder != nullptr)
    return false;
  // Pictures of high dynamic range have the extension .hdr, as NIfTI's headers do.
  if (read_beginning(path).starts_with("#?")) return false;
  // A file of colours or vectors is not a volume. HDF5 has no such header; each of its data sets is a volume.
  return format->read_header == nullptr || format->read_header(path).arrays.front().source.components == 1;
}

/// Summarises data on a grid or on a mesh.
template <class Data>
MaterialDataSummary summarize_data(const Data& data) {
  MaterialDataSummary summary;
  summary.materials = to_volumes(data.materials, data.volumes());
  if (data.labels.empty()) summary.fraction_sums = {data.report.sum_min, data.report.sum_max};
  for (const auto& field : data.fields) {
    const auto [low, high] = range_of(field);
    summary.fields.push_back({field.name, field.unit, field.components, field.per_material(), low, high});
  }
  return summary;
}

}  // namespace

MaterialDataSummary summarize_materials(const InputOptions& options, Progress& progress) {
  if (!options.path.empty() && input_kind(options.path) == InputKind::kCells)
    return summarize_data(workflow::load_mesh_data(options, progress));
  return summarize_data(workflow::load_data(options, progress));
}

std::optional<MeshSummary> summarize_mesh(const std::filesystem::path& path) {
  const UnstructuredMesh mesh = read_unstructured_mesh(path);
  if (!is_resampled_mesh(mesh)) return {};
  return summarize(from_unstructured_mesh(mesh, path.string()));
}

bool is_hierarchy_file(const std::filesystem::path& path) { return workflow::is_saved_hierarchy(path); }

HierarchySummary summarize_hierarchy(const std::filesystem::path& path, Progress& progress) {
  const SavedHierarchy hierarchy = workflow::load_saved_tree(path, progress);
  return {hierarchy.tree.cells.size(), hierarchy.root_count + hierarchy.split_cells.size(),
          hierarchy.diamond_count(), hierarchy.interface_target, summarize(whole_mesh(hierarchy))};
}

NetworkSummary summarize_interfaces(const InputOptions& options) {
  const InterfaceMesh mesh = workflow::read_given_interfaces(options);
  NetworkSummary summary;
  summary.materials.assign(mesh.materials.begin(), mesh.materials.end());
  summary.interfaces = interface_areas(mesh);
  try {
    const InterfaceMeshReport report = check_interface_mesh(mesh, nullptr, {true, true});
    summary.degenerate_triangles = report.degenerate_triangles;
    summary.junction_edges = report.junction_edges;
    summary.open_border_edges = report.open_border_edges;
    summary.flipped_edges = report.flipped_edges;
    summary.intersections = report.intersections;
  } catch (const Error& e) {
    summary.unsound = e.what();
  }
  return summary;
}

std::optional<VolumeSummary> summarize_volume(const VolumeInput& volume, bool grid_wanted, OutputSet& outputs,
                                              Progress& progress) {
  if (!volume.stack && input_kind(volume.path) == InputKind::kCells) return {};
  if (volume.option().empty() && !is_volume_by_itself(volume.path, grid_wanted)) return {};
  VolumeReader reader = open_volume_input(volume, outputs, progress);
  const VolumeGrid& grid = reader.grid();
  VolumeSummary summary;
  summary.grid = grid;
  FileSummary& file = summary.file;
  const std::string& kind = reader.source().kind;
  file.kind = kind.empty() ? "volume" : kind;
  file.points = file.cells = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    file.nodes[axis] = grid.dimensions[axis];
    file.points *= grid.dimensions[axis];
    file.cells *= grid.dimensions[axis] - 1;
  }
  file.box = grid.box();
  file.directions = grid.directions;
  file.origin = grid.origin;
  file.space = grid.space;
  file.length_unit = grid.length_unit;
  file.value_unit = grid.value_unit;
  file.arrays.push_back({volume.array.empty() ? file_stem(volume.path) : volume.array,
                         stored_name(reader.source().stored), "points", 1, 0, 0});
  set_range(reader, file.arrays.front(), progress);
  summary.conversion = reader.note();
  summary.loses_digits = reader.loses_digits();
  return summary;
}

}  // namespace adamas
