#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "interfaces/network/edge_fans.h"
#include "tests/interfaces/network_meshes.h"

namespace adamas {

using namespace interfaces;

namespace {

/// Returns half planes round the line x = y = 1/2, each in n steps along the line, with materials 0, 1, ...
/// between them. Points on the line are shared.
InterfaceMesh fan(const std::vector<double>& degrees, std::uint32_t n, std::size_t materials) {
  InterfaceMesh mesh = test::mesh_with_materials(materials);
  for (std::uint32_t k = 0; k <= n; ++k) mesh.points.push_back({0.5, 0.5, 1.0 * k / n});
  for (std::uint32_t i = 0; i < degrees.size(); ++i) {
    const double angle = degrees[i] * M_PI / 180;
    const auto base = static_cast<std::uint32_t>(mesh.points.size());
    for (std::uint32_t k = 0; k <= n; ++k)
      mesh.points.push_back({0.5 + 0.5 * std::cos(angle), 0.5 + 0.5 * std::sin(angle), 1.0 * k / n});
    const MaterialId before((i + materials - 1) % materials), after(i % materials);
    for (std::uint32_t k = 0; k < n; ++k) {
      mesh.triangles.push_back({{k, base + k, base + k + 1}, before, after});
      mesh.triangles.push_back({{k, base + k + 1, k + 1}, before, after});
    }
  }
  return mesh;
}

TEST(JunctionLines, AreWhereThreeMaterialsMeet) {
  for (const std::uint32_t n : {1u, 5u}) {
    const auto lines = junction_lines(fan({0, 120, 240}, n, 3));
    ASSERT_EQ(lines.size(), n);
    for (std::uint32_t k = 0; k < n; ++k) EXPECT_EQ(lines[k], (std::array<std::uint32_t, 2>{k, k + 1}));
  }
  EXPECT_EQ(junction_lines(fan({0, 90, 180, 270}, 3, 4)).size(), 3u);
}

TEST(JunctionLines, AreNotWhereTwoMaterialsMeetTwice) {
  EXPECT_TRUE(junction_lines(fan({0, 90, 180, 270}, 3, 2)).empty());
  InterfaceMesh sphere = test::mesh_with_materials(2);
  test::add_sphere(sphere, {0.5, 0.5, 0.5}, 0.3, MaterialId(0), MaterialId(1));
  EXPECT_TRUE(junction_lines(sphere).empty());
  EXPECT_TRUE(junction_lines({}).empty());
}

TEST(JunctionLines, AreTheEdgesWithThreeMaterials) {
  std::mt19937 random(3);
  for (std::size_t round = 0; round < 50; ++round) {
    InterfaceMesh mesh = test::mesh_with_materials(4);
    mesh.points.resize(9);
    std::map<std::array<std::uint32_t, 2>, std::set<MaterialId>> around;
    for (std::size_t t = 0; t < 10 + round; ++t) {
      std::array<std::uint32_t, 3> p{};
      while (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) {
        for (std::uint32_t& i : p) i = static_cast<std::uint32_t>(random() % mesh.points.size());
      }
      // Most triangles lie between the first two materials.
      const std::size_t front = random() % 4, back = (front + 1 + random() % 3) % 4;
      const bool rare = random() % 8 == 0;
      const MaterialId a(rare ? front : 0), b(rare ? back : 1);
      mesh.triangles.push_back({p, a, b});
      for (std::size_t i = 0; i < 3; ++i) {
        const auto [low, high] = std::minmax(p[i], p[(i + 1) % 3]);
        around[{low, high}].insert({a, b});
      }
    }
    std::vector<std::array<std::uint32_t, 2>> expected;
    for (const auto& [edge, materials] : around) {
      if (materials.size() > 2) expected.push_back(edge);
    }
    EXPECT_EQ(junction_lines(mesh), expected);
  }
}

}  // namespace
}  // namespace adamas
