#include "cli/experiment_options.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>

#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/usage.h"
#include "interfaces/cross_section/cross_section.h"
#include "interfaces/library/resample_options.h"

namespace adamas::cli {

using namespace interfaces;
using namespace picture;

namespace {

/// The default interface errors of the curve, in relation to the target.
constexpr std::array kCurve{8.0, 4.0, 2.0, 1.0};
constexpr std::array kPublishable{"interface tetrahedra", "tetrahedra", "tetrahedra with fields",
                                  "greatest field error at interfaces", "mean field error at interfaces"};
constexpr std::string_view kTriangles = "triangles ";

std::pair<std::string, double> parse_published(const std::string& text) {
  const auto [name, value] = parse_assignment("--published", text, true);
  const bool known = std::find(kPublishable.begin(), kPublishable.end(), name) != kPublishable.end() ||
                     name.starts_with(kTriangles);
  if (!known) {
    std::string names;
    for (const char* each : kPublishable) names += std::string("'") + each + "', ";
    wrong_usage("--published: expected one of {}'triangles A | B', found '{}'", names, name);
  }
  return {name, parse_positive("--published " + name, value)};
}

/// Throws Error (kUsage) where a film is asked for that cannot be made.
void check_film(const ExperimentOptions& options) {
  SeriesFilmText film = options.film;
  if (!options.planes.empty()) film.plane = options.planes.front();
  film.check();
  if (!film.file.empty() && std::filesystem::path(film.file).has_parent_path())
    wrong_usage("--film: expected the name of a file in the folder of the experiment, found '{}'", film.file);
}

}  // namespace

void add_experiment_options(const Command& command, ExperimentOptions& options) {
  command
      .add_option(
          "input", options.inputs,
          "What to resample: " + grid_files() +
              ". Or a series of data on one grid: a .pvd, several files, or a pattern of their names in "
              "quotes, as \"run_%04d.vti\"")
      .type_name("FILE...");
  command.add_option("--generate", options.generate, "Make the input: a scene of adamas generate, or impact")
      .type_name("NAME")
      .one_of(generated_names());
  command.add_option("--dimensions", options.dimensions, "Numbers of cells of generated data")
      .type_name("X,Y,Z");
  command.add_option("--seed", options.seed, "Which of the scenes of a kind (voronoi10, random)")
      .type_name("N");
  command.add_option("-o,--output", options.output, "A folder for all outputs")
      .required()
      .type_name("FOLDER");
  command.add_flag("--overwrite", options.overwrite, "Replace the folder of an earlier experiment");
  command.add_option("--title", options.title, "The heading of the report").type_name("TEXT");
  command
      .add_option("--show", options.show,
                  "The field in slices and tables, or NAME:x for a component; without it, slices show the "
                  "materials")
      .type_name("NAME");
  command.add_option("--plane", options.planes, "A plane of a slice; repeatable")
      .type_name("x=N|y=N|z=N")
      .one_value_each();
  command.add_option("--detail", options.detail, "A part of the first plane to show enlarged too")
      .type_name("a0,a1,b0,b1");
  command
      .add_option("--curve", options.curve,
                  "An interface error of the curve of error against tetrahedra; repeatable (default: 8, 4, 2 "
                  "and 1 times --interface-error)")
      .type_name("E|E%|Evoxels")
      .one_value_each();
  command
      .add_option("--density", options.density,
                  "The field whose integral is mass in the ledger (default: one named density)")
      .type_name("NAME");
  command.add_option("--published-by", options.published_by, "Where the published figures are from")
      .type_name("TEXT");
  command
      .add_option("--published", options.published,
                  "A published figure to set beside: 'tetrahedra=5390', 'triangles A | B=38'; repeatable")
      .type_name("NAME=X")
      .one_value_each();
  add_film_options(command, options.film);
  add_surface_picture_options(command, options.pictures, false);
  add_resampling_options(command, options.resampling);
  add_material_options(command, options.input);
  add_reconstruction_options(command, options.input);
}

ExperimentRequest::ExperimentRequest(const ExperimentOptions& options)
    : resampling(options.resampling), show(options.show), density_name(options.density) {
  if (options.generate.empty() == with_main_file(options.input).path.empty())
    wrong_usage("expected an INPUT or --generate, found {}", options.generate.empty() ? "neither" : "both");
  if (options.generate.empty()) {
    if (!options.dimensions.empty()) wrong_usage("--dimensions: expected --generate as well");
    if (!options.seed.empty()) wrong_usage("--seed: expected --generate as well");
  } else {
    data.name = options.generate;
    if (!options.dimensions.empty()) data.cells = parse_dimensions("--dimensions", options.dimensions);
    if (!options.seed.empty()) data.seed = parse_count("--seed", options.seed, 0);
    data.check();
  }
  if (!show.empty() && options.planes.empty()) wrong_usage("--show: expected --plane as well");
  options.pictures.check();
  for (const std::string& text : options.planes) planes.push_back(parse_plane_option("--plane", text));
  check_film(options);
  if (!options.detail.empty()) {
    if (planes.empty()) wrong_usage("--detail: expected --plane as well");
    const auto d = parse_numbers("--detail", options.detail, 4);
    detail = Box2{{d[0], d[2]}, {d[1], d[3]}};
    if (detail->empty())
      wrong_usage("--detail: expected a0 < a1 and b0 < b1 in a0,a1,b0,b1, found '{}'", options.detail);
  }
  for (const std::string& text : options.curve) errors.push_back(parse_error_target("--curve", text, true));
  if (options.published.empty() != options.published_by.empty())
    wrong_usage("expected --published and --published-by together");
  for (const std::string& text : options.published) published.push_back(parse_published(text));
}

void ExperimentRequest::check(const InputFacts& input) const {
  check_options(resampling, input);
  for (const ErrorTarget& error : errors) static_cast<void>(interface_error_of("--curve", error, input));
  for (const Plane& plane : planes) {
    if (clip_plane(plane, input.box).empty())
      fail("{}: --plane: expected one that cuts {}, found {}", input.name, box_text(input.box),
           to_string(plane));
  }
  if (!show.empty()) find_field(input.fields, show, input.name);
  static_cast<void>(density(input.fields, input.name));
}

std::vector<double> ExperimentRequest::curve(const InputFacts& input, double target) const {
  std::vector<double> result{target};
  for (const ErrorTarget& error : errors) result.push_back(interface_error_of("--curve", error, input));
  if (errors.empty()) {
    for (const double factor : kCurve) {
      if (factor * target < input.box.diagonal()) result.push_back(factor * target);
    }
  }
  std::sort(result.begin(), result.end(), std::greater<>());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::string ExperimentRequest::density(const std::vector<FieldInfo>& fields,
                                       const std::string& source) const {
  return density_field(density_name, fields, source);
}

}  // namespace adamas::cli
