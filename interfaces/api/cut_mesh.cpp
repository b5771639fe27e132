#include "interfaces/api/cut_mesh.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "core/base/loop_progress.h"
#include "interfaces/api/adaptive_mesh.h"
#include "interfaces/api/error_targets.h"
#include "interfaces/api/material_totals.h"
#include "interfaces/cutting/cut_mesh.h"
#include "interfaces/cutting/cut_mesh_file.h"
#include "interfaces/cutting/input_sets.h"

namespace adamas {

using namespace interfaces;

namespace {

double tolerance_of(const CutMeshOptions& options, const ResampledMesh& mesh, double interface_error) {
  if (!options.error) return default_cut_tolerance(mesh, interface_error);
  return interface_error_of("--cut-error", *options.error, {mesh.source, mesh.box, mesh.fields, 0});
}

/// Returns the distances from the input's interfaces; none if the input is not kept.
std::optional<InterfaceDistances> compare_with_input(const ConformingMesh& cut, const ResampledMesh& mesh,
                                                     const AdaptiveMesh::Contents& contents, double target,
                                                     const Progress& progress) {
  if (!contents.run || contents.run->source.network->triangles().empty()) return std::nullopt;
  const ExtractedInterfaces shown = interfaces_of(cut, mesh.table);
  InterfaceComparison comparison(contents.run->source, target);
  comparison.measure(shown.mesh, progress);
  return to_distances(comparison.finish(progress));
}

CutMeshReport report_of(const ConformingMesh& cut, const CutMeshExamination& found,
                        const ResampledMesh& mesh) {
  CutMeshReport report;
  report.tetrahedra = cut.tetrahedra.size();
  report.vertices = cut.points.size();
  report.dihedral_min = found.dihedral.min;
  report.dihedral_max = found.dihedral.max;
  report.to_mesh = to_distances(found.distance);
  for (const auto& [body, of_mesh, of_cut, volume] : found.changed)
    report.changed_bodies.push_back({body.value, mesh.table.material(body).value, volume, of_mesh, of_cut});
  std::ranges::stable_sort(report.changed_bodies, std::greater{}, &CutMeshReport::Body::volume);
  report.volume_difference = found.volume_difference;
  return report;
}

}  // namespace

CutMesh::CutMesh(std::unique_ptr<Contents> contents) : contents_(std::move(contents)) {}
CutMesh::CutMesh(CutMesh&&) noexcept = default;
CutMesh& CutMesh::operator=(CutMesh&&) noexcept = default;
CutMesh::~CutMesh() = default;

const CutMeshReport& CutMesh::report() const { return contents_->report; }

MaterialTetrahedra CutMesh::tetrahedra() const {
  const SolverMesh& mesh = contents_->mesh;
  return {mesh.points, mesh.tetrahedra, mesh.block, mesh.blocks};
}

CutMesh cut_mesh(const AdaptiveMesh& mesh, const CutMeshOptions& options, Progress& progress) {
  const LoopProgress loops(progress);
  const ResampledMesh& whole = mesh.contents().mesh();
  const double interface_error = mesh.report().interface_error_target;
  const double tolerance = tolerance_of(options, whole, interface_error);
  const ConformingMesh cut = interfaces::cut_mesh(whole, tolerance, progress);
  progress.step("measuring the cut mesh", -1);
  auto contents = std::make_unique<CutMesh::Contents>();
  contents->report = report_of(cut, examine_cut_mesh(cut, whole, tolerance, progress), whole);
  contents->report.to_input =
      compare_with_input(cut, whole, mesh.contents(), std::max(interface_error, tolerance), progress);
  contents->materials = whole.materials;
  contents->mesh =
      to_solver_mesh(cut, whole, options.split_bodies ? PointsOfBodies::kSplit : PointsOfBodies::kShared);
  if (const auto& run = mesh.contents().run; run && run->input && run->input->cells)
    add_input_sets(*run->input->cells, interface_error + tolerance, contents->mesh);
  return CutMesh(std::move(contents));
}

std::vector<MaterialTotals> material_totals(const CutMesh& mesh) {
  const CutMesh::Contents& contents = mesh.contents();
  return to_totals(material_integrals(contents.mesh), contents.materials);
}

}  // namespace adamas
