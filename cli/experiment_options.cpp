#include "cli/experiment_options.h"

#include <filesystem>

#include "cli/option_values.h"
#include "cli/resampling_options.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

void add_generated_data(const Command& command, ExperimentArguments& arguments) {
  command
      .add_option("--generate", arguments.generate, "Make the input: a scene of adamas generate, or impact")
      .type_name("NAME")
      .one_of(generated_names());
  command
      .add_converted("--dimensions", "Numbers of cells of generated data",
                     [&arguments](const std::string& option, const std::string& text) {
                       arguments.dimensions = parse_dimensions(option, text);
                     })
      .type_name("X,Y,Z");
  command
      .add_converted("--seed", "Which of the scenes of a kind (voronoi10, random)",
                     [&arguments](const std::string& option, const std::string& text) {
                       arguments.seed = parse_count(option, text, 0);
                     })
      .type_name("N");
}

/// Adds the options of slices and tables.
void add_slices(const Command& command, ExperimentOptions& options) {
  command
      .add_option("--show", options.field,
                  "The field in slices and tables, or NAME:x for a component; without it, slices show the "
                  "materials")
      .type_name("NAME");
  command
      .add_converted_each("--plane", "A plane of a slice; repeatable",
                          [&options](const std::string& option, const std::string& text) {
                            options.planes.push_back(parse_plane_option(option, text));
                          })
      .type_name("x=N|y=N|z=N");
  command
      .add_converted("--detail", "A part of the first plane to show enlarged too",
                     [&options](const std::string& option, const std::string& text) {
                       const auto d = parse_numbers(option, text, 4);
                       options.detail = {d[0], d[1], d[2], d[3]};
                     })
      .type_name("a0,a1,b0,b1");
}

/// Adds the options of published figures, which are set beside those of the experiment.
void add_published(const Command& command, ExperimentOptions& options) {
  command.add_option("--published-by", options.published_by, "Where the published figures are from")
      .type_name("TEXT");
  command
      .add_converted_each(
          "--published",
          "A published figure to set beside: 'tetrahedra=5390', 'triangles A | B=38'; repeatable",
          [&options](const std::string& option, const std::string& text) {
            const auto [name, value] = parse_assignment(option, text, true);
            options.published.emplace_back(name, parse_positive(option + " " + name, value));
          })
      .type_name("NAME=X");
}

}  // namespace

void add_experiment_options(const Command& command, ExperimentArguments& arguments) {
  ExperimentOptions& options = arguments.experiment;
  command
      .add_option(
          "input", arguments.inputs,
          "What to resample: " + grid_files() +
              ". Or a series of data on one grid: a .pvd, several files, or a pattern of their names in "
              "quotes, as \"run_%04d.vti\"")
      .type_name("FILE...");
  add_generated_data(command, arguments);
  command.add_option("-o,--output", arguments.output, "A folder for all outputs")
      .required()
      .type_name("FOLDER");
  command.add_flag("--overwrite", arguments.overwrite, "Replace the folder of an earlier experiment");
  command.add_option("--title", options.title, "The heading of the report").type_name("TEXT");
  add_slices(command, options);
  command
      .add_converted_each(
          "--curve",
          "An interface error of the curve of error against tetrahedra; repeatable (default: 8, 4, 2 "
          "and 1 times --interface-error)",
          [&options](const std::string& option, const std::string& text) {
            options.curve.push_back(parse_error_target(option, text, true));
          })
      .type_name("E|E%|Evoxels");
  command
      .add_option("--density", options.density,
                  "The field whose integral is mass in the ledger (default: one named density)")
      .type_name("NAME");
  add_published(command, options);
  add_film_options(command, arguments.film);
  add_surface_picture_options(command, arguments.pictures, false);
  add_resampling_options(command, options.resampling);
  add_material_options(command, arguments.input);
  add_reconstruction_options(command, arguments.input);
}

ExperimentOptions to_experiment_options(ExperimentArguments& arguments) {
  ExperimentOptions result = arguments.experiment;
  InputArguments& input = arguments.input;
  result.steps = series_steps(arguments.inputs);
  if (!arguments.inputs.empty()) {
    input.path = result.steps.empty() ? arguments.inputs.front() : result.steps.back().file;
    result.series_name = std::filesystem::path(arguments.inputs.front()).filename().string();
  }
  if (arguments.generate.empty() == with_main_file(input).path.empty())
    wrong_usage("expected an INPUT or --generate, found {}", arguments.generate.empty() ? "neither" : "both");
  if (arguments.generate.empty()) {
    if (arguments.dimensions) wrong_usage("--dimensions: expected --generate as well");
    if (arguments.seed) wrong_usage("--seed: expected --generate as well");
  } else {
    result.generate = GeneratedData{arguments.generate, arguments.dimensions, arguments.seed};
  }
  result.input = to_input_options(input);
  result.resampling.smooth_labels = input.smooth_labels;
  result.resampling.fractions = fraction_options(input);
  result.fraction_option = fraction_option(input);
  result.drawing = arguments.pictures.drawing;
  result.film = arguments.film.to_library();
  return result;
}

}  // namespace adamas::cli
