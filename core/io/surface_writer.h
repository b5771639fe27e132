#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "adamas/geometry.h"
#include "adamas/meshes.h"
#include "adamas/progress.h"
#include "core/base/error.h"

namespace adamas::io {

enum class SurfaceFormat : std::uint8_t { kPly, kStl, kObj, kVtp, kGlb, kGltf };

/// The format by the extension, in upper or lower case: .ply, .stl, .obj, .vtp, .glb, .gltf; empty for
/// others.
std::optional<SurfaceFormat> surface_format(const std::filesystem::path& path);

/// Writes a surface in the format of the extension; equal surfaces give equal bytes. Numbers are floats, but
/// coordinates in .ply, .vtp and .obj are doubles if floats do not suffice (single_precision_suffices); .glb
/// and .gltf then hold them relative to a translation. .stl has only points, once for each triangle; .obj has
/// no values; .glb and .gltf have a normal where the surface has a zero one. Throws Error for other
/// extensions, for an invalid surface (TriangleSurface::check), if the format cannot count or hold the data,
/// and if the file cannot be written in full.
void write_surface(const std::filesystem::path& path, const TriangleSurface& surface,
                   Progress& progress = SilentProgress::instance());

/// Whether floats distinguish the points of a surface well enough: the greatest coordinate, by magnitude, is
/// at most 4096 times the mean length of the triangles' edges, so that rounding moves a coordinate by at most
/// 1/4096 of that length, and both are in the normal range of floats.
bool single_precision_suffices(const TriangleSurface& surface);

}  // namespace adamas::io
