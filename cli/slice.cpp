#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/gradient_picture.h"
#include "cli/option_values.h"
#include "cli/resampling_options.h"
#include "cli/slice_panels.h"
#include "cli/slice_samples.h"
#include "cli/usage_error.h"
#include "core/data/unstructured_mesh.h"
#include "core/io/input_file.h"
#include "core/io/unstructured_mesh_io.h"
#include "interfaces/cross_section/cross_section.h"

namespace adamas {

namespace {

struct Options {
  InputOptions input;
  VolumeInput volume;
  std::string plane, origin, normal, original, mode, range, colour_map, size, output;
  bool gradients = false, draw_cells = false, no_draw_cells = false, no_interfaces = false;
};

Plane parse_any_plane(const Options& options) {
  if (options.plane.empty() == (options.origin.empty() && options.normal.empty())) {
    wrong_usage("expected --plane, or --origin and --normal");
  }
  if (!options.plane.empty()) return parse_plane_option("--plane", options.plane);
  if (options.origin.empty() || options.normal.empty()) {
    wrong_usage("expected --origin and --normal together");
  }
  return parse_plane_at(options.origin, options.normal);
}

/// The pieces of a section as polygons with points of their own, so that values jump at interfaces: cell
/// arrays `material` and `cell`, the point array `field` unless it is empty, the field array
/// `material_names`.
UnstructuredMesh section_polygons(const CrossSection& section,
                                  const IdVector<MaterialId, std::string>& materials,
                                  const std::string& field) {
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
  mesh.field_arrays.push_back({"material_names", 1, std::vector<std::string>(materials)});
  return mesh;
}

/// `--field NAME=FILE` adds a field as for other commands; the last one named is shown.
std::string split_fields(InputOptions& input) {
  std::string shown;
  std::vector<std::string> added;
  for (const std::string& text : input.fields) {
    if (text.find('=') != std::string::npos) added.push_back(text);
    shown = text.substr(0, text.find('='));
  }
  input.fields = added;
  return shown;
}

std::vector<SliceMode> modes(const Options& options, const SliceInput& input, bool with_field) {
  if (!input.mesh) {
    if (options.mode.empty() || options.mode == "input") return {SliceMode::kInput};
    wrong_usage("--mode {}: expected a resampled mesh (.vtu) as INPUT, found {}", options.mode,
                options.input.path);
  }
  const bool has_data = input.data != nullptr;
  if (options.mode == "input" && !has_data) wrong_usage("--mode input: expected --original DATA");
  if (options.mode == "input") return {SliceMode::kInput};
  if (options.mode == "plain") return {SliceMode::kPlain};
  if (options.mode != "all") return {SliceMode::kMaterials};
  std::vector<SliceMode> all{SliceMode::kMaterials};
  // Where no field is shown, the two modes of the mesh look the same.
  if (with_field) all.insert(all.begin(), SliceMode::kPlain);
  if (has_data) all.insert(all.begin(), SliceMode::kInput);
  return all;
}

SliceOptions picture_size(const Options& options) {
  SliceOptions size;
  if (options.size.empty()) return size;
  const auto sides = parse_numbers("--size", options.size, 2);
  for (const double side : sides) {
    if (!(side >= 200 && side <= 16000)) {
      wrong_usage("--size: expected a width and a height from 200 to 16000, found '{}'", options.size);
    }
  }
  size.width = sides[0];
  size.greatest_height = sides[1];
  return size;
}

std::optional<ValueRange> value_range(const Options& options) {
  if (options.range.empty()) return {};
  const auto [low, high] = parse_range(options.range);
  return ValueRange{low, high};
}

SlicePicture make_picture(const Options& options, const SliceInput& input, const SliceStyle& style,
                          const std::vector<SliceMode>& wanted, const std::vector<CrossSection>& sections) {
  SlicePicture picture = make_slice_picture(input, wanted, style, sections);
  picture.range = value_range(options);
  if (!options.colour_map.empty()) picture.map = ColourMap::by_name(options.colour_map);
  return picture;
}

/// Prints the areas of the materials in the last section, which is the one with the fields of each material.
/// Samples without materials have none.
void report_areas(const SliceInput& input, const CrossSection& section, bool plain, Session& session,
                  Figures& figures) {
  figures["area"] = section.area;
  figures["materials"] = Figures::array();
  if (plain) return session.console.table({{"area", volume_text(section.area)}});
  std::vector<std::vector<std::string>> rows{{"material", "area", "part"}};
  for (MaterialId m(0); m.value < input.materials().size(); ++m.value) {
    const double area = m.value < section.material_area.size() ? section.material_area[m] : 0;
    figures["materials"].push_back({{"name", input.materials()[m]}, {"area", area}});
    if (area > 1e-9 * section.area && rows.size() <= 40) {
      rows.push_back(
          {input.materials()[m], volume_text(area), fmt::format("{:.3f}%", 100 * area / section.area)});
    }
  }
  session.console.table(rows);
}

/// Throws UsageError at options that mean nothing where no field is shown.
void check_field_options(const Options& options, const std::string& field) {
  if (!field.empty()) return;
  if (!options.range.empty()) wrong_usage("--range: expected --field as well");
  if (!options.colour_map.empty()) wrong_usage("--colour-map: expected --field as well");
  if (options.mode == "plain") wrong_usage("--mode plain: expected --field as well");
}

/// Throws at options that make no sense, and at an output that cannot be written.
void check_options(const Options& options, OutputSet& outputs) {
  if (options.draw_cells && options.no_draw_cells)
    wrong_usage("--draw-cells and --no-draw-cells: expected one of them");
  value_range(options);
  const std::string main = with_main_file(options.input).path;
  protect_inputs(options.input, options.original.empty() ? main : options.original, outputs);
  outputs.declare("-o", options.output, {".png", ".svg", ".pdf", ".vtp"});
}

/// Whether cells are drawn: as the options say; without them, the cells of a mesh are drawn, and those of its
/// input where they are wide enough to be seen.
void choose_cells(const Options& options, const SliceInput& input, const SliceOptions& size,
                  std::size_t panels, SliceStyle& style) {
  style.mesh_cells = options.draw_cells || !options.no_draw_cells;
  style.input_cells = options.draw_cells || (!options.no_draw_cells && input.mesh && input.data &&
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

void run(const Options& options, Session& session) {
  Console& console = session.console;
  SliceStyle style;
  style.plane = parse_any_plane(options);
  const SliceOptions size = picture_size(options);
  if (options.gradients) {
    check_options(options, session.outputs);
    return draw_gradients({options.input.path, style.plane, options.output, size.width, options.volume.time},
                          session);
  }
  InputOptions from = options.input;
  style.field = split_fields(from);
  // Data without materials are enough unless an option is about materials.
  from.plain = from.material_option().empty() && options.original.empty();
  check_options(options, session.outputs);
  const SampleOrigin origin = sample_origin(options.input, options.volume, options.original);
  style.interfaces = !options.no_interfaces && origin == SampleOrigin::kNone;
  const bool polygons = file_extension(options.output) == ".vtp";

  std::vector<SliceMode> wanted;
  const auto check = [&](const SliceInput& read) {
    if (read.plain() && !read.interfaces) style.interfaces = false;
    if (read.plain() && style.field.empty()) style.field = only_field(read);
    check_field_options(options, style.field);
    wanted = modes(options, read, !style.field.empty());
    if (polygons && wanted.size() > 1) wrong_usage("--mode all: expected a picture as output, found a .vtp");
    if (read.outline(style.plane).empty()) {
      fail("{}: expected a plane that cuts {}, found {}", read.name, box_text(read.box()),
           to_string(style.plane));
    }
    for (const SliceMode mode : wanted) choose_field(read, mode, style);
  };
  const SliceInput input =
      origin != SampleOrigin::kNone
          ? load_samples(options.input, options.volume, origin, style.field, style.plane, check, session)
          : load_slice_input(from, options.original, style.interfaces && !polygons, check, console);
  choose_cells(options, input, size, wanted.size(), style);
  std::vector<CrossSection> sections;
  for (const SliceMode mode : wanted) {
    console.step("cutting", -1);
    sections.push_back(cut(input, mode, style));
  }
  Figures figures{{"area", nullptr}, {"materials", nullptr}, {"plane", to_string(style.plane)}};
  report_areas(input, sections.back(), input.plain(), session, figures);
  figures["pieces"] = sections.back().pieces.size();
  console.step("drawing", -1);
  session.outputs.write(options.output, [&](const auto& path) {
    if (polygons)
      return write_unstructured_mesh(path, section_polygons(sections.back(), input.materials(), style.field));
    write_slice(make_picture(options, input, style, wanted, sections), path, size);
  });
  session.outputs.write(session.json, [&](const auto& path) { write_figures(path, figures); });
  session.outputs.commit();
}

void add_drawing_options(const Command& command, Options& options) {
  command
      .add_option(
          "--mode", options.mode,
          "The input as it is, or of a mesh: plain linear interpolation, the fields of each material, "
          "all side by side (default: input for data, materials for a mesh)")
      .one_of({"input", "plain", "materials", "all"})
      .group("Picture");
  command
      .add_flag("--draw-cells", options.draw_cells,
                "Draw the cells (default for a mesh, and for its input unless they are tiny)")
      .group("Picture");
  command.add_flag("--no-draw-cells", options.no_draw_cells, "Do not draw the cells").group("Picture");
  command.add_flag("--no-interfaces", options.no_interfaces, "Do not draw the interfaces").group("Picture");
  command
      .add_flag("--gradients", options.gradients,
                "Of a store with gradients: their directions as colours, -1 to 1 of x, y and z as red, green "
                "and blue; grey where there is none")
      .group("Picture");
  command.add_option("--range", options.range, "Values at the ends of the colour map")
      .type_name("a,b")
      .group("Picture");
  command.add_option("--colour-map,--color-map", options.colour_map, "The colour map (default sequential)")
      .one_of(ColourMap::names())
      .group("Picture");
  command.add_option("--size", options.size, "Width and greatest height in pixels")
      .type_name("W,H")
      .group("Picture");
}

}  // namespace

void add_slice(const Command& app, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command = add_command(
      app, session, "slice", "A cross section of data, of a mesh, of interfaces or of a stored volume",
      "adamas slice mesh.vtu --plane z=0 --field Pressure --mode all --original cth.vtr -o slice.png",
      [options, &session] { run(*options, session); });
  command
      .add_option(
          "input", options->input.path,
          "What to cut: " + grid_files() +
              ", a mesh from adamas resample (.vtu), interfaces (.vtp, .ply, .arec, .txt), or a store from "
              "adamas store (.adm)")
      .type_name("FILE");
  command.add_option("--plane", options->plane, "The plane, at right angles to an axis")
      .type_name("x=N|y=N|z=N");
  command.add_option("--origin", options->origin, "A point of the plane").type_name("x,y,z");
  command.add_option("--normal", options->normal, "A vector at right angles to it").type_name("x,y,z");
  command
      .add_option("--original", options->original,
                  "What a mesh was resampled from: data on a grid, or a labelled network")
      .type_name("FILE");
  command.add_option("-o,--output", options->output, "A picture (.png, .svg, .pdf) or polygons (.vtp)")
      .required()
      .type_name("FILE");
  add_drawing_options(command, *options);
  add_material_options(command, options->input,
                       "The field to show, or NAME:x for a component of a vector; without, the materials. "
                       "NAME=FILE adds it first",
                       "NAME[=FILE-or-ARRAY]");
  add_smoothing_option(command, options->input);
  add_interface_options(command, options->input);
  add_volume_options(command, options->volume, "--first-sample");
}

}  // namespace adamas
