// Tests that bodies which the fractions hold and the interfaces do not show are reported.

#include "interfaces/reconstruction/lost_bodies.h"

#include <gtest/gtest.h>

#include "interfaces/reconstruction/reconstruction.h"

namespace adamas {

using namespace interfaces;

namespace {

/// Returns drops in a box of cells of side 0.5: one in two cells that touch at a corner, one in a single
/// cell, and a trace.
MultiMaterialData drops() {
  MultiMaterialData data;
  data.source = "drops";
  for (auto& x : data.grid.nodes) {
    for (int i = 0; i <= 8; ++i) x.push_back(0.5 * i);
  }
  data.materials.push_back("air");
  data.materials.push_back("water");
  data.fractions.assign(2, std::vector<float>(data.grid.site_count(), 0.0f));
  for (float& f : data.fractions[MaterialId(0)]) f = 1;
  const auto drop = [&](std::size_t i, std::size_t j, std::size_t k, float fraction) {
    const std::size_t site = data.grid.site_index(i, j, k);
    data.fractions[MaterialId(1)][site] = fraction;
    data.fractions[MaterialId(0)][site] = 1 - fraction;
  };
  drop(2, 2, 2, 0.25f);
  drop(3, 3, 3, 0.25f);
  drop(5, 2, 6, 0.125f);
  drop(6, 6, 6, 5e-4f);
  return data;
}

/// Takes a material out of a site.
void sink(SiteValues& values, std::size_t site, std::uint16_t material) {
  for (SiteValues::Entry& entry : values.at(site)) {
    if (entry.material == material) entry.value = -values.greatest_value();
  }
}

TEST(LostBodies, AreFoundWhereNothingIsShown) {
  const MultiMaterialData data = drops();
  const auto& grid = data.grid;
  SiteValues values(data);
  const std::uint16_t water = 1;
  for (const std::size_t site :
       {grid.site_index(2, 2, 2), grid.site_index(3, 3, 3), grid.site_index(5, 2, 6)})
    sink(values, site, water);
  std::vector<LostBody> lost = find_lost_bodies(data, values, SiteCells(data.grid));
  ASSERT_EQ(lost.size(), 2u);
  EXPECT_EQ(lost[0].cells, 2u);
  EXPECT_EQ(data.materials[lost[0].material], "water");
  EXPECT_NEAR(lost[0].volume, 0.5 * 0.125, 1e-9);
  EXPECT_NEAR(distance(lost[0].place, {1.5, 1.5, 1.5}), 0, 1e-9);
  EXPECT_EQ(lost[1].cells, 1u);
  EXPECT_NEAR(lost[1].volume, 0.125 * 0.125, 1e-9);
  EXPECT_EQ(lost[0].fraction, 0.25);
  EXPECT_EQ(lost[1].fraction, 0.125);
  EXPECT_NEAR(distance(lost[1].place, {2.75, 1.25, 3.25}), 0, 1e-9);
  // A part in one of the two cells is enough for a body to count as shown.
  for (SiteValues::Entry& entry : values.at(grid.site_index(2, 2, 2)))
    entry.value = entry.material == water ? 0.01 : -0.01;
  lost = find_lost_bodies(data, values, SiteCells(data.grid));
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_EQ(lost[0].cells, 1u);
}

TEST(LostBodies, OneStepOfBytesIsNothing) {
  FractionReport report;
  EXPECT_FALSE(is_one_step(1e-6, report));
  report.step = 1.0 / 255;
  for (const double sum : {0.95, 1.0, 1.05}) {
    EXPECT_TRUE(is_one_step(1 / (255 * sum), report));
    EXPECT_FALSE(is_one_step(2 / (255 * sum), report));
  }
}

/// The correction gives drops a surface: their total volume is right, and none is lost.
TEST(LostBodies, DropsAreShown) {
  const MultiMaterialData data = drops();
  const Reconstruction found(data);
  EXPECT_TRUE(found.lost_bodies().empty());
  EXPECT_GE(found.body_materials().size(), 3u);
  EXPECT_NEAR(found.volume_reconstructed()[MaterialId(1)], found.volume_input()[MaterialId(1)],
              1e-9 * data.grid.domain().volume());
}

}  // namespace
}  // namespace adamas
