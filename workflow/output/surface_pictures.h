#pragma once

#include <filesystem>
#include <optional>

#include "adamas/picture.h"
#include "core/data/interface_mesh.h"
#include "core/picture/interface_picture.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas::workflow {

/// Returns whether a picture of that name can be turned in a browser.
bool turns(const std::filesystem::path& path);

/// Returns the materials and the fields of a mesh, each material's own, at points of a grid: at most 72 along
/// its longest side. Vectors are replaced by their lengths. `options`: colours of materials.
picture::PictureBlock picture_block(const interfaces::ResampledMesh& mesh, const DrawingOptions& options);

/// Draws interfaces in their domain. `block`: the values on the cutting plane of a picture in a browser.
void write_surface_picture(const std::filesystem::path& path, const InterfaceMesh& mesh, const Box3& domain,
                           DrawingOptions options = {},
                           std::optional<picture::PictureBlock> block = std::nullopt);

}  // namespace adamas::workflow
