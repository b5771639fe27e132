#pragma once

#include "adamas/geometry.h"

namespace adamas::inline core {

inline double distance(const Vec3& a, const Vec3& b) { return norm(a - b); }
/// Unit vector; the zero vector stays zero.
inline Vec3 normalized(const Vec3& a) {
  const double length = norm(a);
  return length > 0 ? (1 / length) * a : a;
}
/// Six times the signed volume of the tetrahedron is `dot(cross(b - a, c - a), d - a)`; this is the volume
/// itself.
constexpr double signed_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return dot(cross(b - a, c - a), d - a) / 6;
}

}  // namespace adamas::inline core
