#include "interfaces/api/resample_report.h"

#include <cmath>
#include <limits>

#include "interfaces/resampling/resample_figures.h"

namespace adamas {

double ResampleReport::Body::missing() const { return std::abs(*volume_input - volume_mesh); }

double ResampleReport::Body::volume_error() const {
  return *volume_input > 0 ? missing() / *volume_input : 0;
}

bool ResampleReport::is_conserved(const Body& body) const {
  return body.missing() <= *conservation_tolerance;
}

namespace interfaces {

namespace {

MeasuredDistance measured(const InterfaceDistance& distance, const Resampler& resampler) {
  return {distance.upper, distance.lower, interface_shortfall(resampler, distance)};
}

void add_distances(const Resampler& resampler, ResampleReport& report) {
  report.interface_error_target = resampler.options().interface_error;
  const auto& certificate = resampler.certificate();
  if (!certificate) return;
  report.interface_error = measured(certificate->networks, resampler);
  report.interface_error_per_material = measured(certificate->materials, resampler);
  report.worst_material = resampler.source().materials[certificate->worst_material];
  if (certificate->junctions) report.junction_error = measured(*certificate->junctions, resampler);
  report.interface_triangles = certificate->triangles;
}

void add_bodies(const Resampler& resampler, const ResampleFigures& figures, ResampleReport& report) {
  report.bodies = figures.bodies;
  for (BodyId b(0); b.value < figures.bodies.size(); ++b.value)
    report.bodies[b.value].missed_volume = volume_shortfall(resampler, figures, b);
  if (const BodyReport* compared = resampler.body_report()) {
    report.topology_known = true;
    report.topology_comparable = compared->comparable;
  }
  for (const auto& [a, b] : figures.contacts) report.contacts.push_back({a.value, b.value});
  report.volume_error_target = resampler.options().volume_error;
  if (const auto worst = worst_volume(figures)) report.worst_volume = worst->value;
  if (resampler.options().conserve)
    report.conservation_tolerance = kConserved * resampler.source().box.volume();
  report.conservation_wanted = resampler.options().conservation_wanted;
}

ResampleReport::Errors errors(const FieldError& error) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (error.count() == 0) return {kNone, kNone, kNone};
  return {error.max, error.mean(), error.reducible};
}

void add_fields(const Resampler& resampler, const ResampleFigures& figures, ResampleReport& report) {
  for (std::size_t f = 0; f < figures.fields.size(); ++f) {
    report.fields.push_back(field_report(resampler.source().fields->fields()[f], figures.fields[f]));
    report.fields.back().target = resampler.options().field_errors[f];
    report.fields.back().shortfall = field_shortfall(resampler, f, figures.fields[f].all);
  }
}

}  // namespace

ResampleReport::Field field_report(const FieldInfo& field, const FieldFigures& figures) {
  const auto& [all, near] = figures;
  const auto count = [&all = all](ElementKind kind) -> std::size_t {
    return all.counts[static_cast<std::size_t>(kind)];
  };
  return {field.name,
          field.unit,
          {},
          errors(all),
          errors(near),
          count(ElementKind::kPure),
          count(ElementKind::kMixed),
          count(ElementKind::kMinority),
          all.displaced,
          all.without_value};
}

std::vector<ResampleReport::Material> material_reports(const ResamplingSource& source,
                                                       const IdVector<MaterialId, double>& volumes) {
  std::vector<ResampleReport::Material> reports;
  for (MaterialId m(0); m.value < volumes.size(); ++m.value) {
    const bool stated = m.value < source.volumes.size();
    reports.push_back(
        {source.materials[m], stated ? std::optional(source.volumes[m]) : std::nullopt, volumes[m]});
  }
  return reports;
}

ResampleReport report_of(const Resampler& resampler, const Progress& progress) {
  const ResampleFigures figures = measure(resampler, progress);
  const ResamplingSource& source = resampler.source();
  ResampleReport report;
  report.input = source.name;
  report.tetrahedra = figures.tetrahedra;
  report.vertices = figures.vertices;
  report.interface_tetrahedra = figures.interface_tetrahedra;
  report.lost_interfaces = figures.lost_interfaces;
  report.flagged_vertices = figures.flagged_vertices;
  report.fractions = source.findings;
  report.adaptation = resampler.adaptation();
  add_distances(resampler, report);
  add_bodies(resampler, figures, report);
  report.materials = material_reports(source, figures.volumes);
  for (const MaterialId m : lost_materials(figures, source)) report.materials[m.value].lost = true;
  add_fields(resampler, figures, report);
  report.unreached = unreached_errors(resampler, figures.fields);
  return report;
}

}  // namespace interfaces

}  // namespace adamas
