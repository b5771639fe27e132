#include "adamas/resample.h"

#include <algorithm>
#include <limits>

#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "core/data/grid_data.h"
#include "core/data/interface_mesh.h"
#include "core/geometry/length_limits.h"
#include "interfaces/library/adaptive_mesh.h"
#include "interfaces/network/check.h"
#include "interfaces/network/mending.h"
#include "interfaces/resampling/resample_figures.h"
#include "interfaces/resampling/resampler.h"
#include "interfaces/source/grid_source.h"

namespace adamas {

using namespace interfaces;

namespace {

std::vector<std::optional<double>> field_errors(const ResampleOptions& options,
                                                const ResamplingSource& source) {
  static const std::vector<FieldInfo> kNone;
  const auto& fields = source.fields ? source.fields->fields() : kNone;
  std::vector<std::optional<double>> result(fields.size());
  for (const auto& [name, error] : options.field_errors) {
    const auto same = [&name = name](const FieldInfo& field) { return field.name == name; };
    const auto found = std::find_if(fields.begin(), fields.end(), same);
    if (found == fields.end()) {
      std::string known;
      for (const FieldInfo& field : fields)
        known += fmt::format("{}'{}'", known.empty() ? "" : ", ", field.name);
      fail("{}: field errors: expected one of its fields ({}), found '{}'", source.name,
           known.empty() ? "none" : known, name);
    }
    if (!(error <= std::numeric_limits<double>::max()))
      fail("{}: field errors: expected a finite error of '{}', found {}", source.name, name, error);
    if (error > 0 && found->max > found->min)
      result[static_cast<std::size_t>(found - fields.begin())] = error;
  }
  return result;
}

ResamplingOptions to_resampling_options(const ResampleOptions& options, const ResamplingSource& source) {
  const double whole = source.box.diagonal();
  ResamplingOptions result;
  result.interface_error = options.interface_error.value_or(whole / 100);
  if (!(result.interface_error > 0 && result.interface_error < whole)) {
    fail("{}: expected an interface error above 0 and less than the domain's diagonal, {:.6g}, found {}",
         source.name, whole, result.interface_error);
  }
  if (options.conserve && source.body_volumes.empty() && !source.network->triangles().empty())
    fail("{}: expected interfaces that enclose volumes, to conserve these, found open ones", source.name);
  if (options.volume_error && !(*options.volume_error > 0 && *options.volume_error < 1))
    fail("{}: expected a volume error above 0 and less than 1, found {}", source.name, *options.volume_error);
  if (options.volume_error && source.body_volumes.empty() && !source.network->triangles().empty())
    fail("{}: expected interfaces that enclose volumes, for an error of these, found open ones", source.name);
  result.field_errors = field_errors(options, source);
  result.max_tetrahedra = options.max_tetrahedra;
  result.ghost = options.ghost;
  result.distance = options.distance;
  result.conserve = options.conserve;
  result.volume_error = options.volume_error;
  return result;
}

std::optional<MeasuredDistance> measured(const std::optional<InterfaceDistance>& distance) {
  if (!distance) return {};
  return MeasuredDistance{distance->upper, distance->lower};
}

/// Adds the distances, and why one is greater than wanted.
void report_distances(const Resampler& resampler, ResampleReport& report) {
  report.interface_error_target = resampler.options().interface_error;
  const auto& certificate = resampler.certificate();
  if (!certificate) return;
  report.interface_error = measured(certificate->networks);
  report.interface_error_per_material = measured(certificate->materials);
  report.junction_error = measured(certificate->junctions);
  for (const auto& distance : {std::optional(certificate->networks), std::optional(certificate->materials),
                               certificate->junctions}) {
    if (!distance || !report.shortfall.empty()) continue;
    if (const auto shortfall = interface_shortfall(resampler, *distance))
      report.shortfall = shortfall->reason;
  }
}

void report_fields(const ResampleFigures& figures, const Resampler& resampler, ResampleReport& report) {
  const auto known = [](const FieldError& error, double value) {
    return error.count() > 0 ? value : std::numeric_limits<double>::quiet_NaN();
  };
  for (std::size_t f = 0; f < figures.fields.size(); ++f) {
    const auto& [all, near] = figures.fields[f];
    report.fields.push_back({resampler.source().fields->fields()[f].name, resampler.options().field_errors[f],
                             known(all, all.max), known(all, all.mean()), known(near, near.max),
                             known(near, near.mean())});
    const auto shortfall = field_shortfall(resampler, f, all);
    if (shortfall && report.shortfall.empty()) report.shortfall = shortfall->reason;
  }
}

void report_volumes(const ResampleFigures& figures, const Resampler& resampler, ResampleReport& report) {
  report.volume_error_target = resampler.options().volume_error;
  if (const auto worst = worst_volume(figures))
    report.volume_error = figures.bodies[worst->value].volume_error();
  for (BodyId b(0); b.value < figures.bodies.size(); ++b.value) {
    const auto shortfall = volume_shortfall(resampler, figures, b);
    if (!shortfall) continue;
    const BodyFigures& body = figures.bodies[b.value];
    report.missed_volumes.push_back({resampler.source().materials[body.material], body.place,
                                     *body.volume_input, body.volume, shortfall->reason});
    if (report.shortfall.empty()) report.shortfall = shortfall->reason;
  }
}

ResampleReport report_of(const Resampler& resampler, const Progress& progress) {
  const ResampleFigures figures = measure(resampler, progress);
  const ResamplingSource& source = resampler.source();
  ResampleReport report;
  report.interface_tetrahedra = figures.interface_tetrahedra;
  report.lost_interfaces = figures.lost_interfaces;
  report.bodies = figures.bodies.size();
  for (const BodyFigures& body : figures.bodies) {
    if (body.lost) ++report.lost_bodies;
    if (body.changed) ++report.changed_bodies;
  }
  report.contacts = figures.contacts.size();
  for (MaterialId m(0); m.value < source.materials.size(); ++m.value) {
    report.materials.push_back({source.materials[m], {}, figures.volumes[m]});
    if (!source.volumes.empty()) report.materials.back().volume_input = source.volumes[m];
  }
  report.fractions = source.findings;
  report_distances(resampler, report);
  report_volumes(figures, resampler, report);
  report_fields(figures, resampler, report);
  return report;
}

AdaptiveMesh resample(const ResamplingSource& source, const ResampleOptions& options, Progress& progress) {
  Resampler resampler(source, to_resampling_options(options, source), progress);
  resampler.refine();
  progress.step("measuring", -1);
  auto contents = std::make_unique<AdaptiveMesh::Contents>();
  contents->report = report_of(resampler, progress);
  contents->mesh = resampled_mesh(resampler);
  contents->tetrahedra.reserve(contents->mesh.cells.size());
  for (const auto& cell : contents->mesh.cells) contents->tetrahedra.push_back(cell.vertices);
  return AdaptiveMesh(std::move(contents));
}

}  // namespace

AdaptiveMesh resample(const GridData& data, const ResampleOptions& options, Progress& progress) {
  const LoopProgress loops(progress);
  const MultiMaterialData taken = to_multi_material_data(data);
  return resample(
      make_grid_source(taken, {.smooth_labels = options.smooth_labels, .fractions = options.fractions},
                       progress),
      options, progress);
}

AdaptiveMesh resample(const InterfaceTriangles& interfaces, const Box3& domain,
                      const ResampleOptions& options, Progress& progress) {
  const LoopProgress loops(progress);
  InterfaceMesh mesh = to_interface_mesh(interfaces, "interfaces");
  if (options.smooth_labels) fail("{}: expected labels to smooth, found given interfaces", mesh.source);
  check_lengths(mesh.source, domain);
  check_interface_arrays(mesh);
  Box3 found;
  for (const Vec3& p : mesh.points) found.extend(p);
  if (!found.touches(domain))
    fail("{}: expected interfaces in the domain, found them beside it", mesh.source);
  mend_interface_mesh(mesh, &domain);
  check_interface_mesh(mesh, &domain);
  return resample(make_mesh_source(mesh, domain, nullptr, progress), options, progress);
}

}  // namespace adamas
