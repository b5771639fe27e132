#include "cli/surface_picture.h"

#include <algorithm>
#include <vector>

#include "core/picture/interface_picture.h"
#include "core/picture/palette.h"

namespace adamas {

namespace {

/// More names than this make no legend.
constexpr std::size_t kMostNames = 24;

/// The materials' volumes up to a constant per closed network, by the divergence theorem; what surrounds the
/// others comes out smallest, since the domain's own faces are no triangles.
IdVector<MaterialId, double> enclosed_volumes(const InterfaceMesh& mesh, const Box3& domain) {
  IdVector<MaterialId, double> volumes(mesh.materials.size(), 0.0);
  const Vec3 o = domain.center();
  for (const InterfaceTriangle& t : mesh.triangles) {
    const double v =
        signed_volume(o, mesh.points[t.points[0]], mesh.points[t.points[1]], mesh.points[t.points[2]]);
    volumes[t.back] += v;
    volumes[t.front] -= v;
  }
  return volumes;
}

}  // namespace

void write_surface_picture(const std::filesystem::path& path, const InterfaceMesh& mesh, const Box3& domain,
                           bool triangle_edges) {
  const auto volumes = enclosed_volumes(mesh, domain);
  InterfacePicture picture;
  picture.domain = domain;
  std::vector<char> shown(mesh.materials.size(), 0);
  for (const InterfaceTriangle& t : mesh.triangles) {
    const bool front = volumes[t.front] != volumes[t.back] ? volumes[t.front] > volumes[t.back]
                                                           : t.front.value > t.back.value;
    const MaterialId m = front ? t.front : t.back;
    shown[m.value] = 1;
    picture.triangles.push_back(
        {{mesh.points[t.points[0]], mesh.points[t.points[1]], mesh.points[t.points[2]]},
         material_colour(m.value)});
  }
  if (static_cast<std::size_t>(std::count(shown.begin(), shown.end(), 1)) <= kMostNames) {
    for (MaterialId m(0); m.value < mesh.materials.size(); ++m.value) {
      if (shown[m.value] != 0) picture.materials.push_back({mesh.materials[m], material_colour(m.value)});
    }
  }
  InterfacePictureOptions options;
  options.triangle_edges = triangle_edges;
  write_interfaces(picture, path, options);
}

}  // namespace adamas
