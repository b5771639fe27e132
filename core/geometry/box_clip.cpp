#include "core/geometry/box_clip.h"

namespace adamas::inline core {

namespace {

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

void clip_at_wall(std::vector<Vec3>& polygon, int axis, double wall, double sign,
                  std::vector<Vec3>& scratch) {
  scratch.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double a = sign * (p[axis] - wall), b = sign * (q[axis] - wall);
    if (a <= 0) scratch.push_back(p);
    if ((a < 0 && b > 0) || (a > 0 && b < 0)) {
      scratch.push_back(p + (a / (a - b)) * (q - p));
      scratch.back()[axis] = wall;
    }
  }
  polygon.swap(scratch);
}

void clip_to_box(std::vector<Vec3>& polygon, const Box3& box, std::vector<Vec3>& scratch) {
  for (int axis = 0; axis < 3; ++axis) {
    clip_at_wall(polygon, axis, box.max[axis], 1, scratch);
    clip_at_wall(polygon, axis, box.min[axis], -1, scratch);
  }
}

std::vector<Vec3> clip_to_box(const std::array<Vec3, 4>& t, const Box3& box) {
  std::vector<Vec3> corners, scratch;
  for (std::size_t i = 0; i < 4; ++i) {
    std::vector<Vec3> part{t[i], t[(i + 1) % 4], t[(i + 2) % 4]};
    clip_to_box(part, box, scratch);
    corners.insert(corners.end(), part.begin(), part.end());
  }
  for (const Vec3& corner : box.corners()) {
    if (inside(t, corner)) corners.push_back(corner);
  }
  return corners;
}

}  // namespace adamas::inline core
