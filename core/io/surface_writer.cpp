#include "core/io/surface_writer.h"

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/surface_formats.h"

namespace adamas::io {

namespace {

double greatest_coordinate(const std::vector<Vec3>& points) {
  double greatest = 0;
  for (const Vec3& p : points) {
    greatest = std::max({greatest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  return greatest;
}

/// The mean length of the triangles' edges; 0 if there is no triangle.
double mean_edge_length(const TriangleSurface& surface) {
  double sum = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3 &p = surface.points[a], &q = surface.points[b], &r = surface.points[c];
    sum += distance(p, q) + distance(q, r) + distance(r, p);
  }
  return surface.triangles.empty() ? 0 : sum / (3 * static_cast<double>(surface.triangles.size()));
}

using Writer = void (*)(const SurfaceOutput&);

Writer writer_of(SurfaceFormat format) {
  switch (format) {
    case SurfaceFormat::kPly:
      return write_surface_ply;
    case SurfaceFormat::kStl:
      return write_surface_stl;
    case SurfaceFormat::kObj:
      return write_surface_obj;
    case SurfaceFormat::kVtp:
      return write_surface_vtp;
    case SurfaceFormat::kGlb:
      return write_surface_glb;
    case SurfaceFormat::kGltf:
      return write_surface_gltf;
  }
  return nullptr;
}

}  // namespace

std::optional<SurfaceFormat> surface_format(const std::filesystem::path& path) {
  const std::string extension = file_extension(path);
  if (extension == ".ply") return SurfaceFormat::kPly;
  if (extension == ".stl") return SurfaceFormat::kStl;
  if (extension == ".obj") return SurfaceFormat::kObj;
  if (extension == ".vtp") return SurfaceFormat::kVtp;
  if (extension == ".glb") return SurfaceFormat::kGlb;
  if (extension == ".gltf") return SurfaceFormat::kGltf;
  return std::nullopt;
}

bool single_precision_suffices(const TriangleSurface& surface) {
  using Limits = std::numeric_limits<float>;
  const double greatest = greatest_coordinate(surface.points);
  if (greatest == 0) return true;
  if (greatest > double{Limits::max()}) return false;
  const double length = mean_edge_length(surface);
  return length >= double{Limits::min()} && greatest <= 4096 * length;
}

void check_single_range(const SurfaceOutput& out) {
  const double greatest = greatest_coordinate(out.surface.points);
  if (greatest > double{std::numeric_limits<float>::max()}) {
    fail("{}: expected coordinates that single precision can hold, found {}; .ply, .vtp and .obj hold it",
         out.name, greatest);
  }
}

void write_surface(const std::filesystem::path& path, const TriangleSurface& surface, Progress& progress) {
  const std::string name = path.string();
  const auto format = surface_format(path);
  if (!format) {
    fail("{}: expected .ply, .stl, .obj, .vtp, .glb or .gltf for a surface, found '{}'", name,
         file_extension(path));
  }
  surface.check(name);
  OutputStream stream(path);
  writer_of (*format)({name, surface, stream, progress});
  stream.finish();
}

}  // namespace adamas::io
