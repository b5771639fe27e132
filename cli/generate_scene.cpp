#include <array>
#include <bit>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/series_options.h"
#include "cli/usage.h"
#include "cli/volume_options.h"
#include "core/io/input_file.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/multi_material_writer.h"
#include "core/io/volume_writer.h"
#include "datasets/fraction_blur.h"
#include "datasets/scene.h"
#include "datasets/scene_interfaces.h"
#include "datasets/scene_sampling.h"
#include "datasets/scene_volume.h"

namespace adamas::cli {

using namespace datasets;
using namespace io;

namespace {

struct Options {
  std::string name, dimensions, seed, box, interfaces, resolution, volume, blur, noise, output;
  std::optional<std::size_t> steps;
};

/// The scene that goes on in time, from 0 to 1.
constexpr const char* kMoving = "moving";
constexpr std::size_t kSteps = 60;

SeriesForm series_form(const Options& options) { return {options.volume.empty() ? ".vtr" : ".vti", kSteps}; }

std::uint64_t parse_seed(const std::string& text) {
  return text.empty() ? 0 : parse_count("--seed", text, 0);
}

/// The size of triangles where none is given: that of the grid's cells, or 1/64 of the shortest side.
double interface_resolution(const Options& options, const Box3& box) {
  if (!options.resolution.empty()) return parse_positive("--resolution", options.resolution);
  const Vec3 size = box.size();
  if (options.dimensions.empty()) return std::min({size.x, size.y, size.z}) / 64;
  const auto cells = parse_dimensions("--dimensions", options.dimensions);
  return std::min({size.x / static_cast<double>(cells[0]), size.y / static_cast<double>(cells[1]),
                   size.z / static_cast<double>(cells[2])});
}

/// What happens to the fractions at that time.
SamplingOptions sampling_options(const Options& options, double time) {
  SamplingOptions sampling;
  if (!options.blur.empty()) sampling.blur.blur = parse_up_to("--blur", options.blur, kGreatestBlur);
  if (!options.noise.empty()) sampling.blur.noise = parse_part("--noise", options.noise);
  // Each step has noise of its own. At time 1, where all other scenes are, the seed remains.
  sampling.noise_seed =
      parse_seed(options.seed) ^ std::bit_cast<std::uint64_t>(time) ^ std::bit_cast<std::uint64_t>(1.0);
  return sampling;
}

Scene scene_at(const Options& options, double time) {
  SceneOptions where{.time = time};
  if (!options.box.empty()) where.box = to_box(parse_bounds("--box", options.box));
  return make_scene(options.name, parse_seed(options.seed), where);
}

/// The figures of the materials' volumes, and rows of a table of them.
Figures volume_figures(const Scene& scene, const SceneIntegral* sampled,
                       std::vector<std::vector<std::string>>& rows) {
  rows = {{"material", "volume"}};
  if (sampled != nullptr) rows[0].insert(rows[0].end(), {"on the grid", "integration error"});
  Figures figures = Figures::array();
  for (MaterialId m(0); m.value < scene.materials().size(); ++m.value) {
    Figures figure{
        {"name", scene.materials()[m]}, {"volume", scene.volume(m)}, {"volume_error", scene.volume_error(m)}};
    rows.push_back({scene.materials()[m], volume_text(scene.volume(m))});
    if (sampled != nullptr) {
      figure["volume_sampled"] = sampled->volumes[m];
      figure["integration_error"] = sampled->errors[m];
      rows.back().insert(rows.back().end(),
                         {volume_text(sampled->volumes[m]), fmt::format("{:.2g}", sampled->errors[m])});
    }
    figures.push_back(std::move(figure));
  }
  return figures;
}

/// Writes the data of the scene at each time of the series, and adds what is in them to the figures.
class SceneSeries {
 public:
  SceneSeries(const Options& options, Session& session, SeriesOutput& output)
      : options_(options),
        session_(session),
        output_(output),
        cells_(parse_dimensions("--dimensions", options.dimensions)) {}

  void write(Figures& figures) {
    Figures steps = Figures::array();
    const auto make = [&](double time, Progress& progress) {
      Scene scene = scene_at(options_, time);
      SeriesOutput::Writer writer =
          options_.volume.empty() ? cells_of(scene, time, progress) : samples_of(scene, progress);
      steps.push_back({{"time", time}, {"materials", materials_}});
      return writer;
    };
    output_.write(make, session_.outputs, session_.console);
    figures["dimensions"] = cells_;
    figures["bytes"] = output_.bytes();
    figures["materials"] = materials_;
    if (output_.is_series()) {
      figures["steps"] = steps.size();
      figures["series"] = std::move(steps);
    }
    if (!options_.volume.empty()) {
      figures["type"] = options_.volume, figures["slope"] = slope_, figures["intercept"] = intercept_;
    } else {
      const FractionBlur blur = sampling_options(options_, 1).blur;
      figures["blur"] = blur.blur, figures["noise"] = blur.noise;
    }
    const std::string_view what = options_.volume.empty() ? "cells" : "samples";
    const std::string many = output_.is_series() ? fmt::format(", {} steps", output_.times().size()) : "";
    session_.console.print("Scene {} on {} x {} x {} {}{}, {}\n", options_.name, cells_[0], cells_[1],
                           cells_[2], what, many, bytes_text(static_cast<double>(output_.bytes())));
    session_.console.table(rows_);
  }

 private:
  SeriesOutput::Writer cells_of(const Scene& scene, double time, Progress& progress) {
    SceneIntegral integral;
    MultiMaterialData data =
        sample_scene(scene, cells_, sampling_options(options_, time), progress, &integral);
    materials_ = volume_figures(scene, &integral, rows_);
    return [data = std::move(data)](const auto& path) { write_multi_material_data(path, data); };
  }

  SeriesOutput::Writer samples_of(Scene scene, Progress& progress) {
    materials_ = volume_figures(scene, nullptr, rows_);
    return [this, &progress, scene = std::move(scene)](const std::filesystem::path& path) {
      const SceneVolume volume(scene, cells_, parse_sample_type(options_.volume));
      slope_ = volume.scale().slope(), intercept_ = volume.scale().intercept();
      std::vector<std::byte> samples(volume.grid().plane_bytes());
      const auto plane = [&](std::uint64_t k) {
        progress.check();
        volume.plane(k, samples);
        return std::span<const std::byte>(samples);
      };
      write_point_arrays(path, volume.grid(), {{"inside", slope_, intercept_, plane}});
    };
  }

  const Options& options_;
  Session& session_;
  SeriesOutput& output_;
  std::array<std::size_t, 3> cells_;
  // Of the last step.
  Figures materials_;
  std::vector<std::vector<std::string>> rows_;
  double slope_ = 1, intercept_ = 0;
};

/// Throws Error (kUsage) where options do not go together.
void check(const Options& options) {
  if (options.output.empty() && options.interfaces.empty())
    wrong_usage("expected -o or --interfaces, found neither");
  if (!options.resolution.empty() && options.interfaces.empty())
    wrong_usage("--resolution: expected --interfaces as well");
  if (!options.output.empty() && options.dimensions.empty())
    wrong_usage("-o: expected --dimensions X,Y,Z as well");
  if (options.output.empty() && options.steps) wrong_usage("--steps: expected -o F.pvd as well");
  if (options.output.empty() && !options.volume.empty()) wrong_usage("--volume: expected -o as well");
  for (const auto& [option, value] :
       {std::pair("--blur", &options.blur), std::pair("--noise", &options.noise)}) {
    if (value->empty()) continue;
    if (options.output.empty()) wrong_usage("{}: expected -o as well", option);
    if (!options.volume.empty())
      wrong_usage("{}: expected volume fractions, found --volume {}", option, options.volume);
  }
  sampling_options(options, 1);
}

SeriesOutput declare_output(const Options& options, OutputSet& outputs) {
  const bool moves = options.name == kMoving;
  if (!moves && file_extension(options.output) == ".pvd")
    wrong_usage("-o: expected the scene {} for a series, found {}", kMoving, options.name);
  std::vector<const char*> endings{".vti"};
  if (options.volume.empty()) endings.insert(endings.begin(), ".vtr");
  if (moves) endings.push_back(".pvd");
  return {options.output, options.steps, 1, series_form(options), endings, outputs};
}

void run(const Options& options, Session& session) {
  check(options);
  const Scene scene = scene_at(options, 1);
  const double resolution = interface_resolution(options, scene.box());
  std::optional<SeriesOutput> series;
  if (!options.output.empty()) series.emplace(declare_output(options, session.outputs));
  session.outputs.declare("--interfaces", options.interfaces,
                          {".vtp", ".ply", ".obj", ".off", ".stl", ".arec", ".txt"});
  Figures figures{{"dimensions", nullptr}, {"bytes", nullptr}, {"scene", scene.name()}};
  figures["seed"] = parse_seed(options.seed);
  figures["box"] = box_figures(scene.box());
  if (series) {
    SceneSeries(options, session, *series).write(figures);
  } else {
    session.console.print("Scene {}\n", scene.name());
    std::vector<std::vector<std::string>> rows;
    figures["materials"] = volume_figures(scene, nullptr, rows);
    session.console.table(rows);
  }
  if (!options.interfaces.empty()) {
    const InterfaceMesh mesh = scene_interfaces(scene, resolution, session.console);
    session.outputs.write(options.interfaces,
                          [&mesh](const auto& path) { write_interface_mesh(path, mesh); });
    session.console.print("Interfaces: {} triangles\n", mesh.triangles.size());
    figures["triangles"] = mesh.triangles.size();
  }
  session.outputs.write(session.json, [&figures](const auto& path) { write_figures(path, figures); });
  session.commit();
}

}  // namespace

void add_generate_scene(const Command& generate, Session& session) {
  const std::string example = "adamas generate scene voronoi10 --dimensions 32,32,32 --seed 7 -o cells.vtr";
  const auto options = std::make_shared<Options>();
  const Command command =
      add_command(generate, session, "scene", "Analytic materials with known volumes, and fields", example,
                  [options, &session] { run(*options, session); });
  command.add_option("name", options->name, "The scene").required().type_name("NAME").one_of(scene_names());
  command.add_option("--dimensions", options->dimensions, "Numbers of cells, or with --volume of samples")
      .type_name("X,Y,Z");
  command.add_option("--seed", options->seed, "Which of the scenes of a kind (voronoi10, random)")
      .type_name("N");
  command.add_option("--box", options->box, "Where the scene lies (default: the unit cube)")
      .type_name("x0,x1,y0,y1,z0,z1");
  command
      .add_option("--interfaces", options->interfaces,
                  "Write the true interfaces too (.vtp, .ply, .obj, .off, .stl, .arec)")
      .type_name("FILE");
  command
      .add_option("--resolution", options->resolution,
                  "Size of their triangles on curved interfaces (default: a cell)")
      .type_name("H");
  command
      .add_option("--volume", options->volume,
                  "Write samples of how far points are inside the bodies, as a volume, in place of fractions")
      .one_of(sample_type_names());
  command
      .add_option("--blur", options->blur,
                  fmt::format("Convolve the fractions with a Gaussian of so many cells, up to {} (default 0)",
                              kGreatestBlur))
      .type_name("S");
  command
      .add_option(
          "--noise", options->noise,
          "Then add normal noise of this standard deviation to fractions of mixed cells: a part of 1, "
          "0.02 or 2% (default 0)")
      .type_name("P|P%");
  add_series_steps(
      command, options->steps,
      fmt::format("How many data sets a series of {} has, from its start to its end (default {})", kMoving,
                  kSteps));
  command
      .add_option("-o,--output", options->output,
                  "The data: .vtr or .vti; of the scene moving the last, or a series: .pvd")
      .type_name("FILE");
}

}  // namespace adamas::cli
