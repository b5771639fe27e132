#include "core/geometry/box_clip.h"

namespace adamas {

namespace {

std::vector<Vec3> clip_polygon(std::vector<Vec3> polygon, const Box3& box) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const double limit = sign > 0 ? box.max[axis] : -box.min[axis];
      std::vector<Vec3> kept;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double dp = limit - sign * p[axis], dq = limit - sign * q[axis];
        if (dp >= 0) kept.push_back(p);
        if ((dp >= 0) != (dq >= 0)) kept.push_back(p + (dp / (dp - dq)) * (q - p));
      }
      polygon = std::move(kept);
    }
  }
  return polygon;
}

bool inside(const std::array<Vec3, 4>& t, const Vec3& p) {
  const double whole = signed_volume(t[0], t[1], t[2], t[3]);
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<Vec3, 4> with = t;
    with[i] = p;
    if (signed_volume(with[0], with[1], with[2], with[3]) * whole < 0) return false;
  }
  return whole != 0;
}

}  // namespace

std::vector<Vec3> clip_to_box(const std::array<Vec3, 4>& t, const Box3& box) {
  std::vector<Vec3> corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto part = clip_polygon({t[i], t[(i + 1) % 4], t[(i + 2) % 4]}, box);
    corners.insert(corners.end(), part.begin(), part.end());
  }
  for (unsigned c = 0; c < 8; ++c) {
    const Vec3 corner{(c & 1u) != 0 ? box.max.x : box.min.x, (c & 2u) != 0 ? box.max.y : box.min.y,
                      (c & 4u) != 0 ? box.max.z : box.min.z};
    if (inside(t, corner)) corners.push_back(corner);
  }
  return corners;
}

}  // namespace adamas
