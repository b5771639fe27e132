#include "cli/resampling_options.h"

#include <algorithm>
#include <optional>

#include "cli/option_values.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

/// Adds the options that switch conservation on and off.
void add_conservation_options(const Command& command, std::optional<bool>& conserve) {
  const auto take = [&conserve](bool on) {
    return [&conserve, on] {
      if (conserve && *conserve != on) wrong_usage("--conserve and --no-conserve: expected one of them");
      conserve = on;
    };
  };
  command.add_flag("--conserve",
                   "Move the interfaces, within the interface error, until every body has its volume in the "
                   "input; bodies that cannot are an error. Volume fractions are conserved without it, too, "
                   "as far as bodies can, where no --field-error is wanted",
                   take(true));
  command.add_flag("--no-conserve", "Leave interfaces of volume fractions where they are best", take(false));
}

}  // namespace

void add_resampling_options(const Command& command, ResampleOptions& options) {
  command.add_value("--interface-error", "E|E%|Evoxels",
                    "Greatest distance between the interfaces and their approximation: a length, in % of the "
                    "domain's diagonal, or in voxels of the input's grid (its least spacing)",
                    options.interface_error, parse_distance, options.interface_error.text());
  add_other_resampling_options(command, options);
}

void add_field_error_option(const Command& command,
                            std::vector<std::pair<std::string, ErrorTarget>>& errors) {
  command.add_converted_each(
      "--field-error", "NAME=E|E%", "Greatest error of a field, in its unit or in % of its range; repeatable",
      [&errors](const std::string& option, const std::string& text) {
        const auto [name, value] = parse_assignment(option, text, true);
        if (std::ranges::find(errors, name, &std::pair<std::string, ErrorTarget>::first) != errors.end())
          wrong_usage("{}: expected one error per field, found '{}' twice", option, name);
        errors.emplace_back(name, parse_error_target(option + " " + name, value));
      });
}

void add_other_resampling_options(const Command& command, ResampleOptions& options) {
  add_field_error_option(command, options.field_errors);
  command.add_value("--volume-error", "P%",
                    "Refine until every body has its volume in the input but for so much of it, besides the "
                    "interface error",
                    options.volume_error, parse_percentage);
  command.add_value("--max-tetrahedra", "N", "Stop at this size, whatever the errors", options.max_tetrahedra,
                    parse_count);
  command.add_choice<GhostMode>(
      "--ghost", "How a material's field goes on beyond the material, within a cell", options.ghost,
      {{"constant", GhostMode::kConstant},
       {"linear", GhostMode::kLinear},
       {"least-squares", GhostMode::kLeastSquares}},
      "constant");
  add_conservation_options(command, options.conserve);
  command.add_choice<DistanceMode>(
      "--distance",
      "What vertices measure: the distance to an interface, or to the nearest vertex of its mesh",
      options.distance, {{"exact", DistanceMode::kExact}, {"nearest-vertex", DistanceMode::kNearestVertex}},
      "exact");
}

}  // namespace adamas::cli
