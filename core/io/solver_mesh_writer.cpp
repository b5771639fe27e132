#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/solver_mesh_formats.h"
#include "core/io/solver_mesh_io.h"

namespace adamas {

void write_solver_mesh(const std::filesystem::path& path, const SolverMesh& mesh) {
  const std::string extension = file_extension(path);
  if (extension == ".msh") return write_gmsh(path, mesh);
  if (extension == ".exo") return write_exodus(path, mesh);
  fail("{}: expected .msh or .exo, found '{}'", path.string(), extension);
}

}  // namespace adamas
