#pragma once

#include <cmath>
#include <cstdint>

#include "adamas/geometry.h"

namespace adamas::interfaces {

/// Points within this distance of a face of the domain, relative to the domain's diagonal, count as on it.
constexpr double kOnDomainFace = 1e-9;

/// Returns the faces of a domain that hold a point, as bits: 1 and 2 for least and greatest x, 4 and 8 for y,
/// 16 and 32 for z.
inline std::uint8_t domain_faces_at(const Box3& domain, const Vec3& p, double tolerance = kOnDomainFace) {
  const double length = tolerance * domain.diagonal();
  unsigned faces = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(p[axis] - domain.min[axis]) <= length) faces |= 1u << (2 * axis);
    if (std::abs(p[axis] - domain.max[axis]) <= length) faces |= 2u << (2 * axis);
  }
  return static_cast<std::uint8_t>(faces);
}

/// Returns whether a point lies inside a domain, farther from its faces than the tolerance.
inline bool is_inside_domain(const Box3& domain, const Vec3& p, double tolerance = kOnDomainFace) {
  const double length = tolerance * domain.diagonal();
  for (int axis = 0; axis < 3; ++axis) {
    if (p[axis] <= domain.min[axis] + length || p[axis] >= domain.max[axis] - length) return false;
  }
  return true;
}

/// Returns the sum of the outward normals of the faces of a domain that hold both points; zero if there are
/// none or `domain` is null.
inline Vec3 outward_of_edge(const Box3* domain, const Vec3& a, const Vec3& b,
                            double tolerance = kOnDomainFace) {
  Vec3 normal;
  if (domain == nullptr) return normal;
  const double length = tolerance * domain->diagonal();
  for (int axis = 0; axis < 3; ++axis) {
    const auto on = [&](double x) {
      return std::abs(a[axis] - x) <= length && std::abs(b[axis] - x) <= length;
    };
    if (on(domain->min[axis])) normal[axis] = -1;
    if (on(domain->max[axis])) normal[axis] = 1;
  }
  return normal;
}

}  // namespace adamas::interfaces
