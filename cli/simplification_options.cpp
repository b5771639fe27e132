#include "cli/simplification_options.h"

#include "cli/option_values.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

std::string angle_text(double degrees) { return fmt::format("{:.3g}", degrees); }

Figures distance_figures(const CertifiedDistance& distance) {
  return {
      {"certified", distance.certified}, {"found", distance.found}, {"place", place_figures(distance.place)}};
}

void note_shortfalls(const SimplificationReport& report, Console& console) {
  const auto note = [&](const char* what, const CertifiedDistance& distance) {
    if (distance.certified <= report.error_target) return;
    console.note_incomplete(
        "the error wanted of the simplified {} was not reached: {:.4g} instead of {:.4g}, at {}", what,
        distance.certified, report.error_target, place_text(distance.place));
  };
  note("interfaces", report.distances.interfaces);
  note("boundaries of materials", report.distances.per_material);
  if (report.distances.junctions) note("lines where three materials meet", *report.distances.junctions);
  if (report.changed_bodies > 0)
    console.note("{} bodies have other pieces or holes in the simplified interfaces", report.changed_bodies);
  if (report.contacts > 0)
    console.note("{} pairs of triangles touch or intersect, as they did before they were simplified",
                 report.contacts);
}

}  // namespace

void add_simplification_options(const Command& command, SimplifyOptions& options,
                                const std::string& of_what) {
  command.add_value("--simplify", "E|E%|Evoxels",
                    "Fewer triangles for " + of_what +
                        ", no point farther from them than this, nor the other way round: a length, in % of "
                        "the domain's diagonal, or in voxels of the input's grid",
                    options.error, parse_distance);
  command.add_flag("--smooth",
                   "With --simplify: moves points so that triangles become more alike, within the same error",
                   options.smooth);
}

void check_simplification(const SimplifyOptions& options) {
  if (options.smooth && !options.error) wrong_usage("--smooth: expected --simplify beside it, found none");
}

void print_simplification(const SimplificationReport& report, Console& console) {
  const InterfaceDistances& d = report.distances;
  const auto length = [](double x) { return fmt::format("{:.4g}", x); };
  std::vector<std::vector<std::string>> rows{
      {"simplified", "before", "after"},
      {"triangles", std::to_string(report.triangles_before), std::to_string(report.triangles)},
      {"smallest angle", angle_text(report.smallest_angle_before), angle_text(report.smallest_angle)},
      {"distance wanted", "", length(report.error_target)},
      {"distance certified", "", length(d.interfaces.certified)},
      {"distance found", "", length(d.interfaces.found)},
      {"distance per material certified", "", length(d.per_material.certified)}};
  if (d.junctions) rows.push_back({"distance of junctions certified", "", length(d.junctions->certified)});
  rows.push_back(
      {"seconds", "", fmt::format("{:.2f}, {:.2f} of processors", report.seconds, report.processor_seconds)});
  console.print("\n");
  console.table(rows);
  note_shortfalls(report, console);
}

Figures simplification_figures(const SimplificationReport& report) {
  const InterfaceDistances& d = report.distances;
  return {{"error_target", report.error_target},
          {"smooth", report.smooth},
          {"triangles_before", report.triangles_before},
          {"triangles", report.triangles},
          {"smallest_angle_before", report.smallest_angle_before},
          {"smallest_angle", report.smallest_angle},
          {"changed_bodies", report.changed_bodies},
          {"contacts", report.contacts},
          {"runs", report.runs},
          {"seconds", report.seconds},
          {"processor_seconds", report.processor_seconds},
          {"error", distance_figures(d.interfaces)},
          {"error_per_material", distance_figures(d.per_material)},
          {"junction_error", d.junctions ? distance_figures(*d.junctions) : Figures(nullptr)}};
}

}  // namespace adamas::cli
