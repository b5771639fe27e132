// Tests the short ways of the reconstruction from volume fractions: they give what the long ones give.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "datasets/random_numbers.h"
#include "datasets/scene.h"
#include "datasets/scene_sampling.h"
#include "interfaces/reconstruction/cell_volumes.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/normal_equations.h"
#include "interfaces/reconstruction/numbered_entries.h"
#include "interfaces/reconstruction/site_box.h"
#include "interfaces/reconstruction/site_cell.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/sole_owners.h"
#include "tests/support/sheet_fractions.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

MultiMaterialData sampled(const char* scene, double blur) {
  SamplingOptions options;
  options.fields = false;
  options.blur = {.blur = blur};
  return sample_scene(make_scene(scene, 3), {20, 20, 20}, options);
}

/// Compares the cells of sole owners with their measured volumes; returns how many there are.
std::size_t count_sole_owners(const MultiMaterialData& data, const SiteValues& values) {
  const SiteCells cells(data.grid);
  const SoleOwners owners(data.grid, values);
  CellVolumes cell(data.grid, values, cells);
  std::size_t count = 0;
  for (std::size_t site = 0; site < data.grid.site_count(); ++site) {
    if (values.at(site).empty()) continue;
    const std::uint16_t owner = owners.owner(site);
    if (owner == SoleOwners::kNone) continue;
    ++count;
    cell.set_site(site);
    const std::vector<double>& volumes = cell.measure(true);
    EXPECT_TRUE(cell.pairs().empty()) << site;
    for (std::size_t m = 0; m < volumes.size(); ++m)
      EXPECT_EQ(volumes[m], cell.materials()[m].number == values.material_number(owner) ? 1 : 0) << site;
    EXPECT_EQ(cell.greatest_difference(), owners.greatest_difference(site, owner)) << site;
  }
  return count;
}

TEST(SoleOwners, OwnTheirCells) {
  for (const char* scene : {"sphere", "voronoi10", "tjunction"}) {
    SCOPED_TRACE(scene);
    const MultiMaterialData data = sampled(scene, 1);
    SiteValues values(data);
    const std::size_t count = count_sole_owners(data, values);
    EXPECT_GT(count, 100u);
    // Values that are moved at random have fewer.
    RandomNumbers random(7);
    for (SiteValues::Entry& entry : values.entries()) entry.value += random.uniform(-0.1, 0.1);
    EXPECT_LT(count_sole_owners(data, values), count);
  }
}

TEST(SoleOwners, OwnTheirCellsBesideSheets) {
  for (const auto other : {test::OtherSide::kSameMaterial, test::OtherSide::kThirdMaterial}) {
    const MultiMaterialData data = test::sheet_fractions(
        16, 0.6,
        [](const Vec3& p) {
          return norm(p - Vec3{0.5, 0.5, 0.5}) - 0.31;
        },
        other);
    SiteValues values(data);
    ASSERT_TRUE(values.has_regions());
    std::size_t count = count_sole_owners(data, values);
    RandomNumbers random(8);
    for (SiteValues::Entry& entry : values.entries()) {
      if (random.uniform(0, 1) < 0.5) entry.value += 0.2;
    }
    count += count_sole_owners(data, values);
    // One region is above all others everywhere.
    const std::uint16_t greatest =
        std::ranges::max_element(values.entries(), {}, &SiteValues::Entry::material)->material;
    for (SiteValues::Entry& entry : values.entries()) entry.value = entry.material == greatest ? 1 : -0.1;
    count += count_sole_owners(data, values);
    EXPECT_GT(count, 0u);
  }
}

/// Materials that are nowhere change nothing, even if they are so many that no bits mark them.
TEST(SiteValues, AreThoseOfFewMaterials) {
  const MultiMaterialData few = sampled("voronoi10", 0.7);
  MultiMaterialData many = few;
  for (int n = 0; n < 20; ++n) {
    many.materials.push_back("~nowhere " + std::to_string(n));
    many.fractions.emplace_back(few.grid.site_count(), 0.0f);
  }
  const SiteValues a = SiteValues::fractions(few), b = SiteValues::fractions(many);
  ASSERT_EQ(a.mixed_sites(), b.mixed_sites());
  ASSERT_EQ(a.entries().size(), b.entries().size());
  for (std::size_t site = 0; site < few.grid.site_count(); ++site) {
    ASSERT_EQ(a.at(site).size(), b.at(site).size());
    for (std::size_t e = 0; e < a.at(site).size(); ++e) {
      ASSERT_EQ(a.at(site)[e].material, b.at(site)[e].material);
      ASSERT_EQ(a.at(site)[e].fraction, b.at(site)[e].fraction);
    }
  }
}

TEST(DiffusionNeeds, TargetsGetWhatTheWholeBoxGives) {
  const RectilinearGrid grid =
      RectilinearGrid::uniform({45, 19, 23}, {0, 0, 0}, {1, 1, 1}, Centering::kPoints);
  const SiteBox box(grid, {0, 0, 0}, {45, 19, 23});
  RandomNumbers random(9);
  std::vector<float> values(box.size());
  for (float& value : values) value = static_cast<float>(random.uniform(0, 1));
  std::vector<DiffusionNeeds::Target> targets;
  for (int n = 0; n < 40; ++n) {
    targets.push_back({static_cast<std::size_t>(random.uniform(0, 1) * static_cast<double>(box.size() - 1)),
                       static_cast<std::uint16_t>(1 + n % 9)});
  }
  const DiffusionNeeds needs({45, 19, 23}, targets);
  std::vector<float> now = values, next, whole = values, scratch, other_scratch;
  std::size_t ranges = 0;
  for (std::size_t steps = 0; steps < 9; ++steps) {
    box.diffuse(now, 0.25, &needs, steps, next);
    now.swap(next);
    box.diffuse(whole, 0.25, other_scratch);
    for (const DiffusionNeeds::Target& target : targets) {
      if (target.last >= steps + 1) {
        ASSERT_EQ(now[target.place], whole[target.place]) << steps;
      }
    }
  }
  needs.for_each_range(0, 9, [&](std::size_t, std::size_t) { ++ranges; });
  EXPECT_LE(ranges, 3u);
}

TEST(SiteBox, DilationMarksWhatIsNear) {
  const RectilinearGrid grid = RectilinearGrid::uniform({13, 7, 9}, {0, 0, 0}, {1, 1, 1}, Centering::kPoints);
  const SiteBox box(grid, {0, 0, 0}, {13, 7, 9});
  RandomNumbers random(2);
  for (const int reach : {0, 1, 3}) {
    std::vector<std::uint8_t> marks(box.size());
    for (std::uint8_t& mark : marks) mark = random.chance(0.01) ? 1 : 0;
    std::vector<std::uint8_t> dilated = marks;
    box.dilate(dilated, reach);
    const GridSites sites(grid);
    for (std::size_t place = 0; place < marks.size(); ++place) {
      bool near = false;
      sites.for_each_within(place, static_cast<std::size_t>(reach),
                            [&](std::size_t other, int, int, int) { near = near || marks[other] != 0; });
      ASSERT_EQ(dilated[place] != 0, near) << place;
    }
  }
}

/// Parts of a box that reach far enough beyond its sites give what the whole box gives.
TEST(SiteBox, PartsWithAMarginAreThoseOfTheWhole) {
  const RectilinearGrid grid = RectilinearGrid::uniform({21, 17, 19}, {0, 0, 0}, {1, 0.8, 1.2});
  const SiteBox box(grid, {1, 0, 2}, {20, 17, 19});
  RandomNumbers random(10);
  std::vector<float> values(grid.site_count());
  for (float& value : values) value = static_cast<float>(random.uniform(0, 1));
  const auto blended = [&](const SiteBox& within) {
    std::vector<float> own(within.size()), squared, widened, scratch;
    within.for_each([&](std::size_t place, std::size_t site) { own[place] = values[site]; });
    within.squared_gradient(own, squared, widened);
    for (int n = 0; n < 3; ++n) within.blend(squared, 0.25, scratch);
    return squared;
  };
  const std::vector<float> whole = blended(box);
  const SiteBox part = box.part({7, 7, 7}, 7, 4);
  const std::vector<float> found = blended(part);
  std::size_t checked = 0;
  for (std::size_t k = 7; k < 14; ++k) {
    for (std::size_t j = 7; j < 14; ++j) {
      for (std::size_t i = 7; i < 14; ++i, ++checked) {
        const std::size_t site = grid.site_index(1 + i, j, 2 + k);
        ASSERT_EQ(found[part.place(site)], whole[box.place(site)]);
      }
    }
  }
  EXPECT_EQ(checked, 343u);
}

TEST(NumberedEntries, AreNumberedInOrder) {
  NumberedEntries entries(1000);
  std::vector<std::size_t> chosen;
  for (std::size_t e = 0; e < 1000; e += 1 + e % 7) {
    chosen.push_back(e);
    entries.add(e);
  }
  entries.number_all();
  EXPECT_EQ(entries.size(), chosen.size() + 1);
  std::uint32_t next = 1;
  for (std::size_t e = 0; e < 1000; ++e) {
    const bool is_chosen = std::ranges::binary_search(chosen, e);
    EXPECT_EQ(entries.number(e), is_chosen ? next : 0);
    next += is_chosen ? 1 : 0;
  }
}

TEST(NormalEquations, AreThoseOfRankUpdates) {
  RandomNumbers random(11);
  std::vector<std::array<double, 10>> terms(57);
  std::vector<double> weights(terms.size());
  Eigen::Matrix<double, 10, 10> found = Eigen::Matrix<double, 10, 10>::Zero(), wanted = found;
  for (std::size_t n = 0; n < terms.size(); ++n) {
    weights[n] = random.uniform(0, 1);
    for (double& term : terms[n]) term = random.uniform(-1, 1);
    const Eigen::Map<const Eigen::Matrix<double, 10, 1>> own(terms[n].data());
    wanted.selfadjointView<Eigen::Lower>().rankUpdate(own, weights[n]);
  }
  sum_squares<10>(
      terms.size(), [&](std::size_t n) { return terms[n].data(); }, [&](std::size_t n) { return weights[n]; },
      found);
  for (int j = 0; j < 10; ++j) {
    for (int i = j; i < 10; ++i) EXPECT_EQ(found(i, j), wanted(i, j));
  }
}

}  // namespace

}  // namespace adamas
