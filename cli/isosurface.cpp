#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/isosurface_figures.h"
#include "cli/option_checks.h"
#include "cli/option_values.h"
#include "cli/store_input.h"
#include "cli/usage_error.h"
#include "core/base/error.h"
#include "core/io/surface_writer.h"
#include "isosurface/extraction/surface_extractor.h"
#include "isosurface/extraction/surface_normals.h"
#include "isosurface/storage/sample_dispatch.h"

namespace adamas {

namespace {

struct Options {
  StoreInput input;
  std::vector<std::string> isovalues;
  std::string error, max_triangles, region, output;
  bool no_normals = false, strict = false;
};

/// "0.7", "0.7 voxels" or "0.1%": an error in units of length, in the least spacing, or of the data's
/// diagonal.
double parse_surface_error(const std::string& text, const VolumeGrid& grid) {
  const double least = std::min({grid.spacing.x, grid.spacing.y, grid.spacing.z});
  for (const char* unit : {"voxels", "voxel", "v"}) {
    const std::string_view name(unit);
    if (!text.ends_with(name)) continue;
    std::string number = text.substr(0, text.size() - name.size());
    while (!number.empty() && number.back() == ' ') number.pop_back();
    if (number == "0") return 0;
    return least * parse_positive("--error", number);
  }
  if (text == "0") return 0;
  return parse_error_target("--error", text).of(grid.box().diagonal());
}

SurfaceRequest request_of(const Options& options, const VolumeGrid& grid) {
  SurfaceRequest request;
  request.strict = options.strict;
  if (!options.error.empty()) request.error = parse_surface_error(options.error, grid);
  if (!options.max_triangles.empty())
    request.max_triangles = parse_count("--max-triangles", options.max_triangles);
  if (!options.region.empty()) request.region = to_box(parse_bounds("--region", options.region));
  return request;
}

/// Adds a surface for one isovalue to those before.
void append(const ExtractedSurface& from, std::vector<Vec3> normals, double isovalue, bool several,
            TriangleSurface& surface) {
  const auto first = surface.points.size();
  if (first + from.contour.points.size() > ~std::uint32_t{0})
    fail("the surfaces have more than 2^32 - 1 points: choose fewer isovalues or a greater error");
  surface.points.insert(surface.points.end(), from.contour.points.begin(), from.contour.points.end());
  surface.normals.insert(surface.normals.end(), normals.begin(), normals.end());
  for (auto triangle : from.contour.triangles) {
    for (std::uint32_t& p : triangle) p += static_cast<std::uint32_t>(first);
    surface.triangles.push_back(triangle);
  }
  if (several) surface.values.resize(surface.points.size(), static_cast<float>(isovalue));
}

template <class Sample>
void extract_all(const Options& options, StoreFile& file, Session& session) {
  Console& console = session.console;
  const SurfaceRequest wanted = request_of(options, file.header().grid);
  StoredPages<OrderedWord<Sample>> pages(file, 0, store_memory(options.input));
  SurfaceExtractor<Sample> extractor(pages);
  TriangleSurface surface;
  surface.value_name = "isovalue";
  IsosurfaceFigures figures(session);
  for (const std::string& text : options.isovalues) {
    SurfaceRequest request = wanted;
    request.isovalue = parse_numbers("--isovalue", text, 1)[0];
    const ExtractedSurface found = extractor.extract(request, console);
    std::vector<Vec3> normals;
    if (!options.no_normals) normals = surface_normals<Sample>(pages, found.contour, console);
    figures.add(request, found, extractor.range());
    append(found, std::move(normals), request.isovalue, options.isovalues.size() > 1, surface);
  }
  session.outputs.write(options.output, [&](const auto& path) { write_surface(path, surface, console); });
  figures.report(surface, pages.counts());
}

void run(const Options& options, Session& session) {
  session.outputs.declare("-o", options.output, {".ply", ".stl", ".obj", ".vtp", ".glb", ".gltf"});
  for (const std::string& text : options.isovalues) parse_numbers("--isovalue", text, 1);
  store_memory(options.input);
  request_of(options, {{1, 1, 1}, {}, {}, {}});
  const std::unique_ptr<StoreFile> file = open_store(options.input, session);
  with_sample_type(file->header().grid.type,
                   [&](auto sample) { extract_all<decltype(sample)>(options, *file, session); });
  session.outputs.commit();
}

}  // namespace

void add_isosurface(CLI::App& app, Session& session) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = add_command(app, session, "isosurface", "A closed surface of equal value from a store",
                                  "adamas isosurface head.adm --isovalue 1150 --error 0.7voxels -o skull.ply",
                                  [options, &session] { run(*options, session); });
  add_store_input(*command, options->input);
  command->add_option("--isovalue", options->isovalues, "The value; repeatable")
      ->required()
      ->type_name("V")
      ->allow_extra_args(false);
  command
      ->add_option("--error", options->error,
                   "The isosurface error wanted: in units of length, of voxels (0.7voxels) or of the data's "
                   "diagonal (0.1%); default 0: all that the samples say")
      ->type_name("E|Evoxels|E%");
  command
      ->add_option("--max-triangles", options->max_triangles,
                   "Never more triangles; greatest errors go first")
      ->type_name("N");
  command->add_option("--region", options->region, "Only the surface in a box")
      ->type_name("x0,x1,y0,y1,z0,z1");
  command->add_flag("--no-normals", options->no_normals, "Points without the normals of gradients");
  command->add_flag("--strict", options->strict, "Stop at damaged pages, instead of going on coarser there");
  command->add_option("-o,--output", options->output, "The surface: .ply, .stl, .obj, .vtp, .glb or .gltf")
      ->required()
      ->type_name("FILE");
}

}  // namespace adamas
