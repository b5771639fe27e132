#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/data/interface_mesh.h"
#include "core/distance/closest_point_tree.h"

namespace adamas::test {

using Triangles = std::vector<ClosestPointTree::Triangle>;

inline Box3 unit_box() { return {{0, 0, 0}, {1, 1, 1}}; }

inline InterfaceMesh mesh_with_materials(std::size_t count) {
  InterfaceMesh mesh;
  mesh.source = "test mesh";
  for (std::size_t i = 0; i < count; ++i)
    mesh.materials.push_back(std::string(1, static_cast<char>('a' + i)));
  return mesh;
}

/// Adds a sphere that is divided by latitudes and longitudes, its normals outwards.
inline void add_sphere(InterfaceMesh& mesh, const Vec3& center, double radius, MaterialId outside,
                       MaterialId inside, std::uint32_t n = 12) {
  const auto base = static_cast<std::uint32_t>(mesh.points.size());
  const std::uint32_t m = 2 * n;
  mesh.points.push_back(center + Vec3{0, 0, radius});
  for (std::uint32_t i = 1; i < n; ++i) {
    for (std::uint32_t j = 0; j < m; ++j) {
      const double theta = M_PI * i / n, phi = 2 * M_PI * j / m;
      mesh.points.push_back(center + radius * Vec3{std::sin(theta) * std::cos(phi),
                                                   std::sin(theta) * std::sin(phi), std::cos(theta)});
    }
  }
  mesh.points.push_back(center - Vec3{0, 0, radius});
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    if (i == 0) return base;
    if (i == n) return base + 1 + (n - 1) * m;
    return base + 1 + (i - 1) * m + j % m;
  };
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < m; ++j) {
      if (i > 0) mesh.triangles.push_back({{at(i, j), at(i + 1, j), at(i, j + 1)}, outside, inside});
      if (i + 1 < n)
        mesh.triangles.push_back({{at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)}, outside, inside});
    }
  }
}

/// Adds a parallelogram of 2 n^2 triangles, its normal along u x v.
inline void add_patch(InterfaceMesh& mesh, const Vec3& origin, const Vec3& u, const Vec3& v, MaterialId front,
                      MaterialId back, std::uint32_t n = 4) {
  const auto base = static_cast<std::uint32_t>(mesh.points.size());
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j)
      mesh.points.push_back(origin + (1.0 * i / n) * u + (1.0 * j / n) * v);
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = base + i * (n + 1) + j, b = a + n + 1;
      mesh.triangles.push_back({{a, b, b + 1}, front, back});
      mesh.triangles.push_back({{a, b + 1, a + 1}, front, back});
    }
  }
}

inline Triangles triangles_of(const InterfaceMesh& mesh) {
  Triangles triangles;
  for (const InterfaceTriangle& t : mesh.triangles) triangles.push_back(t.points);
  return triangles;
}

inline Vec3 random_point(std::mt19937_64& random, const Box3& box) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double x = unit(random), y = unit(random), z = unit(random);
  const Vec3 s = box.size();
  return box.min + Vec3{x * s.x, y * s.y, z * s.z};
}

/// Returns triangles of all sizes in the unit box; every seventh one is a segment or a point.
inline InterfaceMesh random_soup(std::uint64_t seed, std::size_t count) {
  std::mt19937_64 random(seed);
  InterfaceMesh mesh = mesh_with_materials(2);
  for (std::uint32_t t = 0; t < count; ++t) {
    const Vec3 center = random_point(random, unit_box());
    const double size = std::pow(10.0, -3 * random_point(random, unit_box()).x);
    for (int k = 0; k < 3; ++k) {
      mesh.points.push_back(center + size * (random_point(random, unit_box()) - Vec3{0.5, 0.5, 0.5}));
    }
    if (t % 7 == 3) mesh.points.back() = mesh.points[mesh.points.size() - 2];
    if (t % 7 == 3 && t % 2 == 0)
      mesh.points.back() = mesh.points[mesh.points.size() - 2] = mesh.points[3 * t];
    mesh.triangles.push_back({{3 * t, 3 * t + 1, 3 * t + 2}, MaterialId(0), MaterialId(1)});
  }
  return mesh;
}

}  // namespace adamas::test
