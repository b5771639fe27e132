#include "adamas/slice.h"

#include "core/base/loop_progress.h"
#include "core/data/grid_data.h"
#include "interfaces/api/adaptive_mesh.h"
#include "interfaces/api/input.h"
#include "interfaces/api/slice.h"

namespace adamas {

using namespace interfaces;

namespace interfaces {

Slice to_slice(CrossSection section, const Plane& plane, const std::vector<std::string>& materials) {
  Slice slice;
  slice.plane = plane;
  slice.materials = materials;
  for (const SectionPiece& piece : section.pieces) {
    slice.points.insert(slice.points.end(), piece.corners.begin(), piece.corners.end());
    slice.offsets.push_back(slice.points.size());
    slice.polygon_materials.push_back(piece.material.value);
    slice.polygon_cells.push_back(piece.cell);
    slice.values.insert(slice.values.end(), piece.values.begin(), piece.values.end());
  }
  slice.material_areas = std::move(section.material_area);
  slice.cell_edges = std::move(section.cell_edges);
  slice.interface_edges = std::move(section.interface_edges);
  return slice;
}

}  // namespace interfaces

namespace {

std::optional<FieldChoice> chosen(const std::vector<FieldInfo>& fields, const SliceFieldOptions& options,
                                  const std::string& source) {
  if (options.field.empty()) return {};
  return find_field(fields, options.field, source);
}

/// `data`: on a grid, or on a mesh of cells.
template <class Data>
Slice slice_data(const Data& data, const Plane& plane, const SliceFieldOptions& options) {
  const std::vector<FieldInfo> fields = field_infos(data);
  const auto field = chosen(fields, options, data.source);
  Slice result = to_slice(cross_section(data, plane, field), plane, data.materials);
  if (field) result.field = field_label(fields, *field);
  return result;
}

}  // namespace

Slice slice(const AdaptiveMesh& mesh, const Plane& plane, const SliceFieldOptions& options) {
  const ResampledMesh& cut = mesh.contents().mesh();
  const auto field = chosen(cut.fields, options, cut.source);
  Slice result = to_slice(
      cross_section(cut, plane, field, options.plain ? SectionMode::kPlain : SectionMode::kPerMaterial),
      plane, cut.materials);
  if (field) result.field = field_label(cut.fields, *field);
  return result;
}

Slice slice(const GridData& data, const Plane& plane, const SliceFieldOptions& options) {
  return slice_data(to_multi_material_data(data), plane, options);
}

Slice slice(const Input& input, const Plane& plane, const SliceFieldOptions& options, Progress& progress) {
  const LoopProgress loops(progress);
  const Input::Contents& contents = input.contents();
  if (contents.data && (!contents.mesh || !options.field.empty()))
    return slice_data(*contents.data, plane, options);
  if (contents.cells && !options.field.empty()) {
    Slice result = slice_data(*contents.cells, plane, options);
    // The outside, which the section leaves empty, is a material too.
    result.materials = contents.materials;
    result.material_areas.resize(contents.materials.size(), 0);
    return result;
  }
  static_cast<void>(chosen({}, options, input.name()));
  const ResamplingSource source = contents.source({}, progress);
  return to_slice(cross_section(*source.network, source.box, source.materials.size(), plane, source.name),
                  plane, contents.materials);
}

}  // namespace adamas
