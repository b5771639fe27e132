#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/meshes.h"

namespace adamas::test {

/// A surface as an independent reader finds it in a file; of what a format does not have there is nothing.
struct SurfaceFile {
  TriangleSurface surface;
  bool single = false;  ///< whether coordinates are floats
  Vec3 translation;     ///< which has been added to the points
};

/// By VTK.
SurfaceFile read_vtp_surface(const std::filesystem::path& path);
/// By parsers of the tests' own: no more than what the writers here need. They throw at anything else.
SurfaceFile read_ply_surface(const std::filesystem::path& path);
SurfaceFile read_obj_surface(const std::filesystem::path& path);
/// .glb or .gltf; checks lengths, alignment, bounds and what glTF asks of normals.
SurfaceFile read_gltf_surface(const std::filesystem::path& path);

}  // namespace adamas::test
