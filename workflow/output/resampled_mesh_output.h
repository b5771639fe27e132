#pragma once

#include <filesystem>

#include "adamas/material_colours.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas::workflow {

/// Writes a mesh with the colours that its materials have, as write_mesh() does.
void write_resampled_mesh(const std::filesystem::path& path, const interfaces::ResampledMesh& mesh,
                          const MaterialColours& colours);

}  // namespace adamas::workflow
