#pragma once

#include <filesystem>

#include "adamas/export.h"
#include "adamas/meshes.h"
#include "adamas/picture.h"
#include "adamas/resample.h"

namespace adamas ADAMAS_API {

/// Draws interfaces as write_picture() does. A .html, which the user turns in a browser, also has a cutting
/// plane with the materials and the fields of `mesh`, each material's own, at points of a grid: at most 72
/// along the mesh's longest side. Vectors are shown by their lengths. Throws Error as write_picture() does.
void write_picture(const std::filesystem::path& path, const InterfaceTriangles& interfaces,
                   const AdaptiveMesh& mesh, const DrawingOptions& options = {});

}  // namespace adamas
