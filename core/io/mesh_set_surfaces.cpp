#include "core/io/mesh_set_surfaces.h"

#include <algorithm>
#include <utility>

#include "core/io/polygon_selection.h"

namespace adamas::io {

namespace {

/// Adds the faces all of whose points are in a node set.
void add_faces_between(const MeshSet& set, const PolyhedralMesh& mesh, PolygonSelection& surfaces) {
  std::vector<bool> has(mesh.points().size(), false);
  for (const std::uint32_t p : set.points) has[p] = true;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    if (std::ranges::all_of(face, [&has](std::uint32_t p) { return has[p]; })) surfaces.add(face);
  }
}

}  // namespace

UnstructuredMesh mesh_set_surfaces(const MeshData& data) {
  PolygonSelection surfaces(data.mesh.points());
  std::vector<std::int32_t> numbers;
  std::vector<std::string> names;
  for (const MeshSet& set : data.sets) {
    for (std::size_t n = 0; n < set.side_ends.size(); ++n) surfaces.add(set.side(n));
    if (set.of_nodes) add_faces_between(set, data.mesh, surfaces);
    numbers.resize(surfaces.mesh.cell_count(), static_cast<std::int32_t>(names.size()));
    names.push_back(set.name);
  }
  surfaces.mesh.cell_arrays.push_back({"side_set", 1, std::move(numbers)});
  surfaces.mesh.field_arrays.push_back({"side_set_names", 1, std::move(names)});
  return std::move(surfaces.mesh);
}

}  // namespace adamas::io
