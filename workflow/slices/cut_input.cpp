#include "workflow/slices/cut_input.h"

#include <numeric>

#include "adamas/text.h"
#include "core/base/error.h"
#include "interfaces/api/error_targets.h"
#include "interfaces/api/slice.h"
#include "interfaces/cross_section/field_choice.h"
#include "workflow/input/left_out_steps.h"
#include "workflow/slices/slice_loading.h"
#include "workflow/slices/slice_samples.h"

namespace adamas::workflow {

using namespace interfaces;
using namespace picture;

namespace {

/// Returns the name of a choice of sections on the command line.
std::string mode_name(SliceSections sections) {
  switch (sections) {
    case SliceSections::kInput:
      return "input";
    case SliceSections::kPlain:
      return "plain";
    case SliceSections::kMaterials:
      return "materials";
    case SliceSections::kAll:
      return "all";
    case SliceSections::kDefault:
      break;
  }
  return {};
}

std::vector<SliceMode> modes(const SliceRequest& request, const SliceInput& input, bool with_field) {
  const SliceSections wanted = request.sections;
  if (!input.mesh) {
    if (wanted == SliceSections::kDefault || wanted == SliceSections::kInput) return {SliceMode::kInput};
    wrong_usage("--mode {}: expected a resampled mesh (.vtu) as INPUT, found {}", mode_name(wanted),
                request.input.path.string());
  }
  const bool has_data = input.data != nullptr;
  if (wanted == SliceSections::kInput && !has_data) wrong_usage("--mode input: expected --original DATA");
  if (wanted == SliceSections::kInput) return {SliceMode::kInput};
  if (wanted == SliceSections::kPlain) return {SliceMode::kPlain};
  if (wanted != SliceSections::kAll) return {SliceMode::kMaterials};
  std::vector<SliceMode> all{SliceMode::kMaterials};
  // Without a field, the two modes of the mesh look the same.
  if (with_field) all.insert(all.begin(), SliceMode::kPlain);
  if (has_data) all.insert(all.begin(), SliceMode::kInput);
  return all;
}

/// Throws Error (kUsage) at options that have no effect where no field is shown.
void check_field_options(const SliceRequest& request, const std::string& field) {
  if (!field.empty()) return;
  if (request.range) wrong_usage("--range: expected --field as well");
  if (!request.colour_map.empty()) wrong_usage("--colour-map: expected --field as well");
  if (request.sections == SliceSections::kPlain) wrong_usage("--mode plain: expected --field as well");
}

/// Decides whether cells are drawn: as the options say; without them, the cells of a mesh are drawn, and
/// those of its input where they are wide enough to be seen.
void choose_cells(const SliceRequest& request, const SliceInput& input, const SliceOptions& size,
                  std::size_t panels, SliceStyle& style) {
  style.mesh_cells = request.cells.value_or(true);
  style.input_cells = request.cells
                          ? *request.cells
                          : input.mesh && input.data && shows_cells(input, style.plane, size, panels);
}

/// Returns the field of data without materials that is shown where no field is named.
std::string only_field(const SliceInput& input) {
  std::string found;
  for (const Field& field : input.data->fields) {
    if (field.components != 1) continue;
    if (!found.empty()) {
      wrong_usage("{}: expected --field, found no materials and several fields ({})", input.name,
                  field_names(field_infos(*input.data)));
    }
    found = field.name;
  }
  if (found.empty())
    fail("{}: expected materials or a field, or --field NAME:0 of a vector, found none", input.name);
  return found;
}

}  // namespace

SliceOptions picture_size(const SliceRequest& request) {
  SliceOptions size;
  size.width = request.width;
  size.greatest_height = request.greatest_height;
  return size;
}

std::optional<ValueRange> value_range(const SliceRequest& request) {
  if (!request.range) return {};
  return ValueRange{(*request.range)[0], (*request.range)[1]};
}

CutInput cut_input(const SliceRequest& request, bool polygons, OutputSet& outputs, Progress& progress) {
  CutInput result;
  SliceStyle& style = result.style;
  style.plane = request.plane;
  style.field = request.field;
  const SliceOptions size = picture_size(request);
  const SampleOrigin origin = sample_origin(request);
  style.interfaces = request.interfaces && origin == SampleOrigin::kNone;
  const auto check_input = [&](const SliceInput& read) {
    if (read.plain() && !read.interfaces) style.interfaces = false;
    if (read.plain() && style.field.empty()) style.field = only_field(read);
    check_field_options(request, style.field);
    result.modes = modes(request, read, !style.field.empty());
    if (polygons && result.modes.size() > 1)
      wrong_usage("--mode all: expected a picture as output, found a .vtp");
    if (read.outline(style.plane).empty()) {
      fail("{}: expected a plane that cuts {}, found {}", read.name, box_text(read.box()),
           to_string(style.plane));
    }
    for (const SliceMode mode : result.modes) choose_field(read, mode, style);
  };
  const auto check = [&](const SliceInput& read) { check_step([&] { check_input(read); }); };
  result.input = origin != SampleOrigin::kNone
                     ? load_samples(request, origin, style.field, check, outputs, progress)
                     : load_slice_input(request, style.interfaces && !polygons, check, progress);
  check_step([&] {
    choose_cells(request, result.input, size, result.modes.size(), style);
    for (const SliceMode mode : result.modes) {
      progress.step("cutting", -1);
      result.sections.push_back(cut(result.input, mode, style));
    }
  });
  return result;
}

SliceAreas section_areas(const CutInput& cut) {
  const CrossSection& section = cut.sections.back();
  SliceAreas areas{section.area, {}, cut.input.plain(), section.pieces.size()};
  if (areas.plain) return areas;
  const auto& materials = cut.input.materials();
  for (MaterialId m(0); m.value < materials.size(); ++m.value)
    areas.materials.emplace_back(materials[m],
                                 m.value < section.material_area.size() ? section.material_area[m] : 0);
  return areas;
}

Slice last_section(const CutInput& cut) {
  const auto& materials = cut.input.materials();
  Slice slice = to_slice(cut.sections.back(), cut.style.plane, {materials.begin(), materials.end()});
  if (!cut.style.field.empty()) slice.field = shown_field(cut.input, cut.style);
  return slice;
}

UnstructuredMesh section_polygons(const CutInput& cut) {
  Slice slice = last_section(cut);
  UnstructuredMesh mesh;
  mesh.kind = CellKind::kPolygons;
  mesh.points = std::move(slice.points);
  mesh.connectivity.resize(mesh.points.size());
  std::iota(mesh.connectivity.begin(), mesh.connectivity.end(), 0u);
  mesh.offsets = std::move(slice.offsets);
  const auto numbers = [](const auto& values) {
    return std::vector<std::int32_t>(values.begin(), values.end());
  };
  mesh.cell_arrays.push_back({"material", 1, numbers(slice.polygon_materials)});
  mesh.cell_arrays.push_back({"cell", 1, numbers(slice.polygon_cells)});
  if (!cut.style.field.empty()) mesh.point_arrays.push_back({cut.style.field, 1, std::move(slice.values)});
  mesh.field_arrays.push_back({"material_names", 1, std::move(slice.materials)});
  io::add_colours(cut.input.materials(), cut.input.colours, mesh.field_arrays);
  return mesh;
}

SlicePicture make_picture(const SliceRequest& request, const CutInput& cut) {
  SlicePicture picture = make_slice_picture(cut.input, cut.modes, cut.style, cut.sections);
  picture.range = value_range(request);
  if (!request.colour_map.empty()) picture.map = ColourMap::by_name(request.colour_map);
  return picture;
}

}  // namespace adamas::workflow
