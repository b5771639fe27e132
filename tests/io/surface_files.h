#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/meshes.h"

namespace adamas::test {

/// A surface as an independent reader finds it in a file. Members that a format does not have are empty.
struct SurfaceFile {
  TriangleSurface surface;
  bool single = false;  ///< whether coordinates are floats
  Vec3 translation;     ///< the translation that has been added to the points
};

/// Reads by VTK.
SurfaceFile read_vtp_surface(const std::filesystem::path& path);
/// These parsers are the tests' own. They read only what the writers here produce, and throw at anything
/// else.
SurfaceFile read_ply_surface(const std::filesystem::path& path);
SurfaceFile read_obj_surface(const std::filesystem::path& path);
/// Reads .glb or .gltf. Checks lengths, alignment, bounds and what glTF requires of normals.
SurfaceFile read_gltf_surface(const std::filesystem::path& path);

}  // namespace adamas::test
