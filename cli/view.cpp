#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/output_folder.h"
#include "cli/store_options.h"
#include "cli/usage_error.h"
#include "core/base/naming.h"
#include "core/picture/canvas.h"
#include "viewer/gl/offscreen_context.h"
#include "viewer/gl/surface_renderer.h"
#include "viewer/scene/flight.h"
#include "viewer/scene/store_frames.h"

namespace adamas {

namespace {

struct Options {
  StoreInput input;
  std::string isovalue, pixels = "1", max_triangles = "500000", path = "orbit:36", frames, size = "1024,768",
                        shading = "lit";
  bool offscreen = false, overwrite = false;
};

struct Size {
  int width, height;
};

Size size_of(const Options& options) {
  const std::vector<double> sides = parse_numbers("--size", options.size, 2);
  for (const double side : sides) {
    if (side < 16 || side > 8192 || side != static_cast<int>(side))
      wrong_usage("--size: expected a width and a height from 16 to 8192, found '{}'", options.size);
  }
  return {static_cast<int>(sides[0]), static_cast<int>(sides[1])};
}

FrameRequest request_of(const Options& options) {
  FrameRequest request;
  request.isovalue = parse_numbers("--isovalue", options.isovalue, 1)[0];
  request.pixels = parse_positive("--pixels", options.pixels);
  request.max_triangles = parse_count("--max-triangles", options.max_triangles);
  return request;
}

std::string frame_name(std::size_t n) { return fmt::format("frame{:04}.png", n + 1); }

void write_frame(const std::string& path, const Raster& raster) {
  const double width = raster.width(), height = raster.height();
  Canvas canvas(PictureFormat::kPng, width, height);
  canvas.image(raster, {{0, 0}, {width, height}});
  write_bytes(path, canvas.finish(""));
}

Figures figures_of(const Frame& frame, double draw_seconds) {
  return {{"triangles", frame.figures.triangles},
          {"splits", frame.figures.splits},
          {"merges", frame.figures.merges},
          {"largest_error_pixels", frame.figures.largest_error},
          {"update_seconds", frame.update_seconds},
          {"normal_seconds", frame.normal_seconds},
          {"draw_seconds", draw_seconds}};
}

/// Draws the frames into the folder, where there is one.
Figures fly(const Options& options, const Size& size, FrameRequest request, StoreFrames& frames,
            const OutputFolder* folder, Session& session) {
  const OffscreenContext context;
  SurfaceRenderer renderer(size.width, size.height);
  const Shading shading = options.shading == "sphere" ? Shading::kSphere : Shading::kLit;
  const std::vector<Viewpoint> path = flight(options.path, frames.data_box(), size.width, size.height);
  Figures all = Figures::array();
  double seconds = 0, largest = 0;
  std::uint64_t most = 0;
  for (std::size_t n = 0; n < path.size(); ++n) {
    session.console.step("flying", static_cast<double>(n) / static_cast<double>(path.size()));
    request.viewpoint = path[n];
    const Frame frame = frames.next(request);
    const double before = session.console.seconds();
    renderer.set_surface(frame.surface);
    const Raster raster = renderer.draw(path[n], shading);
    const double draw_seconds = session.console.seconds() - before;
    if (folder != nullptr) folder->fill([&] { write_frame(folder->file(frame_name(n)), raster); });
    all.push_back(figures_of(frame, draw_seconds));
    seconds += frame.update_seconds + frame.normal_seconds + draw_seconds;
    largest = std::max(largest, frame.figures.largest_error);
    most = std::max(most, frame.figures.triangles);
  }
  session.console.clear();
  const auto count = static_cast<double>(path.size());
  session.console.table({{"frames", std::to_string(path.size())},
                         {"most triangles", std::to_string(most)},
                         {"largest error", fmt::format("{:.3g} pixels (estimate)", largest)},
                         {"seconds a frame", fmt::format("{:.3f}", seconds / count)},
                         {"drawn by", context.name()}});
  return {{"drawn_by", context.name()}, {"frames", std::move(all)}};
}

void run(const Options& options, Session& session) {
  if (!options.offscreen) wrong_usage("expected --offscreen: pictures are drawn without a window");
  if (options.frames.empty() && session.json.empty())
    wrong_usage("expected --frames or --json, found no output");
  const Size size = size_of(options);
  FrameRequest request = request_of(options);
  const std::size_t memory = store_memory(options.input);
  std::optional<OutputFolder> folder;
  if (!options.frames.empty())
    folder.emplace(options.frames, options.overwrite, std::initializer_list<const char*>{"frame0001.png"});
  const std::unique_ptr<StoreFile> file = open_store(options.input, session);
  request.isovalue = file->header().grid.sample(request.isovalue);
  const std::unique_ptr<StoreFrames> frames = StoreFrames::open(*file, memory);
  Figures figures = naming(options.input.path, [&] {
    return fly(options, size, request, *frames, folder ? &*folder : nullptr, session);
  });
  add_page_counts(frames->counts(), figures);
  figures["seconds"] = session.console.seconds();
  session.outputs.write(session.json, [&figures](const auto& path) { write_figures(path, figures); });
  if (folder) folder->commit();
  session.outputs.commit();
}

}  // namespace

void add_view(const Command& app, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command =
      add_command(app, session, "view", "Frames of a flight round a surface of a store, without a window",
                  "adamas view head.adm --isovalue 1150 --offscreen --camera-path orbit:36 --frames frames",
                  [options, &session] { run(*options, session); });
  add_store_input(command, options->input);
  command.add_option("--isovalue", options->isovalue, "The value of the surface").required().type_name("V");
  command.add_flag("--offscreen", options->offscreen,
                   "Draw without a window: by a graphics device, or the processor");
  command
      .add_option(
          "--camera-path", options->path,
          "orbit:N: once round the data in N frames; or a file with a viewpoint on each line: eye, target "
          "and upward direction, nine numbers in the frame of the grid")
      .type_name("orbit:N|FILE")
      .show_default();
  command.add_option("--frames", options->frames, "The folder of the pictures: frame0001.png and so on")
      .type_name("DIR");
  command.add_flag("--overwrite", options->overwrite, "Replace a folder of frames that is there");
  command
      .add_option("--pixels", options->pixels,
                  "The greatest isosurface error, an estimate of the distance to the surface of all samples, "
                  "as it is "
                  "seen: in pixels")
      .type_name("E")
      .show_default();
  command
      .add_option("--max-triangles", options->max_triangles,
                  "Never more triangles in a frame, whatever the error")
      .type_name("N")
      .show_default();
  command.add_option("--size", options->size, "Width and height of the pictures")
      .type_name("W,H")
      .show_default();
  command
      .add_option("--shading", options->shading,
                  "Lit by a light beside the eye, or as a sphere is with silhouettes")
      .one_of({"lit", "sphere"})
      .show_default();
}

}  // namespace adamas
