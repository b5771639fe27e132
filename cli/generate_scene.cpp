#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adamas/file_names.h"
#include "adamas/files.h"
#include "adamas/generated_files.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/series_options.h"
#include "cli/usage.h"
#include "cli/volume_options.h"

namespace adamas::cli {

namespace {

struct Options {
  std::string name, interfaces, output;
  std::optional<SampleType> volume;
  std::optional<std::array<std::size_t, 3>> dimensions;
  std::optional<double> resolution, blur, noise;
  std::optional<std::size_t> steps;
  std::uint64_t seed = 0;
  Box3 box = SceneOptions().box;
};

/// The name of the scene that moves in time, from 0 to 1.
constexpr const char* kMoving = "moving";
constexpr std::size_t kSteps = 60;

SeriesForm series_form(const Options& options) { return {options.volume ? ".vti" : ".vtr", kSteps}; }

/// Returns the size of triangles; the default is that of the grid's cells, or 1/64 of the shortest side.
double interface_resolution(const Options& options) {
  if (options.resolution) return *options.resolution;
  const Vec3 size = options.box.size();
  if (!options.dimensions) return std::min({size.x, size.y, size.z}) / 64;
  const auto& cells = *options.dimensions;
  return std::min({size.x / static_cast<double>(cells[0]), size.y / static_cast<double>(cells[1]),
                   size.z / static_cast<double>(cells[2])});
}

SceneSampling scene_sampling(const Options& options) {
  SceneSampling sampling{options.name, options.seed, options.box, *options.dimensions, {}, {}};
  sampling.blur = {options.blur.value_or(0), options.noise.value_or(0)};
  sampling.volume = options.volume;
  return sampling;
}

/// Returns the figures of the materials' volumes.
Figures volume_figures(const std::vector<SceneMaterial>& materials) {
  Figures figures = Figures::array();
  for (const SceneMaterial& material : materials) {
    Figures figure{
        {"name", material.name}, {"volume", material.volume}, {"volume_error", material.volume_error}};
    if (material.sampled_volume) {
      figure["volume_sampled"] = *material.sampled_volume;
      figure["integration_error"] = *material.sampling_error;
    }
    figures.push_back(std::move(figure));
  }
  return figures;
}

void print_volumes(const std::vector<SceneMaterial>& materials, Console& console) {
  const bool sampled = materials.front().sampled_volume.has_value();
  std::vector<std::vector<std::string>> rows{{"material", "volume"}};
  if (sampled) rows[0].insert(rows[0].end(), {"on the grid", "integration error"});
  for (const SceneMaterial& material : materials) {
    rows.push_back({material.name, volume_text(material.volume)});
    if (sampled)
      rows.back().insert(rows.back().end(), {volume_text(*material.sampled_volume),
                                             fmt::format("{:.2g}", *material.sampling_error)});
  }
  console.table(rows);
}

/// Writes the data of the scene at each time of the series, and adds their facts to the figures.
void write_data(const Options& options, SeriesOutput& series, Session& session, Figures& figures) {
  const SceneSampling sampling = scene_sampling(options);
  const WrittenScene written = write_scene(sampling, series, session.outputs, session.console);
  const std::vector<SceneMaterial>& materials = written.states.back().materials;
  figures["dimensions"] = sampling.cells;
  figures["bytes"] = series.bytes();
  figures["materials"] = volume_figures(materials);
  if (series.is_series()) {
    Figures steps = Figures::array();
    for (const SceneState& state : written.states)
      steps.push_back({{"time", state.time}, {"materials", volume_figures(state.materials)}});
    figures["steps"] = steps.size();
    figures["series"] = std::move(steps);
  }
  if (sampling.volume) {
    figures["type"] = sample_name(*sampling.volume);
    figures["slope"] = written.slope, figures["intercept"] = written.intercept;
  } else {
    figures["blur"] = sampling.blur.blur, figures["noise"] = sampling.blur.noise;
  }
  const std::string_view what = sampling.volume ? "samples" : "cells";
  const std::string many = series.is_series() ? fmt::format(", {} steps", series.times().size()) : "";
  const auto& n = sampling.cells;
  session.console.print("Scene {} on {} x {} x {} {}{}, {}\n", options.name, n[0], n[1], n[2], what, many,
                        bytes_text(static_cast<double>(series.bytes())));
  print_volumes(materials, session.console);
}

/// Throws Error (kUsage) where options do not go together.
void check(const Options& options) {
  if (options.output.empty() && options.interfaces.empty())
    wrong_usage("expected -o or --interfaces, found neither");
  if (options.resolution && options.interfaces.empty())
    wrong_usage("--resolution: expected --interfaces as well");
  if (!options.output.empty() && !options.dimensions) wrong_usage("-o: expected --dimensions X,Y,Z as well");
  if (options.output.empty() && options.steps) wrong_usage("--steps: expected -o F.pvd as well");
  if (options.output.empty() && options.volume) wrong_usage("--volume: expected -o as well");
  for (const auto& [option, value] :
       {std::pair("--blur", options.blur), std::pair("--noise", options.noise)}) {
    if (!value) continue;
    if (options.output.empty()) wrong_usage("{}: expected -o as well", option);
    if (options.volume)
      wrong_usage("{}: expected volume fractions, found --volume {}", option, sample_name(*options.volume));
  }
}

SeriesOutput declare_output(const Options& options, OutputSet& outputs) {
  const bool moves = options.name == kMoving;
  if (!moves && file_extension(options.output) == ".pvd")
    wrong_usage("-o: expected the scene {} for a series, found {}", kMoving, options.name);
  std::vector<const char*> endings{".vti"};
  if (!options.volume) endings.insert(endings.begin(), ".vtr");
  if (moves) endings.push_back(".pvd");
  return {options.output, options.steps, 1, series_form(options), endings, outputs};
}

void run(const Options& options, Session& session) {
  check(options);
  const AnalyticScene scene(options.name, options.seed, {.box = options.box});
  std::optional<SeriesOutput> series;
  if (!options.output.empty()) series.emplace(declare_output(options, session.outputs));
  session.outputs.declare("--interfaces", options.interfaces,
                          {".vtp", ".ply", ".obj", ".off", ".stl", ".arec", ".txt"});
  Figures figures{{"dimensions", nullptr}, {"bytes", nullptr}, {"scene", scene.name()}};
  figures["seed"] = options.seed;
  figures["box"] = box_figures(scene.box());
  if (series) {
    write_data(options, *series, session, figures);
  } else {
    session.console.print("Scene {}\n", scene.name());
    const std::vector<SceneMaterial> materials = scene.materials();
    figures["materials"] = volume_figures(materials);
    print_volumes(materials, session.console);
  }
  if (!options.interfaces.empty()) {
    const InterfaceTriangles mesh = scene.interfaces(interface_resolution(options), session.console);
    session.outputs.write(options.interfaces, [&mesh](const auto& path) { write_mesh(path, mesh); });
    session.console.print("Interfaces: {} triangles\n", mesh.triangles.size());
    figures["triangles"] = mesh.triangles.size();
  }
  write_figures(figures, session);
  session.commit();
}

void add_sampling_options(const Command& command, Options& options) {
  command.add_value("--dimensions", "X,Y,Z", "Numbers of cells, or with --volume of samples",
                    options.dimensions, parse_dimensions);
  command.add_value("--seed", "N", "Which of the scenes of a kind (voronoi10, random)", options.seed,
                    parse_count_from_0);
  command.add_value("--box", "x0,x1,y0,y1,z0,z1", "Where the scene lies (default: the unit cube)",
                    options.box, parse_box);
  command.add_option("--interfaces", "FILE",
                     "Write the true interfaces too (.vtp, .ply, .obj, .off, .stl, .arec)",
                     options.interfaces);
  command.add_value("--resolution", "H", "Size of their triangles on curved interfaces (default: a cell)",
                    options.resolution, parse_positive);
  command.add_choice(
      "--volume", "Write samples of how far points are inside the bodies, as a volume, in place of fractions",
      options.volume, made_types());
  command.add_value(
      "--blur", "S",
      fmt::format("Convolve the fractions with a Gaussian of so many cells, up to {} (default 0)",
                  kGreatestBlur),
      options.blur, [](const std::string& option, const std::string& text) {
        return parse_up_to(option, text, kGreatestBlur);
      });
  command.add_value(
      "--noise", "P|P%",
      "Then add normal noise of this standard deviation to fractions of mixed cells: a part of 1, 0.02 or 2% "
      "(default 0)",
      options.noise,
      [](const std::string& option, const std::string& text) { return parse_part(option, text); });
}

}  // namespace

void add_generate_scene(const Command& generate, Session& session) {
  const auto [command, options] =
      add_command(generate, session, "scene", "Analytic materials with known volumes, and fields",
                  "adamas generate scene voronoi10 --dimensions 32,32,32 --seed 7 -o cells.vtr", run);
  command.add_option("name", "NAME", "The scene", options.name).required().one_of(scene_names());
  add_sampling_options(command, options);
  add_series_steps(
      command, options.steps,
      fmt::format("How many data sets a series of {} has, from its start to its end (default {})", kMoving,
                  kSteps));
  command.add_option("-o,--output", "FILE",
                     "The data: .vtr or .vti; of the scene moving the last, or a series: .pvd",
                     options.output);
}

}  // namespace adamas::cli
