#include "viewer/session/line_meshes.h"

#include <array>
#include <vector>

#include "viewer/contents/mesh_maker.h"
#include "viewer/session/picking.h"

namespace adamas::viewer {

using namespace isosurface;
using namespace picture;

namespace {

/// Lines between pairs of points.
SharedMesh lines(const std::vector<Vec3>& ends) {
  Box3 box;
  for (const Vec3& p : ends) box.extend(p);
  MeshMaker maker(box.center(), MeshMaker::Kind::kLines);
  for (const Vec3& p : ends) maker.add_index(maker.add_vertex(p, {}, {}));
  return maker.finish();
}

std::vector<Vec3> edges_of_corners(const std::array<Vec3, 8>& corners) {
  std::vector<Vec3> ends;
  for (unsigned c = 0; c < 8; ++c) {
    for (const unsigned bit : {1u, 2u, 4u}) {
      if ((c & bit) == 0) ends.insert(ends.end(), {corners[c], corners[c | bit]});
    }
  }
  return ends;
}

/// The corners of the space that a viewpoint shows, from near the eye to its target: those of a pyramid or of
/// a prism.
std::array<Vec3, 8> corners_of_view(const Viewpoint& viewpoint) {
  std::array<Vec3, 8> corners;
  const double far = distance(viewpoint.eye, viewpoint.target);
  const Vec3 forward = normalized(viewpoint.target - viewpoint.eye);
  for (unsigned c = 0; c < 8; ++c) {
    const Ray ray = ray_through(viewpoint, (c & 1u) != 0 ? viewpoint.width_pixels : 0,
                                (c & 2u) != 0 ? viewpoint.height_pixels : 0);
    const double along = (c & 4u) != 0 ? far : 0.05 * far;
    const double start = dot(ray.origin - viewpoint.eye, forward);
    corners[c] = ray.origin + ((along - start) / dot(ray.direction, forward)) * ray.direction;
  }
  return corners;
}

}  // namespace

SharedMesh lines_of_box(const Box3& box) { return lines(edges_of_corners(box.corners())); }

SharedMesh lines_of_view(const Viewpoint& viewpoint) {
  return lines(edges_of_corners(corners_of_view(viewpoint)));
}

}  // namespace adamas::viewer
