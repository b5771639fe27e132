#include "tools/demo_run.h"

#include <chrono>

namespace adamas::demo {

namespace {

RunFigures figures_of(const Resampler& resampler, const ResampledMesh& mesh) {
  RunFigures figures;
  figures.target = resampler.options().interface_error;
  figures.distance = resampler.interface_distance();
  figures.tetrahedra = mesh.cells.size();
  figures.vertices = mesh.points.size();
  figures.fields.resize(mesh.fields.size());
  CellOwnership ownership;
  std::vector<ContactPolygon> contacts;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    mesh.ownership(c, ownership);
    if (ownership.pure()) continue;
    contacts.clear();
    keep_owners(ownership.problem);
    contact_polygons(ownership.problem, contacts);
    if (!contacts.empty()) ++figures.interface_tetrahedra;
  }
  resampler.hierarchy().for_each_leaf([&](TetrahedronId t) {
    const CellRecord& cell = resampler.hierarchy().payload(t);
    for (std::size_t f = 0; f < cell.fields.size(); ++f) figures.fields[f].add(cell.fields[f]);
  });
  figures.volumes.resize(mesh.materials.size());
  const auto volumes = body_volumes(mesh.table, mesh.cell_set());
  for (BodyId b(0); b.value < volumes.size(); ++b.value)
    figures.volumes[mesh.table.material(b)] += volumes[b];
  return figures;
}

}  // namespace

Run resample(const ResamplingSource& source, double interface_error) {
  const auto start = std::chrono::steady_clock::now();
  ResamplingOptions options;
  options.interface_error = interface_error;
  Resampler resampler(source, options);
  resampler.refine();
  Run run;
  run.mesh = take_mesh(resampler);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  run.figures = figures_of(resampler, run.mesh);
  run.figures.seconds = elapsed.count();
  run.interfaces = extract_interfaces(run.mesh.table, run.mesh.cell_set(), 1e-11 * run.mesh.box.diagonal());
  // The extraction speaks of bodies; pictures show materials.
  run.interfaces.mesh.materials = run.mesh.materials;
  return run;
}

}  // namespace adamas::demo
