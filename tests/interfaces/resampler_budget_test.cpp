#include "tests/interfaces/resampler_scenes.h"
#include "tests/support/hierarchy_checksum.h"

namespace adamas {

using namespace interfaces;

namespace {

using test::ResampledScene;
using test::SceneCase;

SceneCase within(const std::string& scene, bool meshes, std::size_t most, bool fields) {
  SceneCase c;
  c.name = scene;
  c.meshes = meshes;
  c.fields = fields;
  c.options.interface_error = 0.002;
  c.options.certify = false;
  c.options.max_tetrahedra = most;
  if (fields) c.options.field_errors = {0.001, 0.001, 0.001, 0.001, 0.001, 0.001};
  return c;
}

bool all_within(const Resampler& resampler) {
  bool within = true;
  resampler.hierarchy().for_each_leaf([&](TetrahedronId t) {
    const CellRecord& cell = resampler.hierarchy().payload(t);
    within = within && cell.interface.distance <= resampler.options().interface_error;
    for (std::size_t f = 0; f < cell.fields.size(); ++f) {
      const auto& target = resampler.options().field_errors[f];
      within = within && (!target || cell.fields[f].max <= *target);
    }
  });
  return within;
}

/// Returns whether every diamond that is split in the coarse hierarchy is split in the fine one.
bool is_coarsening(const HierarchyTopology& coarse, const HierarchyTopology& fine) {
  bool result = true;
  coarse.for_each_diamond(
      [&](DiamondId d) { result = result && (!coarse.is_split(d) || fine.is_split(coarse.lattice(d))); });
  return result;
}

/// Checks meshes for several budgets. With `grows` the mesh of each budget has to be a coarsening of the
/// next. This does not hold where an element's error depends on the cells round its own, and so on the time
/// when it was measured.
void expect_budgets(const std::string& scene, bool meshes, bool fields,
                    const std::vector<std::size_t>& budgets, bool grows = true) {
  std::unique_ptr<ResampledScene> last;
  for (const std::size_t most : budgets) {
    SCOPED_TRACE(scene + " " + std::to_string(most));
    auto now = std::make_unique<ResampledScene>(within(scene, meshes, most, fields));
    const auto& hierarchy = now->resampler->hierarchy();
    EXPECT_LE(hierarchy.leaf_count(), most);
    if (!all_within(*now->resampler)) {
      EXPECT_GE(static_cast<double>(hierarchy.leaf_count()), 0.9 * static_cast<double>(most));
    }
    if (last && grows) {
      EXPECT_TRUE(is_coarsening(last->resampler->hierarchy(), hierarchy));
    }
    last = std::move(now);
  }
}

TEST(ResamplerBudget, IsKeptUsedAndGrowsTheSameMesh) {
  expect_budgets("sphere", true, false, {100, 200, 400, 1600});
  expect_budgets("voronoi10", false, false, {1000, 2000, 4000});
  expect_budgets("plate", false, false, {1000, 2000});
}

TEST(ResamplerBudget, OfFieldsIsKeptAndUsed) { expect_budgets("reflex", true, true, {200, 400, 800}, false); }

TEST(LongResamplerBudget, IsKeptUsedAndGrowsTheSameMesh) {
  expect_budgets("shell3", true, false, {1000, 2000, 4000});
  expect_budgets("sphere", false, true, {1000, 2000, 4000});
}

TEST(ResamplerBudget, TheSameMeshOnAnyNumberOfThreads) {
  for (const std::size_t most : {150, 900}) {
    set_thread_limit(1);
    const ResampledScene one(within("shell2", true, most, true));
    set_thread_limit(2);
    const ResampledScene two(within("shell2", true, most, true));
    set_thread_limit(0);
    EXPECT_EQ(test::checksum(one.resampler->hierarchy()), test::checksum(two.resampler->hierarchy()));
    EXPECT_EQ(one.resampler->hierarchy().leaf_count(), two.resampler->hierarchy().leaf_count());
  }
}

}  // namespace
}  // namespace adamas
