#include "datasets/half_space_clipping.h"

#include <algorithm>

#include "core/base/assert.h"

namespace adamas::datasets {

namespace {

/// Corners in counter-clockwise order, seen from outside.
using Polygon = std::vector<Vec3>;

std::vector<Polygon> box_faces(const Box3& box) {
  std::vector<Polygon> faces;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    Vec3 a = box.min, b = box.min, c = box.min, d = box.min;
    b[u] = c[u] = box.max[u];
    c[v] = d[v] = box.max[v];
    faces.push_back({a, d, c, b});
    for (Vec3* p : {&a, &b, &c, &d}) (*p)[axis] = box.max[axis];
    faces.push_back({a, b, c, d});
  }
  return faces;
}

/// Sorts the points on the cut round their mean, counter-clockwise seen against `inward`.
Polygon cap(std::vector<Vec3> points, const Vec3& inward) {
  Vec3 mean;
  for (const Vec3& p : points) mean += (1 / static_cast<double>(points.size())) * p;
  const Vec3 axis = normalized(-inward);
  const Vec3 other = std::abs(axis.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = normalized(cross(other, axis)), v = cross(axis, u);
  const auto angle = [&](const Vec3& p) { return std::atan2(dot(p - mean, v), dot(p - mean, u)); };
  std::sort(points.begin(), points.end(), [&](const Vec3& p, const Vec3& q) { return angle(p) < angle(q); });
  return points;
}

std::vector<Polygon> clip(const std::vector<Polygon>& faces, const SceneFunction& half_space) {
  std::vector<Polygon> kept;
  std::vector<Vec3> on_cut;
  for (const Polygon& face : faces) {
    Polygon part;
    for (std::size_t c = 0; c < face.size(); ++c) {
      const Vec3 &p = face[c], &q = face[(c + 1) % face.size()];
      const double a = half_space.value(p), b = half_space.value(q);
      if (a >= 0) part.push_back(p);
      if ((a >= 0) == (b >= 0)) continue;
      const Vec3 point = p + (a / (a - b)) * (q - p);
      part.push_back(point);
      on_cut.push_back(point);
    }
    if (part.size() > 2) kept.push_back(std::move(part));
  }
  if (on_cut.size() > 2) kept.push_back(cap(std::move(on_cut), half_space.gradient));
  return kept;
}

}  // namespace

double clipped_volume(const Box3& box, const std::vector<SceneFunction>& half_spaces) {
  std::vector<Polygon> faces = box_faces(box);
  for (const SceneFunction& half_space : half_spaces) {
    ADAMAS_ASSERT(half_space.is_linear());
    faces = clip(faces, half_space);
  }
  double volume = 0;
  for (const Polygon& face : faces) {
    for (std::size_t c = 2; c < face.size(); ++c)
      volume += signed_volume(face[0], face[c - 1], face[c], box.center());
  }
  return -volume;
}

}  // namespace adamas::datasets
