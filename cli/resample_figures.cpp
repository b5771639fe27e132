#include "cli/resample_figures.h"

#include <algorithm>
#include <cmath>

#include "cli/fraction_report.h"

namespace adamas::cli {

namespace {

/// The reason why an error was not reached; null where it was.
Figures shortfall_figures(const std::optional<Shortfall>& shortfall) {
  if (!shortfall) return nullptr;
  return {{"reason", shortfall->reason}, {"place", place_figures(shortfall->place)}};
}

Figures field_figures(const ResampleReport& report) {
  Figures figures = Figures::object();
  for (const ResampleReport::Field& field : report.fields) {
    Figures errors = field_error_figures(field);
    errors["target"] = figure(field.target);
    errors["reached"] = field.target && field.count() > 0
                            ? Figures(field.everywhere.max_error <= *field.target)
                            : Figures(nullptr);
    errors["shortfall"] = shortfall_figures(field.shortfall);
    figures[field.name] = std::move(errors);
  }
  return figures;
}

/// Adds a distance between interfaces: certified, attained, whether it is within the target, and if not, why.
void add_distance(Figures& figures, const std::string& name,
                  const std::optional<MeasuredDistance>& distance) {
  figures[name] = distance ? Figures(distance->certified) : Figures(nullptr);
  figures[name + "_measured"] = distance ? Figures(distance->found) : Figures(nullptr);
  figures[name + "_reached"] = distance ? Figures(!distance->shortfall) : Figures(nullptr);
  figures[name + "_shortfall"] = shortfall_figures(distance ? distance->shortfall : std::nullopt);
}

Figures body_row(const ResampleReport::Body& body, const ResampleReport& report) {
  Figures row{{"material", report.materials[body.material].name},
              {"volume_input", figure(body.volume_input)},
              {"volume_mesh", body.volume_mesh},
              {"place", place_figures(body.place)}};
  if (report.topology_known) {
    row["pieces"] = body.topology_mesh.pieces;
    row["euler_input"] = report.topology_comparable ? Figures(body.topology_input.euler) : Figures(nullptr);
    row["euler_mesh"] = body.topology_mesh.euler;
  }
  return row;
}

/// Returns whether every body has its volume in the input; null where no interfaces were moved for that.
Figures conserved(const ResampleReport& report) {
  if (!report.conservation_tolerance) return nullptr;
  return std::ranges::all_of(
      report.bodies, [&report](const ResampleReport::Body& body) { return report.is_conserved(body); });
}

/// Adds counts of the bodies that the mesh does not show as they are in the input, and a row for each of
/// these.
void add_bodies(Figures& figures, const ResampleReport& report) {
  std::size_t lost = 0, changed = 0;
  Figures rows = Figures::array();
  for (const ResampleReport::Body& body : report.bodies) {
    if (body.lost) ++lost;
    if (body.changed) ++changed;
    if (body.lost || body.changed) rows.push_back(body_row(body, report));
  }
  figures["bodies"] = report.bodies.size();
  figures["lost_bodies"] = lost;
  figures["lost_materials"] = std::ranges::count_if(report.materials, &ResampleReport::Material::lost);
  figures["changed_bodies"] = changed;
  figures["wrong_bodies"] = std::move(rows);
  figures["contacts"] = report.contacts.size();
  figures["contact_pairs"] = Figures::array();
  for (const auto& [a, b] : report.contacts) {
    const auto name = [&](std::size_t body) { return report.materials[report.bodies[body].material].name; };
    figures["contact_pairs"].push_back({name(a), name(b)});
  }
  figures["conserved"] = conserved(report);
}

/// Adds the greatest error of a body's volume, whether all bodies are within the error, and a row for each
/// that is not.
void add_volume_errors(Figures& figures, const ResampleReport& report) {
  const ResampleReport::Body* worst = report.worst_volume ? &report.bodies[*report.worst_volume] : nullptr;
  Figures rows = Figures::array();
  for (const ResampleReport::Body& body : report.bodies) {
    if (!body.missed_volume) continue;
    rows.push_back(body_row(body, report));
    rows.back()["reason"] = body.missed_volume->reason;
  }
  figures["volume_error_target"] = figure(report.volume_error_target);
  figures["volume_error"] = worst != nullptr ? Figures(worst->volume_error()) : Figures(nullptr);
  figures["worst_body"] = worst != nullptr ? body_row(*worst, report) : Figures(nullptr);
  figures["volume_error_reached"] = report.volume_error_target ? Figures(rows.empty()) : Figures(nullptr);
  figures["volume_error_shortfall"] =
      worst != nullptr ? shortfall_figures(worst->missed_volume) : Figures(nullptr);
  figures["missed_volumes"] = std::move(rows);
}

void add_distances(Figures& figures, const ResampleReport& report) {
  figures["interface_error_target"] = report.interface_error_target;
  add_distance(figures, "interface_error", report.interface_error);
  add_distance(figures, "interface_error_per_material", report.interface_error_per_material);
  figures["interface_error_worst_material"] = figure(report.worst_material);
  add_distance(figures, "junction_error", report.junction_error);
}

}  // namespace

Figures field_error_figures(const ResampleReport::Field& field) {
  return {{"max_error", field.everywhere.max_error},
          {"mean_error", field.everywhere.mean_error},
          {"reducible_max_error", field.everywhere.reducible_max_error},
          {"interface_max_error", field.at_interfaces.max_error},
          {"interface_mean_error", field.at_interfaces.mean_error},
          {"elements",
           {{"pure", field.pure},
            {"mixed", field.mixed},
            {"minority", field.minority},
            {"displaced", field.displaced},
            {"without_value", field.without_value}}}};
}

Figures volume_figures(const std::vector<ResampleReport::Material>& materials) {
  Figures figures = Figures::array();
  for (const ResampleReport::Material& material : materials)
    figures.push_back({{"name", material.name},
                       {"volume_input", figure(material.volume_input)},
                       {"volume_mesh", material.volume_mesh}});
  return figures;
}

Figures resample_json(const ResampleReport& report) {
  Figures figures;
  figures["tetrahedra"] = report.tetrahedra;
  figures["vertices"] = report.vertices;
  figures["interface_tetrahedra"] = report.interface_tetrahedra;
  add_distances(figures, report);
  figures["lost_interfaces"] = report.lost_interfaces;
  figures["fields"] = field_figures(report);
  figures["materials"] = volume_figures(report.materials);
  add_bodies(figures, report);
  add_volume_errors(figures, report);
  figures["interface_triangles"] = figure(report.interface_triangles);
  figures["flagged_vertices"] = report.flagged_vertices;
  figures["fractions"] =
      report.fractions ? finding_figures(*report.fractions, material_names(report)) : Figures(nullptr);
  return figures;
}

std::vector<std::string> material_names(const ResampleReport& report) {
  std::vector<std::string> names;
  for (const ResampleReport::Material& material : report.materials) names.push_back(material.name);
  return names;
}

}  // namespace adamas::cli
