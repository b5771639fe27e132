#include "cli/resample_figures.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/fraction_report.h"
#include "interfaces/resampling/resample_figures.h"

namespace adamas::cli {

using namespace interfaces;

namespace {

/// The figure, or null where it is not known.
Figures known(bool is, double value) { return is ? Figures(value) : Figures(nullptr); }

/// The reason why an error was not reached; null where it was.
Figures shortfall_figures(const std::optional<Shortfall>& shortfall) {
  if (!shortfall) return nullptr;
  const Vec3& p = shortfall->place;
  return {{"reason", shortfall->reason}, {"place", {p.x, p.y, p.z}}};
}

Figures field_figures(const ResampleFigures& measured, const Resampler& resampler) {
  Figures figures = Figures::object();
  for (std::size_t f = 0; f < measured.fields.size(); ++f) {
    const FieldError& all = measured.fields[f].all;
    const auto& target = resampler.options().field_errors[f];
    Figures figure = field_error_figures(measured.fields[f]);
    figure["target"] = known(target.has_value(), target.value_or(0));
    figure["reached"] = target && all.count() > 0 ? Figures(all.max <= *target) : Figures(nullptr);
    figure["shortfall"] = shortfall_figures(field_shortfall(resampler, f, all));
    figures[resampler.source().fields->fields()[f].name] = std::move(figure);
  }
  return figures;
}

/// A distance between interfaces: certified, attained, whether it is within the target, and if not, why.
void add_distance(Figures& figures, const std::string& name, const Resampler& resampler,
                  const std::optional<InterfaceDistance>& distance) {
  const auto shortfall = distance ? interface_shortfall(resampler, *distance) : std::nullopt;
  figures[name] = known(distance.has_value(), distance ? distance->upper : 0);
  figures[name + "_measured"] = known(distance.has_value(), distance ? distance->lower : 0);
  figures[name + "_reached"] = distance ? Figures(!shortfall) : Figures(nullptr);
  figures[name + "_shortfall"] = shortfall_figures(shortfall);
}

Figures body_row(const BodyFigures& body, const Resampler& resampler) {
  Figures row{{"material", resampler.source().materials[body.material]},
              {"volume_input", body.volume_input ? Figures(*body.volume_input) : Figures(nullptr)},
              {"volume_mesh", body.volume},
              {"place", {body.place.x, body.place.y, body.place.z}}};
  if (const BodyReport* report = resampler.body_report()) {
    row["pieces"] = body.topology_mesh.pieces;
    row["euler_input"] = report->comparable ? Figures(body.topology_input.euler) : Figures(nullptr);
    row["euler_mesh"] = body.topology_mesh.euler;
  }
  return row;
}

/// Counts of the bodies that the mesh does not show as the input has them, and a row for each of these.
void add_bodies(Figures& figures, const ResampleFigures& measured, const Resampler& resampler) {
  std::size_t lost = 0, changed = 0;
  Figures rows = Figures::array();
  for (const BodyFigures& body : measured.bodies) {
    if (body.lost) ++lost;
    if (body.changed) ++changed;
    if (body.lost || body.changed) rows.push_back(body_row(body, resampler));
  }
  figures["bodies"] = measured.bodies.size();
  figures["lost_bodies"] = lost;
  figures["lost_materials"] = lost_materials(measured, resampler.source()).size();
  figures["changed_bodies"] = changed;
  figures["wrong_bodies"] = std::move(rows);
  figures["contacts"] = measured.contacts.size();
  figures["contact_pairs"] = Figures::array();
  for (const auto& [a, b] : measured.contacts) {
    const auto name = [&](BodyId body) {
      return resampler.source().materials[measured.bodies[body.value].material];
    };
    figures["contact_pairs"].push_back({name(a), name(b)});
  }
  const double whole = resampler.source().box.volume();
  figures["conserved"] =
      !resampler.options().conserve
          ? Figures(nullptr)
          : Figures(std::all_of(measured.bodies.begin(), measured.bodies.end(),
                                [whole](const BodyFigures& b) { return b.missing() <= kConserved * whole; }));
}

/// The greatest error of a body's volume, whether all are as wanted, and a row for each that is not.
void add_volume_errors(Figures& figures, const ResampleFigures& measured, const Resampler& resampler) {
  const auto& target = resampler.options().volume_error;
  const auto worst = worst_volume(measured);
  Figures rows = Figures::array();
  for (BodyId b(0); b.value < measured.bodies.size(); ++b.value) {
    const auto shortfall = volume_shortfall(resampler, measured, b);
    if (!shortfall) continue;
    rows.push_back(body_row(measured.bodies[b.value], resampler));
    rows.back()["reason"] = shortfall->reason;
  }
  figures["volume_error_target"] = known(target.has_value(), target.value_or(0));
  figures["volume_error"] = worst ? Figures(measured.bodies[worst->value].volume_error()) : Figures(nullptr);
  figures["worst_body"] = worst ? body_row(measured.bodies[worst->value], resampler) : Figures(nullptr);
  figures["volume_error_reached"] = target ? Figures(rows.empty()) : Figures(nullptr);
  figures["volume_error_shortfall"] =
      shortfall_figures(worst ? volume_shortfall(resampler, measured, *worst) : std::nullopt);
  figures["missed_volumes"] = std::move(rows);
}

void add_certificate(Figures& figures, const Resampler& resampler) {
  const auto& certificate = resampler.certificate();
  const bool made = certificate.has_value();
  const auto of = [&](InterfaceDistance InterfaceCertificate::*distance) {
    return made ? std::optional((*certificate).*distance) : std::nullopt;
  };
  figures["interface_error_target"] = resampler.options().interface_error;
  add_distance(figures, "interface_error", resampler, of(&InterfaceCertificate::networks));
  add_distance(figures, "interface_error_per_material", resampler, of(&InterfaceCertificate::materials));
  figures["interface_error_worst_material"] =
      made ? Figures(resampler.source().materials[certificate->worst_material]) : Figures(nullptr);
  add_distance(figures, "junction_error", resampler, made ? certificate->junctions : std::nullopt);
}

}  // namespace

Figures field_error_figures(const FieldFigures& errors) {
  const auto& [all, near] = errors;
  const auto of_kind = [&all = all](ElementKind kind) { return all.counts[static_cast<std::size_t>(kind)]; };
  return {{"max_error", known(all.count() > 0, all.max)},
          {"mean_error", known(all.count() > 0, all.mean())},
          {"reducible_max_error", known(all.count() > 0, all.reducible)},
          {"interface_max_error", known(near.count() > 0, near.max)},
          {"interface_mean_error", known(near.count() > 0, near.mean())},
          {"elements",
           {{"pure", of_kind(ElementKind::kPure)},
            {"mixed", of_kind(ElementKind::kMixed)},
            {"minority", of_kind(ElementKind::kMinority)},
            {"displaced", all.displaced},
            {"without_value", all.without_value}}}};
}

Figures volume_figures(const ResamplingSource& source, const IdVector<MaterialId, double>& volumes) {
  Figures figures = Figures::array();
  for (MaterialId m(0); m.value < volumes.size(); ++m.value) {
    const bool stated = m.value < source.volumes.size();
    figures.push_back({{"name", source.materials[m]},
                       {"volume_input", known(stated, stated ? source.volumes[m] : 0)},
                       {"volume_mesh", volumes[m]}});
  }
  return figures;
}

Figures resample_json(const ResampleFigures& measured, const Resampler& resampler) {
  Figures figures;
  figures["tetrahedra"] = measured.tetrahedra;
  figures["vertices"] = measured.vertices;
  figures["interface_tetrahedra"] = measured.interface_tetrahedra;
  add_certificate(figures, resampler);
  figures["lost_interfaces"] = measured.lost_interfaces;
  figures["fields"] = field_figures(measured, resampler);
  figures["materials"] = volume_figures(resampler.source(), measured.volumes);
  add_bodies(figures, measured, resampler);
  add_volume_errors(figures, measured, resampler);
  figures["interface_triangles"] =
      resampler.certificate() ? Figures(resampler.certificate()->triangles) : Figures(nullptr);
  figures["flagged_vertices"] = measured.flagged_vertices;
  const auto& findings = resampler.source().findings;
  figures["fractions"] =
      findings ? finding_figures(*findings, resampler.source().materials) : Figures(nullptr);
  return figures;
}

}  // namespace adamas::cli
