#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "core/io/grid_file.h"

namespace adamas::io {

/// The cells of a mesh as a file has them, in one piece: points of several blocks at one place are one.
struct MeshFile {
  /// The name of the array of whole numbers that says which block of several a cell belongs to.
  static constexpr const char* kBlocks = "block";

  std::string kind;  ///< "VTK XML unstructured grid", ...
  std::vector<Vec3> points;
  /// The faces of the cells, as PolyhedralMesh::make() takes them.
  std::vector<std::uint32_t> face_points, face_ends, cell_ends;
  std::vector<GridArray> arrays;
  std::vector<std::string> blocks;          ///< the names of the blocks, if there are several
  std::vector<std::string> material_names;  ///< as in GridFile
  std::string remark;                       ///< what else the file holds and is not read; usually empty
};

/// Whether a file is a legacy VTK file (.vtk) of a structured or unstructured grid, by its header.
bool is_legacy_mesh(const std::filesystem::path& path);

/// Reads the cells of a mesh: .vtu, .pvtu, .vts, .pvts, .vtm, legacy .vtk, ExodusII, CGNS, and the cases of
/// OpenFOAM (a file NAME.foam in the case's folder). Of several times the last one is read.
/// Cells of two dimensions beside others of three are left out, and so are copies of cells of other pieces.
/// The libraries may crash on a corrupt file, so they run in a child process (read_in_child).
MeshFile read_mesh_file(const std::filesystem::path& path);
/// Reads a file as read_mesh_file does, but in this process.
MeshFile read_mesh_with_vtk(const std::filesystem::path& path);

}  // namespace adamas::io
