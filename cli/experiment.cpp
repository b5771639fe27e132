#include "adamas/experiment.h"

#include <filesystem>

#include "adamas/output_folder.h"
#include "adamas/report_text.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/option_values.h"
#include "cli/picture_options.h"
#include "cli/resample_figures.h"
#include "cli/resampling_options.h"
#include "cli/series_figures.h"
#include "cli/series_options.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

struct Options {
  std::vector<std::string> inputs;  ///< one file, or the steps of a series
  GeneratedData generated;          ///< without a name: no data are generated
  PictureOptions pictures;
  ExperimentOptions experiment;  ///< all other options
  std::string output;
  bool overwrite = false;
};

/// The options as the library takes them; names the input. Throws Error (kUsage) for options without effect.
ExperimentOptions to_experiment_options(const Options& options) {
  ExperimentOptions result = options.experiment;
  const GeneratedData& generated = options.generated;
  result.steps = series_steps(options.inputs);
  if (!options.inputs.empty()) {
    result.input.path = result.steps.empty() ? options.inputs.front() : result.steps.back().file;
    result.series_name = std::filesystem::path(options.inputs.front()).filename().string();
  }
  if (!generated.name.empty()) result.generate = generated;
  result.drawing = options.pictures.drawing;
  result.check();
  if (!result.generate && (generated.cells || generated.seed))
    wrong_usage("{}: expected --generate as well", generated.cells ? "--dimensions" : "--seed");
  return result;
}

Figures run_figures(const ExperimentRun& run) {
  Figures figures = resample_json(run.report);
  figures["seconds"] = run.seconds;
  figures["processor_seconds"] = run.processor_seconds;
  return figures;
}

Figures experiment_figures(const ExperimentRecord& record) {
  Figures figures;
  figures["title"] = record.title;
  figures["input"] = record.input;
  figures["interfaces"] = Figures::array();
  for (const auto& [pair, count] : record.triangles)
    figures["interfaces"].push_back({{"between", pair}, {"triangles", count}});
  figures["interface_mesh"] = run_figures(record.interfaces);
  figures["mesh"] = run_figures(record.last());
  figures["nested_errors"] = Figures::object();
  for (std::size_t f = 0; f < record.fields.size(); ++f) {
    const NestedFieldErrors& nested = record.last().nested[f];
    figures["nested_errors"][record.fields[f].name] = {{"tetrahedra", nested.tetrahedra},
                                                       {"greatest", nested.greatest},
                                                       {"mean", nested.mean},
                                                       {"corrected_greatest", nested.corrected_greatest},
                                                       {"corrected_mean", nested.corrected_mean},
                                                       {"undefined", nested.undefined}};
  }
  figures["curve"] = Figures::array();
  for (const ExperimentRun& run : record.curve) figures["curve"].push_back(run_figures(run));
  figures["published"] = Figures::array();
  for (const PublishedFigure& figure : record.published)
    figures["published"].push_back(
        {{"name", figure.name}, {"published", figure.published}, {"here", figure.here}});
  figures["ledger"] = Figures::array();
  for (const MaterialBalance& row : record.balance) {
    Figures entry{
        {"material", row.material}, {"volume_input", row.volume_input}, {"volume_mesh", row.volume_mesh}};
    if (!record.density.empty()) {
      entry["mass_input"] = row.mass_input;
      entry["mass_mesh"] = row.mass_mesh;
    }
    figures["ledger"].push_back(std::move(entry));
  }
  figures["steps"] = record.series ? series_figures(*record.series) : Figures(nullptr);
  if (record.series) figures["damaged_steps"] = damaged_steps(record.series->left_out);
  return figures;
}

void print_record(const ExperimentRecord& record, const std::string& folder, Console& console) {
  std::vector<std::vector<std::string>> rows{
      {"mesh", "tetrahedra", "with interfaces", "interface error", "seconds"}};
  const auto add = [&](const std::string& name, const ExperimentRun& run) {
    rows.push_back(
        {name, std::to_string(run.report.tetrahedra), std::to_string(run.report.interface_tetrahedra),
         run.report.interface_error ? fmt::format("{:.4g}", run.report.interface_error->certified) : "-",
         fmt::format("{:.2f}", run.seconds)});
  };
  add("interfaces", record.interfaces);
  if (record.with_fields) add("with fields", *record.with_fields);
  console.table(rows);
  // Errors of the steps of a series, of which the input is one, were noted as the meshes were made.
  for (const auto& [mesh, run] : record.wanted_runs()) {
    const bool was_noted = record.series && (run == &record.interfaces || run == &record.last());
    if (was_noted) continue;
    for (const std::string& line : unreached_lines(run->report, console.verbose))
      console.note_incomplete("{}: {}", mesh, line);
  }
  if (record.series) {
    console.print("\n");
    print_series(*record.series, console);
  }
  if (!record.published.empty()) {
    rows = {{"", record.published_by, "here"}};
    for (const PublishedFigure& figure : record.published)
      rows.push_back(
          {figure.name, fmt::format("{:.6g}", figure.published), fmt::format("{:.6g}", figure.here)});
    console.print("\n");
    console.table(rows);
  }
  // Two curves of error against tetrahedra are in the folder besides these pictures.
  const std::size_t pictures = record.input_pictures.size() + record.mesh_pictures.size() +
                               record.slices.size() + record.series_pictures.size() + 2;
  console.print("\n  {}: report.html, metrics.json and {} pictures\n", folder, pictures);
}

void run(const Options& given, Session& session) {
  const ExperimentOptions options = to_experiment_options(given);
  Console& console = session.console;
  for (const SeriesEntry& step : options.steps) session.outputs.protect(step.file);
  protect_inputs(options.input, with_main_file(options.input).path, session.outputs);
  session.outputs.protect_other(given.output);
  session.outputs.check_outside("-o", given.output);
  OutputFolder folder("an experiment", given.output, given.overwrite);
  const ExperimentRecord record = run_experiment(options, folder, console);
  Figures figures = experiment_figures(record);
  add_costs(figures, console);
  folder.fill([&] { write_figures(folder.file("metrics.json"), figures); });
  write_figures(figures, session);
  console.check();
  print_record(record, given.output, console);
  print_costs(console);
  console.flush();
  folder.commit();
  session.commit();
  if (record.series) note_left_out(record.series->left_out, console);
}

void add_generated_data(const Command& command, GeneratedData& generated) {
  command
      .add_option("--generate", "NAME", "Make the input: a scene of adamas generate, or impact",
                  generated.name)
      .one_of(generated_names());
  command.add_value("--dimensions", "X,Y,Z", "Numbers of cells of generated data", generated.cells,
                    parse_dimensions);
  command.add_value("--seed", "N", "Which of the scenes of a kind (voronoi10, random)", generated.seed,
                    parse_count_from_0);
}

std::array<double, 4> parse_detail(const std::string& option, const std::string& text) {
  const auto d = parse_numbers(option, text, 4);
  return {d[0], d[1], d[2], d[3]};
}

/// Adds the options of slices and tables.
void add_slices(const Command& command, ExperimentOptions& options) {
  command.add_option("--show", "NAME",
                     "The field in slices and tables, or NAME:x for a component; without it, slices show the "
                     "materials",
                     options.field);
  command.add_values("--plane", "x=N|y=N|z=N", "A plane of a slice; repeatable", options.planes,
                     parse_plane_option);
  command.add_value("--detail", "a0,a1,b0,b1", "A part of the first plane to show enlarged too",
                    options.detail, parse_detail);
}

std::pair<std::string, double> parse_published(const std::string& option, const std::string& text) {
  const auto [name, value] = parse_assignment(option, text, true);
  return {name, parse_positive(option + " " + name, value)};
}

/// Adds the options of figures that are set beside those of the experiment.
void add_published(const Command& command, ExperimentOptions& options) {
  command.add_option("--published-by", "TEXT", "Where the published figures are from", options.published_by);
  command.add_values("--published", "NAME=X",
                     "A published figure to set beside: 'tetrahedra=5390', 'triangles A | B=38'; repeatable",
                     options.published, parse_published);
}

}  // namespace

void add_experiment(const Command& app, Session& session) {
  const auto [command, options] = add_command(
      app, session, "experiment", "A resampling experiment from one file, with pictures and a report",
      "adamas experiment -c datasets/impact.toml -o impact\n"
      "  adamas experiment run.pvd --plane z=0 --film film.mp4 -o run",
      run);
  ExperimentOptions& experiment = options.experiment;
  command.add_option("input", "FILE...",
                     "What to resample: " + grid_files() +
                         ". Or a series of data on one grid: a .pvd, several files, or a pattern of their "
                         "names in quotes, as \"run_%04d.vti\"",
                     options.inputs);
  add_generated_data(command, options.generated);
  command.add_option("-o,--output", "FOLDER", "A folder for all outputs", options.output).required();
  command.add_flag("--overwrite", "Replace the folder of an earlier experiment", options.overwrite);
  command.add_option("--title", "TEXT", "The heading of the report", experiment.title);
  add_slices(command, experiment);
  command.add_values(
      "--curve", "E|E%|Evoxels",
      "An interface error of the curve of error against tetrahedra; repeatable (default: 8, 4, "
      "2 and 1 times --interface-error)",
      experiment.curve, parse_distance);
  command.add_option("--density", "NAME",
                     "The field whose integral is mass in the ledger (default: one named density)",
                     experiment.density);
  add_published(command, experiment);
  add_film_options(command, experiment.film.file, experiment.film.frames_per_second);
  add_surface_picture_options(command, options.pictures, false);
  add_resampling_options(command, experiment.resampling);
  add_material_options(command, experiment.input);
  add_reconstruction_options(command, experiment.resampling.smooth_labels, experiment.resampling.fractions);
}

}  // namespace adamas::cli
