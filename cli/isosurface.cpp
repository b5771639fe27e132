#include <filesystem>
#include <optional>
#include <vector>

#include "adamas/files.h"
#include "adamas/picture.h"
#include "adamas/resources.h"
#include "adamas/steps.h"
#include "adamas/volume_store.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/picture_options.h"
#include "cli/store_options.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

struct Options {
  StoreInput input;
  std::vector<double> isovalues;
  std::string output;
  IsosurfaceRequest request;
  PictureOptions picture;
  bool no_normals = false;
};

/// Returns a title of the store and, for a series, time and step.
std::string picture_title(const std::string& path, const VolumeStore& store, std::uint64_t step) {
  const std::string name = std::filesystem::path(path).filename().string();
  return store.steps() > 1 ? name + ", " + step_title(store.times()[step], step) : name;
}

void report(const Isosurface& found, const std::string& space, Session& session) {
  Console& console = session.console;
  const TriangleSurface& surface = found.surface;
  const auto& distance = found.distance;
  std::vector<std::vector<std::string>> rows{
      {"triangles", std::to_string(surface.triangles.size())},
      {"vertices", std::to_string(surface.points.size())},
      {"tetrahedra", std::to_string(found.tetrahedra)},
      {"isosurface error", fmt::format("{:.4g} (estimate)", found.max_error)},
      {"distance certified", distance ? fmt::format("{:.4g}", distance->certified) : ""},
      {"distance found", distance ? fmt::format("{:.4g}", distance->found) : ""},
      {"pages read", fmt::format("{}, and {} to predict them", found.reads.pages, found.reads.predictors)},
      {"bytes read", bytes_text(static_cast<double>(found.reads.bytes))},
      {"seconds", fmt::format("{:.2f}, {:.2f} of processors", console.seconds(), processor_seconds())},
      {"coordinates", space}};
  std::erase_if(rows, [](const auto& row) { return row[1].empty(); });
  console.table(rows);
  Figures figures{{"triangles", surface.triangles.size()},
                  {"vertices", surface.points.size()},
                  {"tetrahedra", found.tetrahedra},
                  {"diamonds", found.diamonds},
                  {"isosurface_error_estimate", found.max_error},
                  {"bodies_left_out", found.bodies_left_out}};
  // JSON has null for numbers that are not finite.
  if (distance) figures["distance"] = {{"certified", distance->certified}, {"found", distance->found}};
  if (!space.empty()) figures["space"] = space;
  add_page_counts(found.reads, figures);
  add_costs(figures, console);
  write_figures(figures, session);
}

void run(const Options& options, Session& session) {
  session.outputs.declare("-o", options.output, {".ply", ".stl", ".obj", ".vtp", ".glb", ".gltf"});
  session.outputs.declare("--picture", options.picture.file, {".png", ".svg", ".pdf", ".html"});
  const bool draws = !options.picture.file.empty();
  if (options.output.empty() && !draws && session.json.empty())
    wrong_usage("expected -o, --picture or --json, found no output");
  options.picture.check();
  Console& console = session.console;
  session.outputs.protect(options.input.path);
  VolumeStore store = VolumeStore::open(options.input.path, options.input.open);
  IsosurfaceRequest request = options.request;
  request.step = options.input.step;
  const VolumeGrid& grid = store.grid();
  request.normals = !options.no_normals && (!options.output.empty() || draws);
  const Isosurface found = store.isosurfaces(options.isovalues, request, console);
  session.outputs.write(options.output, [&](const auto& path) { write_mesh(path, found.surface, console); });
  if (draws) console.step("drawing", -1);
  session.outputs.write(options.picture.file, [&](const auto& path) {
    DrawingOptions drawing = options.picture.drawing;
    drawing.domain = request.region.value_or(grid.box());
    const std::string title = picture_title(options.input.path, store, request.step.value_or(0));
    write_picture(path, found.surface, {title, options.isovalues, found.ends}, drawing);
  });
  report(found, grid.space, session);
  session.commit();
}

}  // namespace

void add_isosurface(const Command& app, Session& session) {
  const auto [command, options] =
      add_command(app, session, "isosurface", "A closed surface of equal value from a store",
                  "adamas isosurface head.adm --isovalue 1150 --error 0.7voxels -o skull.ply", run);
  IsosurfaceRequest& request = options.request;
  add_store_input(command, options.input);
  add_step_option(command, options.input);
  command
      .add_values("--isovalue", "V", "The value; repeatable, for several surfaces in one file",
                  options.isovalues, parse_number)
      .required();
  command.add_value(
      "--error", "E|Evoxels|E%",
      "The greatest isosurface error, an estimate of the distance to the surface of all samples: in units of "
      "length, of voxels (the least spacing) or of the data's diagonal; default 0: all that the samples say",
      request.error, parse_surface_error);
  command.add_value("--max-triangles", "N",
                    "Never more triangles for an isovalue, whatever the error: a finer surface is decimated; "
                    "with --plain the greatest errors are refined first",
                    request.max_triangles, parse_count);
  command.add_value("--region", "x0,x1,y0,y1,z0,z1", "Only the surface in a box", request.region, parse_box);
  command.add_flag("--plain",
                   "The contour of the tetrahedra as it is: three times the triangles, many of them narrow",
                   request.plain);
  command.add_flag("--certify",
                   "Measure the distance to the surface of all samples, between two bounds, and refine until "
                   "it is within --error",
                   request.certify);
  command.add_flag("--no-normals", "Points without the normals of gradients", options.no_normals);
  command.add_flag("--strict", "Stop at damaged pages, instead of going on coarser there", request.strict);
  command.add_option("-o,--output", "FILE", "The surface: .ply, .stl, .obj, .vtp, .glb or .gltf",
                     options.output);
  add_picture_options(command, options.picture, "it");
}

}  // namespace adamas::cli
