#include <algorithm>
#include <memory>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/isosurface_report.h"
#include "cli/option_values.h"
#include "cli/store_options.h"
#include "cli/surface_picture.h"
#include "cli/usage.h"
#include "cli/volume_options.h"
#include "core/base/naming.h"
#include "core/data/volume_placement.h"
#include "core/io/surface_writer.h"
#include "isosurface/extraction/complete_surface.h"
#include "isosurface/volume/samples.h"
#include "timevarying/step_pages.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;
using namespace isosurface;
using namespace timevarying;

namespace {

struct Options {
  StoreInput input;
  std::vector<std::string> isovalues;
  std::string error, max_triangles, region, output;
  PictureOptions picture;
  bool no_normals = false, plain = false, certify = false, strict = false;
};

std::vector<double> parse_isovalues(const std::vector<std::string>& texts) {
  std::vector<double> values;
  for (const std::string& text : texts) {
    const double value = parse_numbers("--isovalue", text, 1)[0];
    if (std::find(values.begin(), values.end(), value) != values.end())
      wrong_usage("--isovalue: expected another value each time, found {} twice", text);
    values.push_back(value);
  }
  return values;
}

/// The box of --region, in space.
std::optional<Box3> wanted_region(const Options& options) {
  if (options.region.empty()) return {};
  return to_box(parse_bounds("--region", options.region));
}

SurfaceRequest request_of(const Options& options, const VolumeGrid& grid) {
  SurfaceRequest request;
  request.strict = options.strict;
  request.join = !options.plain;
  if (!options.error.empty())
    request.error = parse_surface_error(options.error, grid) / grid.greatest_stretch();
  if (!options.max_triangles.empty())
    request.max_triangles = parse_count("--max-triangles", options.max_triangles);
  if (const auto wanted = wanted_region(options)) set_region(request, grid, *wanted);
  return request;
}

/// Adds the surface of one isovalue to the surfaces of the isovalues before.
void append(Contour contour, std::vector<Vec3> normals, double isovalue, TriangleSurface& surface) {
  const auto first = surface.points.size();
  if (first + contour.points.size() > ~std::uint32_t{0})
    fail("the surfaces have more than 2^32 - 1 points: choose fewer isovalues or a greater error");
  if (first == 0) {
    surface.points = std::move(contour.points);
    surface.normals = std::move(normals);
    surface.triangles = std::move(contour.triangles);
  } else {
    surface.points.insert(surface.points.end(), contour.points.begin(), contour.points.end());
    surface.normals.insert(surface.normals.end(), normals.begin(), normals.end());
    for (auto triangle : contour.triangles) {
      for (std::uint32_t& p : triangle) p += static_cast<std::uint32_t>(first);
      surface.triangles.push_back(triangle);
    }
  }
  surface.values.resize(surface.points.size(), static_cast<float>(isovalue));
}

/// The store and, of a series, time and step.
std::string picture_title(const StoreFile& file, std::uint32_t step) {
  const std::string name = std::filesystem::path(file.name()).filename().string();
  return file.steps() > 1 ? name + ", " + step_title(file.times()[step], step) : name;
}

template <class Sample>
void extract_all(const Options& options, StoreFile& file, Session& session) {
  Console& console = session.console;
  const VolumeGrid& grid = file.header().grid;
  SurfaceRequest request = request_of(options, grid);
  const std::string& name = options.input.path;
  check_surface_request(name, grid, request, wanted_region(options));
  const std::uint32_t step = wanted_step(options.input, file, session);
  SeriesPages<OrderedWord<Sample>> pages(file, step, store_memory(options.input));
  SurfaceExtractor<Sample> extractor(pages);
  TriangleSurface surface;
  surface.value_name = "isovalue";
  IsosurfaceFigures figures(session, grid);
  const std::vector<double> isovalues = parse_isovalues(options.isovalues);
  std::vector<std::size_t> ends;
  for (const double isovalue : isovalues) {
    request.isovalue = grid.sample(isovalue);
    request.others_follow = ends.size() + 1 < isovalues.size();
    CompleteSurface found = naming(name, [&] {
      return extract_complete(
          extractor, request, options.certify,
          !options.no_normals && (!options.output.empty() || !options.picture.file.empty()), console);
    });
    figures.add(request, found, extractor.range());
    append(std::move(found.surface.contour), std::move(found.normals.normals), isovalue, surface);
    ends.push_back(surface.triangles.size());
  }
  place_in_space(grid, surface);
  session.outputs.write(options.output, [&](const auto& path) { write_surface(path, surface, console); });
  if (!options.picture.file.empty()) console.step("drawing", -1);
  session.outputs.write(options.picture.file, [&](const auto& path) {
    DrawingOptions drawing = options.picture.drawing;
    drawing.domain = wanted_region(options).value_or(grid.box());
    write_picture(path, surface, {picture_title(file, step), isovalues, ends}, drawing);
  });
  figures.report(surface, pages.counts());
}

void run(const Options& options, Session& session) {
  session.outputs.declare("-o", options.output, {".ply", ".stl", ".obj", ".vtp", ".glb", ".gltf"});
  session.outputs.declare("--picture", options.picture.file, {".png", ".svg", ".pdf", ".html"});
  if (options.output.empty() && options.picture.file.empty() && session.json.empty())
    wrong_usage("expected -o, --picture or --json, found no output");
  parse_isovalues(options.isovalues);
  options.picture.check();
  store_memory(options.input);
  VolumeGrid any;
  any.dimensions = {1, 1, 1};
  request_of(options, any);
  const std::unique_ptr<StoreFile> file = open_store(options.input, session);
  with_sample_type(file->header().grid.type,
                   [&](auto sample) { extract_all<decltype(sample)>(options, *file, session); });
  session.commit();
}

}  // namespace

void add_isosurface(const Command& app, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command =
      add_command(app, session, "isosurface", "A closed surface of equal value from a store",
                  "adamas isosurface head.adm --isovalue 1150 --error 0.7voxels -o skull.ply",
                  [options, &session] { run(*options, session); });
  add_store_input(command, options->input);
  add_step_option(command, options->input);
  command
      .add_option("--isovalue", options->isovalues, "The value; repeatable, for several surfaces in one file")
      .required()
      .type_name("V")
      .one_value_each();
  command
      .add_option(
          "--error", options->error,
          "The greatest isosurface error, an estimate of the distance to the surface of all samples: in "
          "units of length, of voxels (the least spacing) or of the data's diagonal; default 0: all that "
          "the samples say")
      .type_name("E|Evoxels|E%");
  command
      .add_option(
          "--max-triangles", options->max_triangles,
          "Never more triangles for an isovalue, whatever the error: a finer surface is decimated; with "
          "--plain the greatest errors are refined first")
      .type_name("N");
  command.add_option("--region", options->region, "Only the surface in a box").type_name("x0,x1,y0,y1,z0,z1");
  command.add_flag("--plain", options->plain,
                   "The contour of the tetrahedra as it is: three times the triangles, many of them narrow");
  command.add_flag(
      "--certify", options->certify,
      "Measure the distance to the surface of all samples, between two bounds, and refine until it is "
      "within --error");
  command.add_flag("--no-normals", options->no_normals, "Points without the normals of gradients");
  command.add_flag("--strict", options->strict, "Stop at damaged pages, instead of going on coarser there");
  command.add_option("-o,--output", options->output, "The surface: .ply, .stl, .obj, .vtp, .glb or .gltf")
      .type_name("FILE");
  add_picture_options(command, options->picture, "it");
}

}  // namespace adamas::cli
