#pragma once

#include <filesystem>

#include "core/data/solver_mesh.h"

namespace adamas {

// The formats of write_solver_mesh.

void write_gmsh(const std::filesystem::path& path, const SolverMesh& mesh);
void write_exodus(const std::filesystem::path& path, const SolverMesh& mesh);

}  // namespace adamas
