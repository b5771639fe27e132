#pragma once

#include <filesystem>

#include "core/data/interface_mesh.h"
#include "core/geometry/vec3.h"

namespace adamas {

/// Draws interfaces in their domain, each in the colour of the material it bounds: of two, the one that fills
/// less of the domain's boundary, as a material in its surroundings does. `triangle_edges`: draws the
/// triangles too.
void write_surface_picture(const std::filesystem::path& path, const InterfaceMesh& mesh, const Box3& domain,
                           bool triangle_edges = false);

}  // namespace adamas
