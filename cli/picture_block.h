#pragma once

#include <filesystem>

#include "core/picture/interface_picture.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas::cli {

/// Whether a picture of that name turns in a browser.
bool turns(const std::filesystem::path& path);

/// The materials and the fields of a mesh, each material's own, at points of a grid: at most 72 along its
/// longest side. Of vectors their lengths.
picture::PictureBlock picture_block(const interfaces::ResampledMesh& mesh);

}  // namespace adamas::cli
