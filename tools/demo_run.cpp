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
  for (const char crossed : cells_with_interfaces(mesh.table, mesh.cell_set()))
    figures.interface_tetrahedra += crossed != 0 ? 1 : 0;
  resampler.hierarchy().for_each_leaf([&](TetrahedronId t) {
    const CellRecord& cell = resampler.hierarchy().payload(t);
    for (std::size_t f = 0; f < cell.fields.size(); ++f) figures.fields[f].add(cell.fields[f]);
  });
  figures.volumes = material_volumes(mesh.table, mesh.cell_set(), mesh.materials.size());
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
