#include "cli/resample_report.h"

#include <algorithm>
#include <cmath>

#include "adamas/report_text.h"
#include "adamas/text.h"
#include "cli/figures.h"
#include "cli/fraction_report.h"
#include "cli/resample_figures.h"

namespace adamas::cli {

namespace {

/// Names the body with the greatest volume error. A mesh may lose none of many bodies and still show each far
/// too small.
void print_worst_body(const ResampleReport& report, Console& console) {
  if (!report.worst_volume) return;
  const ResampleReport::Body& body = report.bodies[*report.worst_volume];
  const double whole = *body.volume_input;
  console.print("  worst body volume: {:.4g}% of {}, a body of '{}' at {}\n",
                whole > 0 ? 100 * body.volume_mesh / whole : 0.0, volume_text(whole),
                report.materials[body.material].name, place_text(body.place));
}

void print_mesh(const ResampleReport& report, Console& console) {
  std::vector<std::vector<std::string>> rows{
      {"tetrahedra", std::to_string(report.tetrahedra)},
      {"vertices", std::to_string(report.vertices)},
      {"interface tetrahedra", std::to_string(report.interface_tetrahedra)},
      {"interface error wanted", fmt::format("{:.4g}", report.interface_error_target)}};
  const auto add_distance = [&](const std::string& name, const std::optional<MeasuredDistance>& d) {
    if (!d) return;
    rows.push_back({name + " certified", length_text(d->certified)});
    rows.push_back({name + " found", length_text(d->found)});
  };
  add_distance("interface error", report.interface_error);
  // With two materials, the boundary of each consists of all interfaces.
  if (report.materials.size() > 2)
    add_distance("interface error per material", report.interface_error_per_material);
  add_distance("junction error", report.junction_error);
  if (report.volume_error_target)
    rows.push_back(
        {"volume error of bodies wanted", fmt::format("{:.4g}%", 100 * *report.volume_error_target)});
  if (report.worst_volume)
    rows.push_back({"greatest volume error of a body",
                    fmt::format("{:.4g}%", 100 * report.bodies[*report.worst_volume].volume_error())});
  rows.push_back({"lost interfaces", std::to_string(report.lost_interfaces)});
  const auto count = [&](bool ResampleReport::Body::*what) {
    return std::to_string(std::ranges::count_if(report.bodies, what));
  };
  rows.push_back({"bodies, lost, torn", std::to_string(report.bodies.size()) + ", " +
                                            count(&ResampleReport::Body::lost) + ", " +
                                            count(&ResampleReport::Body::changed)});
  rows.push_back({"contacts the input has not", std::to_string(report.contacts.size())});
  if (report.flagged_vertices > 0)
    rows.push_back({"vertices of doubtful material", std::to_string(report.flagged_vertices)});
  console.table(rows);
  print_worst_body(report, console);
}

/// Prints the numbers of elements of each kind over which the errors are taken; once where they are the same
/// for all fields.
void print_elements(const ResampleReport& report, Console& console) {
  std::vector<std::string> texts;
  for (const ResampleReport::Field& field : report.fields)
    texts.push_back(fmt::format("{} pure, {} mixed, {} minority; {} of them displaced; {} without a value",
                                field.pure, field.mixed, field.minority, field.displaced,
                                field.without_value));
  if (std::ranges::all_of(texts, [&](const std::string& text) { return text == texts[0]; })) {
    console.print("  elements: {}\n", texts[0]);
    return;
  }
  for (std::size_t f = 0; f < texts.size(); ++f)
    console.print("  elements of {}: {}\n", report.fields[f].name, texts[f]);
}

void print_fields(const ResampleReport& report, Console& console) {
  if (report.fields.empty()) return;
  const auto text = [](double value) {
    return std::isnan(value) ? std::string("-") : fmt::format("{:.4g}", value);
  };
  std::vector<std::vector<std::string>> rows{
      {"field error", "wanted", "greatest", "mean", "at interfaces", "mean there"}};
  for (const ResampleReport::Field& field : report.fields)
    rows.push_back({field.unit.empty() ? field.name : field.name + " [" + field.unit + "]",
                    field.target ? fmt::format("{:.4g}", *field.target) : "-",
                    text(field.everywhere.max_error), text(field.everywhere.mean_error),
                    text(field.at_interfaces.max_error), text(field.at_interfaces.mean_error)});
  console.print("\n");
  console.table(rows);
  print_elements(report, console);
}

void print_materials(const ResampleReport& report, Console& console) {
  constexpr std::size_t kMost = 40;
  const bool stated = !report.materials.empty() && report.materials.front().volume_input;
  std::vector<std::vector<std::string>> rows{{"material", "volume", "mesh", "difference"}};
  if (!stated) rows[0] = {"material", "volume in the mesh"};
  for (std::size_t m = 0; m < std::min(report.materials.size(), kMost); ++m) {
    const auto& [name, volume_input, found, lost] = report.materials[m];
    if (stated) {
      rows.push_back(
          {name, volume_text(*volume_input), volume_text(found), difference_text(*volume_input, found)});
    } else {
      rows.push_back({name, volume_text(found)});
    }
  }
  console.print("\n");
  console.table(rows);
  if (report.materials.size() > kMost) console.print("  ... and {} more\n", report.materials.size() - kMost);
}

}  // namespace

void print_resampled(const ResampleReport& report, Console& console) {
  if (report.fractions) print_findings(*report.fractions, material_names(report), report.input, console);
  print_mesh(report, console);
  print_fields(report, console);
  print_materials(report, console);
  note_resampled(report, console);
}

}  // namespace adamas::cli
