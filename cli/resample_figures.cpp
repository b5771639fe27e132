#include "cli/resample_figures.h"

namespace adamas {

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
  const std::vector<char> crossed = cells_with_interfaces(table, cells, progress);
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
  figures.volumes = material_volumes(table, cells, source.materials.size());
  return figures;
}

}  // namespace adamas
