#include "cli/resampling_options.h"

#include <algorithm>

#include "cli/option_values.h"
#include "cli/usage.h"

namespace adamas::cli {

void add_resampling_options(const Command& command, ResampleOptions& options) {
  command
      .add_converted(
          "--interface-error",
          "Greatest distance between the interfaces and their approximation: a length, in % of the "
          "domain's diagonal, or in voxels of the input's grid (its least spacing)",
          [&options](const std::string& option, const std::string& text) {
            options.interface_error = parse_error_target(option, text, true);
          },
          options.interface_error.text())
      .type_name("E|E%|Evoxels")
      .show_default();
  add_other_resampling_options(command, options);
}

void add_field_error_option(const Command& command,
                            std::vector<std::pair<std::string, ErrorTarget>>& errors) {
  command
      .add_converted_each(
          "--field-error", "Greatest error of a field, in its unit or in % of its range; repeatable",
          [&errors](const std::string& option, const std::string& text) {
            const auto [name, value] = parse_assignment(option, text, true);
            if (std::ranges::find(errors, name, &std::pair<std::string, ErrorTarget>::first) != errors.end())
              wrong_usage("{}: expected one error per field, found '{}' twice", option, name);
            errors.emplace_back(name, parse_error_target(option + " " + name, value));
          })
      .type_name("NAME=E|E%");
}

void add_other_resampling_options(const Command& command, ResampleOptions& options) {
  add_field_error_option(command, options.field_errors);
  command
      .add_converted("--volume-error",
                     "Refine until every body has its volume in the input but for so much of it, besides the "
                     "interface error",
                     [&options](const std::string& option, const std::string& text) {
                       options.volume_error = parse_percentage(option, text);
                     })
      .type_name("P%");
  command
      .add_converted("--max-tetrahedra", "Stop at this size, whatever the errors",
                     [&options](const std::string& option, const std::string& text) {
                       options.max_tetrahedra = parse_count(option, text);
                     })
      .type_name("N");
  command
      .add_converted(
          "--ghost", "How a material's field goes on beyond the material, within a cell",
          [&options](const std::string&, const std::string& text) {
            options.ghost = text == "linear"          ? GhostMode::kLinear
                            : text == "least-squares" ? GhostMode::kLeastSquares
                                                      : GhostMode::kConstant;
          },
          "constant")
      .one_of({"constant", "linear", "least-squares"})
      .show_default();
  command.add_flag(
      "--conserve", options.conserve,
      "Move the interfaces, within the interface error, until every body has its volume in the input");
  command
      .add_converted(
          "--distance",
          "What vertices measure: the distance to an interface, or to the nearest vertex of its mesh",
          [&options](const std::string&, const std::string& text) {
            options.distance = text == "exact" ? DistanceMode::kExact : DistanceMode::kNearestVertex;
          },
          "exact")
      .one_of({"exact", "nearest-vertex"})
      .show_default();
}

}  // namespace adamas::cli
