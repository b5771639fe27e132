#include "cli/simplification_options.h"

#include <nlohmann/json.hpp>

#include "adamas/text.h"
#include "cli/network_figures.h"
#include "cli/resampling_options.h"
#include "cli/usage.h"

namespace adamas::cli {

using namespace interfaces;

namespace {

std::string angle_text(double degrees) { return fmt::format("{:.3g}", degrees); }

void add_distance(const char* name, const InterfaceDistance& distance, Figures& figures) {
  const auto& [x, y, z] = distance.worst;
  figures[name] = {{"certified", distance.upper}, {"found", distance.lower}, {"place", {x, y, z}}};
}

Figures simplification_figures(const SimplifiedInterfaces& found, const SimplificationOptions& options,
                               double seconds) {
  Figures figures{{"error_target", options.error},
                  {"smooth", options.smooth},
                  {"triangles_before", found.triangles_before},
                  {"triangles", found.mesh.triangles.size()},
                  {"smallest_angle_before", found.smallest_angle_before},
                  {"smallest_angle", found.smallest_angle},
                  {"changed_bodies", found.changed_bodies},
                  {"contacts", found.contacts},
                  {"runs", found.runs},
                  {"seconds", seconds}};
  add_distance("error", found.certificate.networks, figures);
  add_distance("error_per_material", found.certificate.materials, figures);
  figures["junction_error"] = nullptr;
  if (found.certificate.junctions) add_distance("junction_error", *found.certificate.junctions, figures);
  return figures;
}

void print_simplification(const SimplifiedInterfaces& found, const SimplificationOptions& options,
                          double seconds, Console& console) {
  const InterfaceCertificate& c = found.certificate;
  const auto length = [](double x) { return fmt::format("{:.4g}", x); };
  std::vector<std::vector<std::string>> rows{
      {"simplified", "before", "after"},
      {"triangles", std::to_string(found.triangles_before), std::to_string(found.mesh.triangles.size())},
      {"smallest angle", angle_text(found.smallest_angle_before), angle_text(found.smallest_angle)},
      {"distance wanted", "", length(options.error)},
      {"distance certified", "", length(c.networks.upper)},
      {"distance found", "", length(c.networks.lower)},
      {"distance per material certified", "", length(c.materials.upper)}};
  if (c.junctions) rows.push_back({"distance of junctions certified", "", length(c.junctions->upper)});
  rows.push_back({"seconds", "", fmt::format("{:.2f}", seconds)});
  console.print("\n");
  console.table(rows);
}

void note_shortfalls(const SimplifiedInterfaces& found, const SimplificationOptions& options,
                     Console& console) {
  const auto note = [&](const char* what, const InterfaceDistance& distance) {
    if (distance.upper <= options.error) return;
    console.note_incomplete(
        "the error wanted of the simplified {} was not reached: {:.4g} instead of {:.4g}, at {}", what,
        distance.upper, options.error, place_text(distance.worst));
  };
  note("interfaces", found.certificate.networks);
  note("boundaries of materials", found.certificate.materials);
  if (found.certificate.junctions) note("lines where three materials meet", *found.certificate.junctions);
  if (found.changed_bodies > 0)
    console.note("{} bodies have other pieces or holes in the simplified interfaces", found.changed_bodies);
  if (found.contacts > 0)
    console.note("{} pairs of triangles touch or intersect, as they did before they were simplified",
                 found.contacts);
}

}  // namespace

void add_simplification_options(const Command& command, SimplifyOptions& options,
                                const std::string& of_what) {
  command
      .add_converted("--simplify",
                     "Fewer triangles for " + of_what +
                         ", no point farther from them than this, nor the other way round: a length, in % of "
                         "the domain's diagonal, or in voxels of the input's grid",
                     [&options](const std::string& option, const std::string& text) {
                       options.error = parse_error_target(option, text, true);
                     })
      .type_name("E|E%|Evoxels");
  command.add_flag(
      "--smooth", options.smooth,
      "With --simplify: moves points so that triangles become more alike, within the same error");
}

void SimplifyOptions::check() const {
  if (smooth && !error) wrong_usage("--smooth: expected --simplify beside it, found none");
}

void SimplifyOptions::check(const InputFacts& input) const {
  if (error) static_cast<void>(interface_error_of("--simplify", *error, input));
}

SimplifiedInterfaces simplify_and_print(const ResamplingSource& source, const SimplifyOptions& wanted,
                                        Figures& figures, Console& console) {
  SimplificationOptions options;
  options.error = interface_error_of("--simplify", *wanted.error, facts_of(source));
  options.smooth = wanted.smooth;
  const double start = console.seconds();
  SimplifiedInterfaces found = simplify_interfaces(source, options, console);
  const double seconds = console.seconds() - start;
  print_simplification(found, options, seconds, console);
  note_shortfalls(found, options, console);
  figures["simplification"] = simplification_figures(found, options, seconds);
  return found;
}

}  // namespace adamas::cli
