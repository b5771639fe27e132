#include "workflow/experiments/experiment_request.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string_view>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/picture/film.h"
#include "core/picture/vec2.h"
#include "interfaces/api/resample_options.h"
#include "interfaces/cross_section/cross_section.h"
#include "interfaces/cross_section/field_choice.h"
#include "workflow/series/balance.h"
#include "workflow/series/series_film.h"

namespace adamas {

using namespace interfaces;
using namespace workflow;

namespace {

/// The default interface errors of the curve, relative to the target.
constexpr std::array kCurve{8.0, 4.0, 2.0, 1.0};
constexpr std::array kPublishable{"interface tetrahedra", "tetrahedra", "tetrahedra with fields",
                                  "greatest field error at interfaces", "mean field error at interfaces"};
constexpr std::string_view kTriangles = "triangles ";

void check_published(const std::string& name) {
  const bool known = std::find(kPublishable.begin(), kPublishable.end(), name) != kPublishable.end() ||
                     name.starts_with(kTriangles);
  if (known) return;
  std::string names;
  for (const char* each : kPublishable) names += std::string("'") + each + "', ";
  wrong_usage("--published: expected one of {}'triangles A | B', found '{}'", names, name);
}

/// Throws Error where a film is asked for that cannot be made.
void check_experiment_film(const ExperimentOptions& options) {
  check_film(series_options(options).film);
  const std::filesystem::path& file = options.film.file;
  if (!file.empty() && file.has_parent_path())
    wrong_usage("--film: expected the name of a file in the folder of the experiment, found '{}'",
                file.string());
}

void check_detail(const ExperimentOptions& options) {
  if (!options.detail) return;
  if (options.planes.empty()) wrong_usage("--detail: expected --plane as well");
  const auto& [a0, a1, b0, b1] = *options.detail;
  if (picture::Box2{{a0, b0}, {a1, b1}}.empty())
    wrong_usage("--detail: expected a0 < a1 and b0 < b1 in a0,a1,b0,b1, found '{},{},{},{}'", a0, a1, b0, b1);
}

}  // namespace

void ExperimentOptions::check() const {
  if (generate.has_value() == !with_main_file(input).path.empty())
    wrong_usage("expected an INPUT or --generate, found {}", generate ? "both" : "neither");
  if (generate) generate->check();
  if (!field.empty() && planes.empty()) wrong_usage("--show: expected --plane as well");
  check_surface_drawing(drawing);
  check_experiment_film(*this);
  check_detail(*this);
  if (published.empty() != published_by.empty())
    wrong_usage("expected --published and --published-by together");
  for (const auto& [name, value] : published) check_published(name);
  if (steps.empty() && !film.file.empty()) wrong_usage("--film: expected a series (a .pvd or several files)");
}

namespace workflow {

void check_experiment(const ExperimentOptions& options, const InputFacts& input) {
  check_options(options.resampling, input);
  for (const ErrorTarget& error : options.curve)
    static_cast<void>(interface_error_of("--curve", error, input));
  for (const Plane& plane : options.planes) {
    if (clip_plane(plane, input.box).empty())
      fail("{}: --plane: expected one that cuts {}, found {}", input.name, box_text(input.box),
           to_string(plane));
  }
  if (!options.field.empty()) find_field(input.fields, options.field, input.name);
  static_cast<void>(density_field(options.density, input.fields, input.name));
}

std::vector<double> curve_errors(const ExperimentOptions& options, const InputFacts& input, double target) {
  std::vector<double> result{target};
  for (const ErrorTarget& error : options.curve)
    result.push_back(interface_error_of("--curve", error, input));
  if (options.curve.empty()) {
    for (const double factor : kCurve) {
      if (factor * target < input.box.diagonal()) result.push_back(factor * target);
    }
  }
  std::sort(result.begin(), result.end(), std::greater<>());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

ResampleSeriesOptions series_options(const ExperimentOptions& options) {
  ResampleSeriesOptions result;
  result.input = options.input;
  result.resampling = options.resampling;
  result.name = options.series_name;
  result.density = options.density;
  result.film = options.film;
  if (options.film.file.empty()) return result;
  if (!options.planes.empty()) result.film.plane = options.planes.front();
  result.film.field = options.field;
  return result;
}

}  // namespace workflow

}  // namespace adamas
