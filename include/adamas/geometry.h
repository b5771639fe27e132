#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "adamas/export.h"

namespace adamas ADAMAS_API {

/// A point or vector in space.
struct Vec3 {
  double x = 0, y = 0, z = 0;

  constexpr double& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr Vec3& operator+=(const Vec3& b) { return x += b.x, y += b.y, z += b.z, *this; }
  constexpr Vec3& operator-=(const Vec3& b) { return x -= b.x, y -= b.y, z -= b.z, *this; }
  constexpr Vec3& operator*=(double s) { return x *= s, y *= s, z *= s, *this; }
  constexpr bool operator==(const Vec3&) const = default;
};

constexpr Vec3 operator+(Vec3 a, const Vec3& b) { return a += b; }
constexpr Vec3 operator-(Vec3 a, const Vec3& b) { return a -= b; }
constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(double s, Vec3 a) { return a *= s; }
constexpr Vec3 operator*(Vec3 a, double s) { return a *= s; }
constexpr double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
constexpr double squared_norm(const Vec3& a) { return dot(a, a); }
inline double norm(const Vec3& a) { return std::sqrt(squared_norm(a)); }
inline double distance(const Vec3& a, const Vec3& b) { return norm(a - b); }
inline bool is_finite(const Vec3& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
/// Returns the unit vector of this direction; the zero vector stays zero.
inline Vec3 normalized(const Vec3& a) {
  const double length = norm(a);
  return length > 0 ? (1 / length) * a : a;
}
/// Returns the volume of a tetrahedron, positive where it is positively oriented.
constexpr double signed_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return dot(cross(b - a, c - a), d - a) / 6;
}

/// An axis-aligned box; empty when min > max.
struct Box3 {
  Vec3 min{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
           std::numeric_limits<double>::infinity()};
  Vec3 max{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
           -std::numeric_limits<double>::infinity()};

  [[nodiscard]] constexpr Vec3 size() const { return max - min; }
  [[nodiscard]] constexpr Vec3 center() const { return 0.5 * (min + max); }
  [[nodiscard]] double diagonal() const { return norm(size()); }
  [[nodiscard]] constexpr double volume() const {
    const Vec3 s = size();
    return s.x * s.y * s.z;
  }
  /// Returns one of the eight corners; the bits 1, 2, 4 of its number say where it has the greater x, y, z.
  [[nodiscard]] constexpr Vec3 corner(unsigned c) const {
    return {(c & 1u) != 0 ? max.x : min.x, (c & 2u) != 0 ? max.y : min.y, (c & 4u) != 0 ? max.z : min.z};
  }
  [[nodiscard]] constexpr std::array<Vec3, 8> corners() const {
    std::array<Vec3, 8> all;
    for (unsigned c = 0; c < 8; ++c) all[c] = corner(c);
    return all;
  }
  [[nodiscard]] constexpr bool contains(const Vec3& p) const {
    return p.x >= min.x && p.x <= max.x && p.y >= min.y && p.y <= max.y && p.z >= min.z && p.z <= max.z;
  }
  [[nodiscard]] constexpr bool touches(const Box3& other) const {
    return min.x <= other.max.x && min.y <= other.max.y && min.z <= other.max.z && max.x >= other.min.x &&
           max.y >= other.min.y && max.z >= other.min.z;
  }
  constexpr void extend(const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis) {
      if (p[axis] < min[axis]) min[axis] = p[axis];
      if (p[axis] > max[axis]) max[axis] = p[axis];
    }
  }
};

/// A plane in space: a point of it and a vector at right angles to it, of any length.
struct Plane {
  Vec3 origin;
  Vec3 normal;

  /// Returns the axis (0, 1, 2) that the normal is parallel to; none where there is no such axis.
  [[nodiscard]] std::optional<int> axis() const;
};

/// Reads a plane at right angles to an axis from a text like "x=6" or "z = -1.5e3". Throws Error for other
/// texts.
Plane parse_plane(std::string_view text);

/// Returns a text of a plane for messages: "x=6", or origin and normal.
std::string to_string(const Plane& plane);

}  // namespace adamas
