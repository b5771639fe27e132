#include "cli/resample_figures.h"

#include "core/base/parallel.h"

namespace adamas {

namespace {

/// Which cells an approximated interface runs through.
std::vector<char> find_interface_cells(const InterfaceTable& table, const CellSet& cells,
                                       const Progress& progress) {
  std::vector<char> result(cells.count, 0);
  constexpr std::size_t kGrain = 2048;
  parallel_chunks(cells.count, kGrain, [&](std::size_t begin, std::size_t end) {
    progress.check();
    CellOwnership ownership;
    std::vector<ContactPolygon> contacts;
    for (std::size_t i = begin; i < end; ++i) {
      cells.ownership(table, cells.corners(i), ownership);
      if (ownership.pure()) continue;
      keep_owners(ownership.problem);
      contacts.clear();
      contact_polygons(ownership.problem, contacts);
      result[i] = contacts.empty() ? 0 : 1;
    }
  });
  return result;
}

}  // namespace

ResampleFigures measure(const Resampler& resampler, const Progress& progress) {
  const ResamplingSource& source = resampler.source();
  const InterfaceTable& table = source.network->table();
  const auto& hierarchy = resampler.hierarchy();
  const CellSet cells = resampler.cells();
  ResampleFigures figures;
  figures.tetrahedra = hierarchy.leaf_count();
  figures.vertices = hierarchy.vertex_count();
  figures.bodies = table.body_count();
  figures.fields.resize(source.fields ? source.fields->fields().size() : 0);
  const std::vector<char> crossed = find_interface_cells(table, cells, progress);
  std::size_t i = 0;
  hierarchy.for_each_leaf([&](TetrahedronId t) {
    const CellRecord& cell = hierarchy.payload(t);
    if (cell.interface.lost) ++figures.lost_interfaces;
    if (crossed[i] != 0) ++figures.interface_tetrahedra;
    for (std::size_t f = 0; f < std::min(cell.fields.size(), figures.fields.size()); ++f) {
      figures.fields[f].all.add(cell.fields[f]);
      if (crossed[i] != 0) figures.fields[f].at_interfaces.add(cell.fields[f]);
    }
    ++i;
  });
  hierarchy.for_each_vertex([&](VertexId v) {
    if (hierarchy.payload(v).distances.flagged) ++figures.flagged_vertices;
  });
  progress.check();
  figures.volumes.resize(source.materials.size());
  const auto bodies = body_volumes(table, cells);
  for (BodyId b(0); b.value < bodies.size(); ++b.value) figures.volumes[table.material(b)] += bodies[b];
  return figures;
}

}  // namespace adamas
