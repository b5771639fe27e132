#include "cli/slice_polygons.h"

namespace adamas {

UnstructuredMesh section_polygons(const CrossSection& section,
                                  const IdVector<MaterialId, std::string>& materials,
                                  const std::string& field) {
  UnstructuredMesh mesh;
  mesh.kind = CellKind::kPolygons;
  std::vector<std::int32_t> material, cell;
  std::vector<double> values;
  for (const SectionPiece& piece : section.pieces) {
    for (const Vec3& p : piece.corners) {
      mesh.connectivity.push_back(static_cast<std::uint32_t>(mesh.points.size()));
      mesh.points.push_back(p);
    }
    mesh.offsets.push_back(mesh.connectivity.size());
    material.push_back(static_cast<std::int32_t>(piece.material.value));
    cell.push_back(static_cast<std::int32_t>(piece.cell));
    values.insert(values.end(), piece.values.begin(), piece.values.end());
  }
  mesh.cell_arrays.push_back({"material", 1, std::move(material)});
  mesh.cell_arrays.push_back({"cell", 1, std::move(cell)});
  if (!field.empty()) mesh.point_arrays.push_back({field, 1, std::move(values)});
  mesh.field_arrays.push_back({"material_names", 1, std::vector<std::string>(materials)});
  return mesh;
}

}  // namespace adamas
