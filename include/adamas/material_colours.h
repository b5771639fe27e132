#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>

#include "adamas/cut_mesh.h"
#include "adamas/export.h"
#include "adamas/meshes.h"
#include "adamas/read_input.h"
#include "adamas/resample.h"
#include "adamas/select.h"

namespace adamas ADAMAS_API {

/// Colours of materials by their names: red, green and blue from 0 to 1.
using MaterialColours = std::map<std::string, std::array<double, 3>>;

/// Finds the colours that the files of an input have for materials: `.seg.nrrd`, tables of ITK-SNAP, and
/// meshes, interfaces and hierarchies that were written with colours. Throws Error at damaged headers.
MaterialColours find_material_colours(const InputOptions& options);

/// Writes a mesh as write_mesh(path, mesh) does, with an array `material_colors` of the mesh where one of its
/// materials has a colour: a row of three numbers per material, -1 where it has none.
void write_mesh(const std::filesystem::path& path, const AdaptiveMesh& mesh, const MaterialColours& colours);
/// Writes interfaces as write_mesh(path, mesh) does; `.vtp` with the same array.
void write_mesh(const std::filesystem::path& path, const InterfaceTriangles& mesh,
                const MaterialColours& colours);
/// Writes a cut mesh as write_mesh(path, mesh) does; `.vtu` and `.vtkhdf` with the same array.
void write_mesh(const std::filesystem::path& path, const CutMesh& mesh, const MaterialColours& colours);
/// Writes a hierarchy as write_hierarchy(path, mesh) does, with the same array.
void write_hierarchy(const std::filesystem::path& path, const MultiresolutionMesh& mesh,
                     const MaterialColours& colours);

}  // namespace adamas
