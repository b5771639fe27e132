#pragma once

#include <filesystem>

#include "core/data/solver_mesh.h"
#include "core/io/named_colours.h"

namespace adamas::io {

/// Writes .vtu (only tetrahedra: `material` and `body` on cells, the fields on points, or on cells if points
/// have none), .msh (Gmsh 2.2, as text: physical groups for blocks and groups of faces, fields as element
/// data, of one, three or nine components: smaller ones are padded, larger ones left out) or .exo (ExodusII:
/// a block for each block that has tetrahedra, side sets, element variables at one time step, one for each
/// component). A .vtu and a .vtkhdf have the colours of blocks, too (add_colours()). Equal meshes give equal
/// bytes. Throws Error if the file cannot be written in full.
void write_solver_mesh(const std::filesystem::path& path, const SolverMesh& mesh,
                       const NamedColours& colours = {});

/// Reads points, tetrahedra and blocks of a .vtu that write_solver_mesh wrote. Throws Error, with the file's
/// name, for other cells and for tetrahedra without a block.
SolverMesh read_solver_mesh(const std::filesystem::path& path);

/// The groups of faces of a mesh as triangles on points of their own, for .vtp: `group` and `tetrahedron` on
/// cells, `point` on points (their numbers in the mesh), and `group_names`. A .vtu has no room for these.
UnstructuredMesh face_surface(const SolverMesh& mesh);

}  // namespace adamas::io
