#include "interfaces/api/select.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "interfaces/api/adaptive_mesh.h"
#include "interfaces/api/error_targets.h"
#include "interfaces/selection/selection.h"

namespace adamas {

using namespace interfaces;

namespace {

/// Returns the targets of the options in the units of the hierarchy.
SelectionTargets targets_of(const SelectOptions& options, const MultiresolutionMesh::Contents& contents) {
  const ResampledMesh& tree = contents.hierarchy.tree;
  SelectionTargets targets;
  const InputFacts facts{contents.name, tree.box, tree.fields, contents.hierarchy.voxel};
  if (options.interface_error)
    targets.interface_error = interface_error_of("--interface-error", *options.interface_error, facts);
  targets.field_errors = field_errors_of(options.field_errors, facts);
  targets.max_tetrahedra = options.max_tetrahedra;
  return targets;
}

/// Returns the sums of the errors that were measured in the cells of a mesh.
std::vector<FieldError> measured_errors(const Selection& selection) {
  const SavedHierarchy& hierarchy = selection.hierarchy();
  std::vector<FieldError> errors(hierarchy.tree.fields.size());
  for (const std::uint32_t cell : selection.cells()) {
    for (std::size_t f = 0; f < errors.size(); ++f) errors[f].add(hierarchy.measured[f][cell]);
  }
  return errors;
}

void add_fields(const Selection& selection, const SelectionTargets& targets, SelectReport& report) {
  const std::vector<FieldError> errors = measured_errors(selection);
  for (std::size_t f = 0; f < errors.size(); ++f) {
    const FieldInfo& info = selection.hierarchy().tree.fields[f];
    report.fields.push_back({info.name, info.unit, targets.field_errors[f], errors[f].max, errors[f].mean(),
                             errors[f].reducible, errors[f].count()});
  }
}

void add_materials(const SavedHierarchy& hierarchy, const ResampledMesh& mesh, SelectReport& report) {
  const auto volumes = material_volumes(mesh.table, mesh.cell_set(), mesh.materials.size());
  const bool known = !hierarchy.input_volumes.empty();
  for (MaterialId m(0); m.value < mesh.materials.size(); ++m.value)
    report.materials.push_back(
        {mesh.materials[m], known ? std::optional(hierarchy.input_volumes[m]) : std::nullopt, volumes[m]});
}

Vec3 middle_of(const ResampledMesh& mesh, std::size_t cell) {
  const auto [a, b, c, d] = mesh.corners(cell);
  return 0.25 * (a + b + c + d);
}

/// Adds the wanted errors that the mesh does not reach. An interface error that is only estimated counts if
/// the mesh cannot be refined further.
void add_unreached(const Selection& selection, const SelectionTargets& targets, SelectReport& report) {
  const SavedHierarchy& hierarchy = selection.hierarchy();
  report.reason = selection.budget_spent()
                      ? fmt::format("the mesh may have no more than {} tetrahedra", *targets.max_tetrahedra)
                      : std::string("the hierarchy that was saved goes no further");
  const auto add = [&report](const std::string& what, double found, double wanted,
                             const std::optional<Vec3>& place) {
    if (found > wanted) report.unreached.push_back({what, found, wanted, place});
  };
  const auto add_distance = [&](const std::string& what, const InterfaceDistance& distance,
                                const std::optional<Vec3>& otherwise) {
    const Vec3& worst = distance.worst;
    const bool known = std::isfinite(distance.lower) && std::isfinite(worst.x + worst.y + worst.z);
    add(what, distance.upper, *targets.interface_error, known ? std::optional(worst) : otherwise);
  };
  if (const auto& wanted = targets.interface_error) {
    const InterfaceCertificate* found = selection.certificate();
    const std::string what = "the interface error wanted";
    if (found == nullptr) {
      if (selection.is_whole() || selection.budget_spent())
        add(what, selection.interface_error(), *wanted,
            middle_of(hierarchy.tree, selection.worst_interface_cell()));
    } else {
      add_distance(what, found->networks, middle_of(hierarchy.tree, selection.worst_interface_cell()));
      if (hierarchy.tree.materials.size() > 2)
        add_distance(
            fmt::format("{} for the boundary of '{}'", what, hierarchy.tree.materials[found->worst_material]),
            found->materials, {});
      if (found->junctions)
        add_distance(what + " for the lines where three materials meet", *found->junctions, {});
    }
  }
  for (std::size_t f = 0; f < targets.field_errors.size(); ++f) {
    if (targets.field_errors[f])
      add(fmt::format("the error wanted of the field '{}'", hierarchy.tree.fields[f].name),
          selection.field_error(f), *targets.field_errors[f],
          middle_of(hierarchy.tree, selection.worst_field_cell(f)));
  }
}

SelectReport report_of(const Selection& selection, const SelectionTargets& targets,
                       const ResampledMesh& mesh) {
  SelectReport report;
  report.input = selection.hierarchy().tree.source;
  report.tetrahedra = mesh.cells.size();
  report.vertices = mesh.points.size();
  report.changed_tetrahedra = selection.changed();
  report.whole_hierarchy = selection.is_whole();
  report.limited = selection.budget_spent();
  report.interface_error_target = targets.interface_error;
  if (const InterfaceCertificate* certificate = selection.certificate()) {
    report.certificate = to_distances(*certificate);
  } else {
    report.interface_error_estimate = selection.interface_error();
  }
  add_fields(selection, targets, report);
  add_materials(selection.hierarchy(), mesh, report);
  add_unreached(selection, targets, report);
  return report;
}

}  // namespace

MultiresolutionMesh::MultiresolutionMesh(std::unique_ptr<Contents> contents)
    : contents_(std::move(contents)) {}
MultiresolutionMesh::MultiresolutionMesh(MultiresolutionMesh&&) noexcept = default;
MultiresolutionMesh& MultiresolutionMesh::operator=(MultiresolutionMesh&&) noexcept = default;
MultiresolutionMesh::~MultiresolutionMesh() = default;

const std::string& MultiresolutionMesh::name() const { return contents_->name; }
const Box3& MultiresolutionMesh::domain() const { return contents_->hierarchy.tree.box; }
std::vector<std::string> MultiresolutionMesh::materials() const {
  const auto& materials = contents_->hierarchy.tree.materials;
  return {materials.begin(), materials.end()};
}
std::vector<FieldDescription> MultiresolutionMesh::fields() const {
  return describe(contents_->hierarchy.tree.fields);
}
double MultiresolutionMesh::interface_error() const { return contents_->hierarchy.interface_target; }
std::size_t MultiresolutionMesh::tetrahedra() const {
  const SavedHierarchy& hierarchy = contents_->hierarchy;
  return hierarchy.tree.cells.size() - hierarchy.split_cells.size();
}

SelectedMesh MultiresolutionMesh::select(const SelectOptions& options, Progress& progress) const {
  const LoopProgress loops(progress);
  const SavedHierarchy& hierarchy = contents_->hierarchy;
  const SelectionTargets targets = targets_of(options, *contents_);
  Selection selection(hierarchy);
  selection.select(targets);
  ResampledMesh mesh = selection.mesh();
  SelectReport report = report_of(selection, targets, mesh);
  auto selected = std::make_unique<AdaptiveMesh::Contents>(std::move(mesh));
  // The wanted error determines the tolerance of cutting, as for a new mesh.
  selected->report.interface_error_target =
      targets.interface_error.value_or(std::max(selection.interface_error(), hierarchy.interface_target));
  selected->input_volumes = hierarchy.input_volumes;
  return {AdaptiveMesh(std::move(selected)), std::move(report)};
}

void check(const SelectOptions& options, const MultiresolutionMesh& mesh) {
  static_cast<void>(targets_of(options, mesh.contents()));
}

MultiresolutionMesh multiresolution_mesh(const AdaptiveMesh& mesh, Progress& progress) {
  const LoopProgress loops(progress);
  auto contents = std::make_unique<MultiresolutionMesh::Contents>();
  const AdaptiveMesh::Contents::Run& run = mesh.contents().kept_run("its hierarchy");
  contents->name = mesh.report().input;
  contents->hierarchy = take_hierarchy(*run.resampler, progress);
  return MultiresolutionMesh(std::move(contents));
}

}  // namespace adamas
