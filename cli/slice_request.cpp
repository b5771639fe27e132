#include "cli/slice_request.h"

#include "cli/option_values.h"
#include "cli/resampling_options.h"
#include "cli/usage.h"
#include "interfaces/cross_section/field_choice.h"
#include "workflow/input/left_out_steps.h"

namespace adamas::cli {

using namespace interfaces;
using namespace picture;
using namespace workflow;

namespace {

/// `--field NAME=FILE` adds a field as for other commands; the last one named is shown.
std::string split_fields(InputArguments& input) {
  std::string shown;
  std::vector<std::string> added;
  for (const std::string& text : input.fields) {
    if (text.find('=') != std::string::npos) added.push_back(text);
    shown = text.substr(0, text.find('='));
  }
  input.fields = added;
  return shown;
}

std::vector<SliceMode> modes(const SliceRequest& request, const SliceInput& input, bool with_field) {
  if (!input.mesh) {
    if (request.mode.empty() || request.mode == "input") return {SliceMode::kInput};
    wrong_usage("--mode {}: expected a resampled mesh (.vtu) as INPUT, found {}", request.mode,
                request.input.path);
  }
  const bool has_data = input.data != nullptr;
  if (request.mode == "input" && !has_data) wrong_usage("--mode input: expected --original DATA");
  if (request.mode == "input") return {SliceMode::kInput};
  if (request.mode == "plain") return {SliceMode::kPlain};
  if (request.mode != "all") return {SliceMode::kMaterials};
  std::vector<SliceMode> all{SliceMode::kMaterials};
  // Where no field is shown, the two modes of the mesh look the same.
  if (with_field) all.insert(all.begin(), SliceMode::kPlain);
  if (has_data) all.insert(all.begin(), SliceMode::kInput);
  return all;
}

/// Throws Error (kUsage) at options that mean nothing where no field is shown.
void check_field_options(const SliceRequest& request, const std::string& field) {
  if (!field.empty()) return;
  if (!request.range.empty()) wrong_usage("--range: expected --field as well");
  if (!request.colour_map.empty()) wrong_usage("--colour-map: expected --field as well");
  if (request.mode == "plain") wrong_usage("--mode plain: expected --field as well");
}

/// Whether cells are drawn: as the options say; without them, the cells of a mesh are drawn, and those of its
/// input where they are wide enough to be seen.
void choose_cells(const SliceRequest& request, const SliceInput& input, const SliceOptions& size,
                  std::size_t panels, SliceStyle& style) {
  style.mesh_cells = request.draw_cells || !request.no_draw_cells;
  style.input_cells = request.draw_cells || (!request.no_draw_cells && input.mesh && input.data &&
                                             shows_cells(input, style.plane, size, panels));
}

/// The field of data without materials to show where none is named.
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

Plane parse_any_plane(const SliceRequest& request) {
  if (request.plane.empty() == (request.origin.empty() && request.normal.empty())) {
    wrong_usage("expected --plane, or --origin and --normal");
  }
  if (!request.plane.empty()) return parse_plane_option("--plane", request.plane);
  if (request.origin.empty() || request.normal.empty()) {
    wrong_usage("expected --origin and --normal together");
  }
  return parse_plane_at(request.origin, request.normal);
}

SliceOptions picture_size(const SliceRequest& request) {
  SliceOptions size;
  if (request.size.empty()) return size;
  const auto sides = parse_numbers("--size", request.size, 2);
  for (const double side : sides) {
    if (!(side >= 200 && side <= 16000)) {
      wrong_usage("--size: expected a width and a height from 200 to 16000, found '{}'", request.size);
    }
  }
  size.width = sides[0];
  size.greatest_height = sides[1];
  return size;
}

std::optional<ValueRange> value_range(const SliceRequest& request) {
  if (request.range.empty()) return {};
  const auto [low, high] = parse_range(request.range);
  return ValueRange{low, high};
}

CutInput cut_input(const SliceRequest& request, bool polygons, Session& session) {
  CutInput result;
  SliceStyle& style = result.style;
  style.plane = parse_any_plane(request);
  const SliceOptions size = picture_size(request);
  InputArguments from = request.input;
  style.field = split_fields(from);
  // Data without materials are enough unless an option is about materials.
  from.plain = from.material_option().empty() && request.original.empty();
  const SampleOrigin origin = sample_origin(request.input, request.volume, request.original);
  style.interfaces = !request.no_interfaces && origin == SampleOrigin::kNone;
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
  result.input =
      origin != SampleOrigin::kNone
          ? load_samples(request.input, request.volume, request.step, origin, style.field, style.plane, check,
                         session)
          : load_slice_input(from, request.original, style.interfaces && !polygons, check, session.console);
  check_step([&] {
    choose_cells(request, result.input, size, result.modes.size(), style);
    for (const SliceMode mode : result.modes) {
      session.console.step("cutting", -1);
      result.sections.push_back(cut(result.input, mode, style));
    }
  });
  return result;
}

UnstructuredMesh section_polygons(const CutInput& cut) {
  const CrossSection& section = cut.sections.back();
  const std::string& field = cut.style.field;
  UnstructuredMesh mesh;
  mesh.kind = CellKind::kPolygons;
  std::vector<std::int32_t> material, cell;
  std::vector<double> values;
  for (const SectionPiece& piece : section.pieces) {
    for (const Vec3& p : piece.corners) {
      mesh.connectivity.push_back(static_cast<std::uint32_t>(mesh.points.size()));
      mesh.points.push_back(p);
    }
    mesh.offsets.push_back(mesh.connectivity.size());
    material.push_back(static_cast<std::int32_t>(piece.material.value));
    cell.push_back(static_cast<std::int32_t>(piece.cell));
    values.insert(values.end(), piece.values.begin(), piece.values.end());
  }
  mesh.cell_arrays.push_back({"material", 1, std::move(material)});
  mesh.cell_arrays.push_back({"cell", 1, std::move(cell)});
  if (!field.empty()) mesh.point_arrays.push_back({field, 1, std::move(values)});
  mesh.field_arrays.push_back({"material_names", 1, std::vector<std::string>(cut.input.materials())});
  return mesh;
}

SlicePicture make_picture(const SliceRequest& request, const CutInput& cut) {
  SlicePicture picture = make_slice_picture(cut.input, cut.modes, cut.style, cut.sections);
  picture.range = value_range(request);
  if (!request.colour_map.empty()) picture.map = ColourMap::by_name(request.colour_map);
  return picture;
}

}  // namespace adamas::cli
