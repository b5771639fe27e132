#pragma once

#include <filesystem>

#include "adamas/export.h"
#include "adamas/meshes.h"
#include "adamas/picture.h"
#include "adamas/resample.h"

namespace adamas ADAMAS_API {

/// Draws interfaces as write_picture does. Where the file is .html, which turns in a browser, its plane that
/// cuts shows the materials and the fields of `mesh`, each material's own, at points of a grid: at most 72
/// along the mesh's longest side. Of vectors it shows their lengths. Throws Error as write_picture does.
void write_picture(const std::filesystem::path& path, const InterfaceTriangles& interfaces,
                   const AdaptiveMesh& mesh, const DrawingOptions& options = {});

}  // namespace adamas
