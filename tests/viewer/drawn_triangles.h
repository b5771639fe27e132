#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <vector>

#include "viewer/contents/material_contents.h"

namespace adamas::test {

using namespace picture;
using namespace viewer;

inline std::unique_ptr<MaterialContents> open_contents(const std::filesystem::path& path) {
  return MaterialContents::open(path.string(), SilentProgress::instance());
}

inline Vec3 in_double(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }
inline Vec3 place(const DrawnMesh& mesh, std::uint32_t vertex) {
  return mesh.origin + in_double(mesh.vertices[vertex].place);
}

/// A triangle that is drawn.
struct Drawn {
  std::array<std::uint32_t, 3> vertices;
  Vec3 middle, normal;
  double area = 0, least_height = 0;
};

inline std::vector<Drawn> triangles(const DrawnMesh& mesh) {
  EXPECT_FALSE(mesh.is_lines);
  EXPECT_EQ(mesh.indices.size() % 3, 0u);
  std::vector<Drawn> all;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    Drawn& drawn = all.emplace_back();
    drawn.vertices = {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
    const Vec3 a = place(mesh, drawn.vertices[0]), b = place(mesh, drawn.vertices[1]),
               c = place(mesh, drawn.vertices[2]);
    const Vec3 turn = cross(b - a, c - a);
    drawn.middle = (1.0 / 3) * (a + b + c);
    drawn.normal = normalized(turn);
    drawn.area = norm(turn) / 2;
    drawn.least_height = norm(turn) / std::max({distance(a, b), distance(b, c), distance(c, a), 1e-30});
  }
  return all;
}

inline double area_of(const SharedMesh& mesh) {
  double sum = 0;
  if (mesh == nullptr) return sum;
  for (const Drawn& t : triangles(*mesh)) sum += t.area;
  return sum;
}

}  // namespace adamas::test
