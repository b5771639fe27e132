#include "core/io/solver_mesh_io.h"

#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/unstructured_mesh_io.h"

namespace adamas::io {

namespace {

using Integers = std::vector<std::int32_t>;

/// The fields on cells, with names that differ from those of the other arrays there.
std::vector<NamedArray> cell_fields(const SolverMesh& mesh) {
  std::vector<NamedArray> fields = mesh.fields;
  for (NamedArray& field : fields) {
    if (field.name == "material" || field.name == "body") field.name += " (field)";
  }
  return fields;
}

}  // namespace

void write_vtu(const std::filesystem::path& path, const SolverMesh& mesh) {
  UnstructuredMesh file;
  file.points = mesh.points;
  for (const auto& v : mesh.tetrahedra) {
    file.connectivity.insert(file.connectivity.end(), v.begin(), v.end());
    file.offsets.push_back(file.connectivity.size());
  }
  file.cell_arrays.push_back({"material", 1, Integers(mesh.block.begin(), mesh.block.end())});
  if (!mesh.body.empty()) file.cell_arrays.push_back({"body", 1, mesh.body});
  if (mesh.point_fields.empty()) {
    for (NamedArray& field : cell_fields(mesh)) file.cell_arrays.push_back(std::move(field));
  } else {
    file.point_arrays = mesh.point_fields;
  }
  file.field_arrays.push_back({"material_names", 1, mesh.blocks});
  write_unstructured_mesh(path, file);
}

UnstructuredMesh face_surface(const SolverMesh& mesh) {
  constexpr std::int32_t kUnused = -1;
  UnstructuredMesh surface;
  surface.kind = CellKind::kPolygons;
  Integers number(mesh.points.size(), kUnused), points, groups, tetrahedra;
  std::vector<std::string> names;
  for (const SolverMesh::FaceGroup& group : mesh.face_groups) {
    for (const SolverMesh::Face& face : group.faces) {
      for (const std::uint32_t corner : mesh.corners(face)) {
        if (number[corner] == kUnused) {
          number[corner] = static_cast<std::int32_t>(points.size());
          points.push_back(static_cast<std::int32_t>(corner));
          surface.points.push_back(mesh.points[corner]);
        }
        surface.connectivity.push_back(static_cast<std::uint32_t>(number[corner]));
      }
      surface.offsets.push_back(surface.connectivity.size());
      groups.push_back(static_cast<std::int32_t>(names.size()));
      tetrahedra.push_back(static_cast<std::int32_t>(face.tetrahedron));
    }
    names.push_back(group.name);
  }
  surface.point_arrays.push_back({"point", 1, std::move(points)});
  surface.cell_arrays.push_back({"group", 1, std::move(groups)});
  surface.cell_arrays.push_back({"tetrahedron", 1, std::move(tetrahedra)});
  surface.field_arrays.push_back({"group_names", 1, std::move(names)});
  return surface;
}

void write_solver_mesh(const std::filesystem::path& path, const SolverMesh& mesh) {
  const std::string extension = file_extension(path);
  if (extension == ".vtu") return write_vtu(path, mesh);
  if (extension == ".msh") return write_gmsh(path, mesh);
  if (extension == ".exo") return write_exodus(path, mesh);
  fail("{}: expected .vtu, .msh or .exo, found '{}'", path.string(), extension);
}

}  // namespace adamas::io
