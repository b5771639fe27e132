#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "cli/picture_options.h"
#include "core/data/triangle_surface.h"

namespace adamas {

/// A picture of isosurfaces as a picture file. `isovalues[n]` is that of the triangles before `ends[n]`, from
/// the one before it on; several have colours and a legend.
void write_isosurface_picture(const std::filesystem::path& path, const TriangleSurface& surface,
                              const std::vector<std::size_t>& ends, const std::vector<double>& isovalues,
                              const Box3& domain, const PictureOptions& camera);

}  // namespace adamas
