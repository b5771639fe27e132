#include "interfaces/resampling/resample_figures.h"

#include <algorithm>

#include "interfaces/reconstruction/dispersed.h"

namespace adamas::interfaces {

namespace {

std::vector<BodyFigures> body_figures(const Resampler& resampler, const CellSet& cells) {
  const ResamplingSource& source = resampler.source();
  const InterfaceNetwork& network = *source.network;
  const InterfaceTable& table = network.table();
  std::vector<BodyFigures> bodies(table.body_count());
  const auto volumes = body_volumes(table, cells);
  const BodyReport* report = resampler.body_report();
  for (BodyId b(0); b.value < bodies.size(); ++b.value) {
    BodyFigures& body = bodies[b.value];
    body.material = table.material(b);
    body.volume = volumes[b];
    if (!source.body_volumes.empty()) body.volume_input = source.body_volumes[b];
    body.lost = volumes[b] == 0;
    if (report == nullptr) continue;
    body.topology_input = report->input[b];
    body.topology_mesh = report->mesh[b];
    body.changed = !body.lost && !report->kept(b);
  }
  // The first triangle's place stands for its body's.
  for (std::uint32_t t = static_cast<std::uint32_t>(network.triangles().size()); t-- > 0;) {
    const auto& [x, y, z] = network.triangle_corners(t);
    for (const BodyId b : table.sides(network.interface_of(t)))
      bodies[b.value].place = (1.0 / 3) * (x + y + z);
  }
  return bodies;
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
  figures.bodies = body_figures(resampler, cells);
  figures.volumes = IdVector<MaterialId, double>(source.materials.size(), 0.0);
  for (const BodyFigures& body : figures.bodies) figures.volumes[body.material] += body.volume;
  if (const BodyReport* report = resampler.body_report()) figures.contacts = report->contacts;
  return figures;
}

std::optional<BodyId> worst_volume(const ResampleFigures& measured) {
  std::optional<BodyId> worst;
  for (BodyId b(0); b.value < measured.bodies.size(); ++b.value) {
    const BodyFigures& body = measured.bodies[b.value];
    if (!body.volume_input) continue;
    if (!worst || body.volume_error() > measured.bodies[worst->value].volume_error()) worst = b;
  }
  return worst;
}

std::vector<MaterialId> lost_materials(const ResampleFigures& measured, const ResamplingSource& source) {
  std::vector<MaterialId> lost;
  for (MaterialId m(0); m.value < measured.volumes.size(); ++m.value) {
    const bool in_input = std::any_of(measured.bodies.begin(), measured.bodies.end(),
                                      [m](const BodyFigures& body) { return body.material == m; }) ||
                          (m.value < source.volumes.size() && source.volumes[m] > 0 &&
                           !(source.findings && is_all_dispersed(*source.findings, m, source.volumes[m])));
    if (in_input && measured.volumes[m] == 0) lost.push_back(m);
  }
  return lost;
}

}  // namespace adamas::interfaces
