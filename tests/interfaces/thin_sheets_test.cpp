// Tests that sheets thinner than a cell and a half are whole and closed, and have their volumes in each cell.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "datasets/random_numbers.h"
#include "datasets/scene.h"
#include "datasets/scene_sampling.h"
#include "interfaces/network/body_topology.h"
#include "interfaces/reconstruction/reconstruction.h"
#include "interfaces/reconstruction/sheet_fit.h"
#include "tests/support/closed_reconstruction.h"
#include "tests/support/sheet_fractions.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

void expect_closed(const Reconstruction& found, const MultiMaterialData& data) {
  const Box3 box = data.grid.domain();
  test::expect_closed(found, box);
  for (MaterialId m(0); m.value < data.materials.size(); ++m.value)
    EXPECT_NEAR(found.volume_reconstructed()[m], found.volume_input()[m], 1e-9 * box.volume());
}

double part_off(const Reconstruction& found) {
  return static_cast<double>(found.agreement().cells_off) /
         static_cast<double>(found.agreement().mixed_cells);
}

/// Returns the Euler characteristics of the boundaries of a material's bodies, in ascending order.
std::vector<long> characteristics(const Reconstruction& found, const MultiMaterialData& data,
                                  std::uint32_t m) {
  InterfaceMesh mesh = found.mesh();
  const auto& materials = found.body_materials();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    mesh.triangles[t].front = MaterialId(found.bodies()[t][0].value);
    mesh.triangles[t].back = MaterialId(found.bodies()[t][1].value);
  }
  const auto topology = body_topology(mesh, materials.size(), data.grid.domain());
  std::vector<long> result;
  for (BodyId b(0); b.value < materials.size(); ++b.value) {
    if (materials[b].value == m) result.push_back(static_cast<long>(topology[b].euler));
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Layers are found from their fractions. Only the place of a thin one that lies within one row of cells is
/// not determined; the fractions are right all the same.
TEST(ThinSheets, LayersAreFittedAsTheyAre) {
  RandomNumbers random(5);
  int exact = 0;
  for (int turn = 0; turn < 200; ++turn) {
    const Vec3 n = normalized({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    const Slab layer{n, random.uniform(-0.4, 0.4), random.uniform(0.1, 1.0)};
    SheetWindow window(false);
    std::ranges::fill(window.known, 1);
    for (std::size_t c = 0; c < window.cells; ++c)
      window.fraction[c] = static_cast<float>(layer.part_of_cell(window.place(c)));
    const auto guess = guess_sheet(window);
    ASSERT_TRUE(guess);
    double off = 0;
    const auto found = fit_sheet(window, *guess, off);
    ASSERT_TRUE(found);
    const double sign = dot(found->normal, n) < 0 ? -1 : 1;
    exact += sign * dot(found->normal, n) > 0.999 && std::abs(sign * found->offset - layer.offset) < 0.03 &&
                     std::abs(found->thickness - layer.thickness) < 0.03
                 ? 1
                 : 0;
    for (std::size_t c = 0; c < window.cells; ++c) {
      const Vec3 p = window.place(c);
      if (squared_norm(p) > 3.5) continue;
      EXPECT_NEAR(found->part_of_cell(p), layer.part_of_cell(p), 0.1);
    }
  }
  EXPECT_GE(exact, 190);
}

/// Blurred layers are found too, with the widths of their blur, also where their greatest fraction is far
/// below one half.
TEST(ThinSheets, BlurredLayersAreFittedAsTheyAre) {
  RandomNumbers random(6);
  for (int turn = 0; turn < 100; ++turn) {
    const Vec3 n = normalized({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    const Slab layer{n, random.uniform(-0.4, 0.4), random.uniform(0.3, 1.5), random.uniform(0.55, 1.6)};
    SheetWindow window(true);
    std::ranges::fill(window.known, 1);
    for (std::size_t c = 0; c < window.cells; ++c)
      window.fraction[c] = static_cast<float>(layer.part_of_cell(window.place(c)));
    const auto guess = guess_sheet(window);
    ASSERT_TRUE(guess) << turn << " " << layer.thickness << " " << layer.width << " " << layer.offset;
    double off = 0;
    const auto found = fit_sheet(window, *guess, off);
    ASSERT_TRUE(found) << turn;
    const double sign = dot(found->normal, n) < 0 ? -1 : 1;
    EXPECT_GT(sign * dot(found->normal, n), 0.999);
    EXPECT_NEAR(sign * found->offset, layer.offset, 0.03);
    EXPECT_NEAR(found->thickness, layer.thickness, 0.1);
    EXPECT_NEAR(found->width, layer.width, 0.1);
    EXPECT_LT(off, 0.02);
  }
}

/// Neither a ball nor the half of a row of cells is a sheet.
TEST(ThinSheets, OtherShapesAreNone) {
  for (const double level : {-1.0, -0.3, 0.0, 0.4, 1.0}) {
    SheetWindow half(false), rod(false);
    std::ranges::fill(half.known, 1), std::ranges::fill(rod.known, 1);
    for (std::size_t c = 0; c < half.cells; ++c) {
      const Vec3 p = half.place(c);
      half.fraction[c] = static_cast<float>(std::clamp(level - p.z + 0.5, 0.0, 1.0));
      rod.fraction[c] = p.x == 0 && p.y == 0 ? 0.5f : 0.0f;
    }
    for (SheetWindow window : {half, rod}) {
      const auto guess = guess_sheet(window);
      double off = 0;
      EXPECT_FALSE(guess && fit_sheet(window, *guess, off)) << level;
    }
  }
}

/// A shell is closed and one body, and both its sides are spheres, whether the materials inside and outside
/// are equal or not.
TEST(ThinSheets, ShellsAreWhole) {
  for (const auto& [name, n, most_off] : {std::tuple{"shell2", 44, 0.03}, {"shell3", 32, 0.06}}) {
    SCOPED_TRACE(std::string(name) + ' ' + std::to_string(n));
    const auto cells = static_cast<std::size_t>(n);
    const MultiMaterialData data = sample_scene(make_scene(name), {cells, cells, cells}, {3, false});
    std::uint32_t shell = 0;
    while (data.materials[MaterialId(shell)] != "shell") ++shell;
    const Reconstruction found(data);
    EXPECT_EQ(found.body_materials().size(), 3u);
    EXPECT_EQ(characteristics(found, data, shell), std::vector<long>{4});
    expect_closed(found, data);
    EXPECT_LT(part_off(found), most_off);
  }
}

/// The two sides of a sheet meet where it ends, and it has no holes.
TEST(ThinSheets, PlatesEnd) {
  for (const std::size_t n : {16, 32}) {
    const MultiMaterialData data = sample_scene(make_scene("plate"), {n, n, n}, {3, false});
    const Reconstruction found(data);
    EXPECT_EQ(found.body_materials().size(), 2u) << n;
    expect_closed(found, data);
    EXPECT_LT(part_off(found), 0.05) << n;
    for (std::uint32_t m = 0; m < 2; ++m)
      EXPECT_EQ(characteristics(found, data, m), std::vector<long>{2}) << n;
  }
}

TEST(ThinSheets, HollowTori) {
  const std::size_t n = 32;
  for (const double cells : {0.4, 0.7}) {
    const MultiMaterialData data = test::sheet_fractions(n, cells, [&](const Vec3& p) {
      const double r = std::hypot(p.x - 0.5, p.y - 0.5) - 0.28;
      return std::hypot(r, p.z - 0.5) - 0.15;
    });
    const Reconstruction found(data);
    EXPECT_EQ(found.body_materials().size(), 3u) << cells;
    EXPECT_EQ(characteristics(found, data, 1), std::vector<long>{0}) << cells;
    expect_closed(found, data);
    EXPECT_LT(part_off(found), 0.1) << cells;
  }
}

/// There are two sheets, three cells apart, across the whole domain.
TEST(ThinSheets, ParallelSheetsStayApart) {
  const std::size_t n = 24;
  const Vec3 normal = normalized({0.3, 0.5, 0.81});
  const double h = 1.0 / n;
  const MultiMaterialData data = test::sheet_fractions(n, 0.6, [&](const Vec3& p) {
    const double d = dot(normal, p);
    return std::min(std::abs(d - 0.7), std::abs(d - 0.7 - 3 * h));
  });
  const Reconstruction found(data);
  EXPECT_EQ(found.body_materials().size(), 5u);
  expect_closed(found, data);
  EXPECT_LT(part_off(found), 0.05);
}

/// The order of materials changes nothing.
TEST(ThinSheets, AnyOrderOfMaterials) {
  const std::size_t n = 24;
  const MultiMaterialData data = sample_scene(make_scene("plate"), {n, n, n}, {3, false});
  MultiMaterialData turned = data;
  std::swap(turned.materials[MaterialId(0)], turned.materials[MaterialId(1)]);
  std::swap(turned.fractions[MaterialId(0)], turned.fractions[MaterialId(1)]);
  const Reconstruction one(data), other(turned);
  ASSERT_EQ(one.mesh().points.size(), other.mesh().points.size());
  for (std::size_t p = 0; p < one.mesh().points.size(); ++p)
    ASSERT_EQ(distance(one.mesh().points[p], other.mesh().points[p]), 0);
}

}  // namespace
}  // namespace adamas
