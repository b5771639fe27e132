#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "interfaces/cross_section/cross_section.h"
#include "interfaces/probe/material_integrals.h"
#include "tests/support/hexahedra.h"

namespace adamas::interfaces {
namespace {

/// A cube of hexahedra that are moved, with two materials, a number per cell and x per point.
MeshData scene(std::uint32_t n) {
  MeshData data;
  data.source = "cube";
  data.mesh = test::to_mesh(
      test::make_hexahedra({n, n, n}, [n](const Vec3& p) { return test::jittered(p, 0.2 / n); }));
  data.materials.assign(2, "");
  data.fractions.assign(2, {});
  MeshField of_cells, of_points;
  of_cells.name = "number";
  of_points.name = "x";
  of_points.centering = Centering::kPoints;
  std::vector<float> low, high, numbers, xs;
  for (std::size_t c = 0; c < data.mesh.cell_count(); ++c) {
    const float fraction = static_cast<float>(c % 5) / 4;
    low.push_back(fraction);
    high.push_back(1 - fraction);
    numbers.push_back(static_cast<float>(c));
  }
  for (const Vec3& p : data.mesh.points()) xs.push_back(static_cast<float>(p.x));
  data.fractions[MaterialId(0)] = low;
  data.fractions[MaterialId(1)] = high;
  of_cells.values = numbers;
  of_points.values = xs;
  data.fields = {of_cells, of_points};
  return data;
}

TEST(CellSection, PiecesFillThePlaneAndHaveTheirValues) {
  const MeshData data = scene(5);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Plane> planes{
      {{0.5, 0.5, 0.5}, {0, 0, 1}}, {{0, 0, 0.2}, {0, 0, 1}}, {{0, 0, 0}, {0, 0, 1}}, {{0, 0, 1}, {0, 0, 1}}};
  for (int i = 0; i < 20; ++i)
    planes.push_back(
        {{0.5 + 0.2 * uniform(random), 0.5, 0.5}, {uniform(random), uniform(random), uniform(random)}});
  for (const Plane& plane : planes) {
    const CrossSection section = cross_section(data, plane, FieldChoice{1, {}});
    EXPECT_NEAR(section.area, polygon_area(clip_plane(plane, data.mesh.box())), 1e-9);
    double by_material = 0;
    for (const double area : section.material_area) by_material += area;
    EXPECT_NEAR(by_material, section.area, 1e-6);
    const Vec3 normal = normalized(plane.normal);
    for (const SectionPiece& piece : section.pieces) {
      ASSERT_EQ(piece.values.size(), piece.corners.size());
      for (std::size_t i = 0; i < piece.corners.size(); ++i) {
        EXPECT_NEAR(piece.values[i], piece.corners[i].x, 1e-6);
        EXPECT_NEAR(dot(piece.corners[i] - plane.origin, normal), 0, 1e-9);
      }
      EXPECT_EQ(piece.material.value, data.fraction(MaterialId(1), piece.cell) > 0.5f ? 1u : 0u);
    }
    for (const SectionPiece& piece : cross_section(data, plane, FieldChoice{0, {}}).pieces) {
      for (const double value : piece.values) EXPECT_EQ(value, static_cast<double>(piece.cell));
    }
  }
}

TEST(CellSection, CellEdgesAreTheLinesBetweenCells) {
  MeshData data = scene(4);
  const CrossSection section = cross_section(data, {{0, 0, 0.6}, {0, 0, 1}}, {}, true);
  // 4 x 4 cells and the lines round them, each once.
  EXPECT_EQ(section.pieces.size(), 16u);
  EXPECT_EQ(section.cell_edges.size(), 40u);
  EXPECT_TRUE(cross_section(data, {{0, 0, 0.6}, {0, 0, 1}}, {}, false).cell_edges.empty());
}

TEST(CellIntegrals, AreThoseOfTheSameDataOnAGrid) {
  MeshData data = scene(3);
  data.mesh = test::to_mesh(test::make_hexahedra({3, 3, 3}, [](const Vec3& p) { return p; }));
  MultiMaterialData grid;
  grid.source = "grid";
  for (auto& nodes : grid.grid.nodes) nodes = {0, 1.0 / 3, 2.0 / 3, 1};
  grid.grid.centering = Centering::kCells;
  grid.materials = data.materials;
  grid.fractions = data.fractions;
  grid.fields = {data.fields[0]};
  const auto of_mesh = material_integrals(data, {0.5, 0.5, 0.25}), of_grid = material_integrals(grid);
  ASSERT_EQ(of_mesh.size(), 3u);
  for (MaterialId m(0); m.value < 2; ++m.value) {
    EXPECT_NEAR(of_mesh[m].volume, of_grid[m].volume, 1e-12);
    EXPECT_NEAR(of_mesh[m].integral[0], of_grid[m].integral[0], 1e-9);
    // The values at points of the moved mesh were its x: the mean over a cell is that of its corners.
    EXPECT_TRUE(std::isfinite(of_mesh[m].mean[1]));
  }
  EXPECT_EQ(of_mesh[MaterialId(2)].volume, 0.25);
  EXPECT_TRUE(std::isnan(of_mesh[MaterialId(2)].mean[0]));
}

}  // namespace
}  // namespace adamas::interfaces
