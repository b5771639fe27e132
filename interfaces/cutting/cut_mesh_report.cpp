#include "interfaces/cutting/cut_mesh_report.h"

#include <algorithm>
#include <cmath>

#include "core/base/loop_progress.h"

namespace adamas::interfaces {

CutMeshExamination examine_cut_mesh(const ConformingMesh& cut, const ResampledMesh& mesh, double target,
                                    Progress& progress) {
  const LoopProgress loops(progress);
  CutMeshExamination report;
  report.dihedral = dihedral_range(cut);
  ExtractedInterfaces of_mesh = extract_interfaces(mesh.table, mesh.cell_set(), mesh.box, progress);
  of_mesh.mesh.materials = mesh.materials;
  const ExtractedInterfaces of_cut = interfaces_of(cut, mesh.table);
  const std::size_t bodies = mesh.table.body_count();
  const auto before = body_topology(of_mesh, bodies, mesh.box);
  const auto after = body_topology(of_cut, bodies, mesh.box);
  const auto volumes = body_volumes(mesh.table, mesh.cell_set()), cut_volumes = body_volumes(cut, bodies);
  for (BodyId b(0); b.value < bodies; ++b.value) {
    report.volume_difference = std::max(report.volume_difference, std::abs(cut_volumes[b] - volumes[b]));
    if (before[b] != after[b]) report.changed.push_back({b, before[b], after[b], volumes[b]});
  }
  if (of_mesh.mesh.triangles.empty()) return report;
  InterfaceComparison comparison(of_mesh.mesh, mesh.box, true, target);
  comparison.measure(of_cut.mesh, progress);
  report.distance = comparison.finish(of_cut.mesh, progress);
  return report;
}

}  // namespace adamas::interfaces
