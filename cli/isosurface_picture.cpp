#include "cli/isosurface_picture.h"

#include <fmt/format.h>

#include "core/picture/interface_picture.h"
#include "core/picture/palette.h"

namespace adamas {

namespace {

/// Of a surface alone; light, so that shading shows its form.
constexpr Colour kBone{0.93, 0.85, 0.71};

}  // namespace

void write_isosurface_picture(const std::filesystem::path& path, const TriangleSurface& surface,
                              const std::vector<std::size_t>& ends, const std::vector<double>& isovalues,
                              const Box3& domain, const PictureOptions& camera) {
  InterfacePicture picture;
  picture.domain = domain;
  camera.aim(picture);
  picture.triangles.reserve(surface.triangles.size());
  for (std::size_t n = 0; n < ends.size(); ++n) {
    const Colour colour = ends.size() > 1 ? material_colour(n) : kBone;
    if (ends.size() > 1) picture.materials.push_back({fmt::format("{:.6g}", isovalues[n]), colour});
    for (std::size_t t = picture.triangles.size(); t < ends[n]; ++t) {
      const auto [a, b, c] = surface.triangles[t];
      picture.triangles.push_back({{surface.points[a], surface.points[b], surface.points[c]}, colour});
    }
  }
  write_interfaces(picture, path, camera.sizes());
}

}  // namespace adamas
