#include "interfaces/resampling/output.h"

#include "interfaces/mesh/extraction.h"

namespace adamas::interfaces {

InterfaceMesh approximated_interfaces(const Resampler& resampler, Progress& progress) {
  const ResamplingSource& source = resampler.source();
  InterfaceMesh mesh =
      extract_interfaces(source.network->table(), resampler.cells(), source.box, progress).mesh;
  mesh.materials = source.materials;
  mesh.source = source.name;
  return mesh;
}

ResampledMesh resampled_mesh(const Resampler& resampler) {
  const auto& hierarchy = resampler.hierarchy();
  const ResamplingSource& source = resampler.source();
  ResampledMesh mesh;
  mesh.source = source.name;
  mesh.box = source.box;
  mesh.materials = source.materials;
  mesh.table = source.network->table();
  if (source.fields) mesh.fields = source.fields->fields();
  mesh.field_errors.resize(mesh.fields.size());

  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> number(hierarchy.vertex_slots(), kUnused);
  hierarchy.for_each_leaf([&](TetrahedronId t) {
    const CellRecord& record = hierarchy.payload(t);
    ResampledMesh::Cell cell{{},
                             static_cast<std::uint8_t>(hierarchy.level(t)),
                             static_cast<std::uint8_t>(hierarchy.phase(t)),
                             record.interface.distance};
    const auto vertices = hierarchy.vertices(t);
    for (std::size_t i = 0; i < 4; ++i) {
      std::uint32_t& n = number[vertices[i].value];
      if (n == kUnused) {
        n = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back(hierarchy.position(vertices[i]));
        mesh.vertices.push_back(hierarchy.payload(vertices[i]));
        mesh.vertices.back().closest = {};
      }
      cell.vertices[i] = n;
    }
    mesh.cells.push_back(cell);
    for (std::size_t f = 0; f < mesh.fields.size(); ++f) mesh.field_errors[f].push_back(record.fields[f].max);
  });
  return mesh;
}

}  // namespace adamas::interfaces
