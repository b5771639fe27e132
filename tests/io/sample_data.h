#pragma once

#include <random>

#include "core/data/interface_mesh.h"
#include "core/data/multi_material_data.h"
#include "core/data/unstructured_mesh.h"

namespace adamas::test {

/// Returns two materials and a rest on a small uneven grid, with random fractions that add up to 1 and fields
/// of each kind.
inline MultiMaterialData sample_data(Centering centering, bool even = false) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.1, 1);
  MultiMaterialData data;
  data.grid.centering = centering;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double at = -1.5;
    for (std::size_t i = 0; i < 5 + axis; ++i, at += even ? 0.25 : unit(random))
      data.grid.nodes[axis].push_back(at);
  }
  data.materials = {"Armor Plate", "Body, Nose", "Void"};
  const std::size_t count = data.grid.site_count();
  data.fractions.resize(3);
  for (std::size_t site = 0; site < count; ++site) {
    const double a = unit(random), b = unit(random), c = unit(random);
    data.fractions[MaterialId(0)].push_back(static_cast<float>(a / (a + b + c)));
    data.fractions[MaterialId(1)].push_back(static_cast<float>(b / (a + b + c)));
    data.fractions[MaterialId(2)].push_back(static_cast<float>(c / (a + b + c)));
  }
  const auto values = [&](std::size_t n) {
    std::vector<float> result;
    for (std::size_t i = 0; i < n; ++i) result.push_back(static_cast<float>(10 * unit(random)));
    return result;
  };
  data.fields.resize(3);
  data.fields[0] = {"Pressure", "Pa", 1, values(count), {}};
  data.fields[1] = {"Velocity", "m/s", 3, values(3 * count), {}};
  data.fields[2] = {"Mass", "kg", 1, {}, {values(count), values(count), {}}};
  data.normalise();
  return data;
}

/// Returns the closed surface of a cube with right-hand normals outwards; the front is outside, the back
/// inside.
inline InterfaceMesh cube(const Vec3& low, double side, const std::string& outside,
                          const std::string& inside) {
  InterfaceMesh mesh;
  mesh.source = "cube";
  mesh.materials = {outside, inside};
  for (std::size_t i = 0; i < 8; ++i) {
    mesh.points.push_back(low + side * Vec3{static_cast<double>(i & 1), static_cast<double>(i >> 1 & 1),
                                            static_cast<double>(i >> 2)});
  }
  const std::array<std::array<std::uint32_t, 4>, 6> faces{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& f : faces) {
    mesh.triangles.push_back({{f[0], f[1], f[2]}, MaterialId(0), MaterialId(1)});
    mesh.triangles.push_back({{f[0], f[2], f[3]}, MaterialId(0), MaterialId(1)});
  }
  return mesh;
}

/// Returns the volume of a material that the mesh bounds, by the divergence theorem.
inline double enclosed_volume(const InterfaceMesh& mesh, MaterialId material) {
  double volume = 0;
  for (const InterfaceTriangle& t : mesh.triangles) {
    const double v =
        signed_volume({}, mesh.points[t.points[0]], mesh.points[t.points[1]], mesh.points[t.points[2]]);
    if (t.back == material) volume += v;
    if (t.front == material) volume -= v;
  }
  return volume;
}

}  // namespace adamas::test
