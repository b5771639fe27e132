#include "interfaces/resampling/shown_interfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/base/sort_unique.h"
#include "interfaces/resampling/cell_evaluation.h"
#include "interfaces/resampling/refinement.h"
#include "tests/interfaces/resampler_scenes.h"

namespace adamas::interfaces {
namespace {

/// Cells refined to an error whose interfaces are measured for a third of it, so that many are too far.
class CoarseCells {
 public:
  CoarseCells(const std::string& scene, std::uint64_t seed)
      : scene_(datasets::make_scene(scene, seed)),
        mesh_(datasets::scene_interfaces(scene_, 1.0 / 24)),
        source_(make_mesh_source(mesh_, scene_.box(), nullptr)),
        state_(source_, options(), SilentProgress::instance()),
        shown_(state_) {
    evaluate_roots(state_);
    Refinement(state_).refine_to_targets(state_.leaves());
    shown_.set_target(0.04);
    shown_.measure(true);
  }
  CoarseCells(const CoarseCells&) = delete;

  [[nodiscard]] const ShownInterfaces& shown() const { return shown_; }
  [[nodiscard]] const ResamplingState& state() const { return state_; }

 private:
  static ResamplingOptions options() {
    ResamplingOptions options;
    options.interface_error = 0.12;
    return options;
  }

  datasets::Scene scene_;
  InterfaceMesh mesh_;
  ResamplingSource source_;
  ResamplingState state_;
  ShownInterfaces shown_;
};

std::vector<TetrahedronId> ascending(std::vector<TetrahedronId> leaves) {
  sort_unique(leaves);
  return leaves;
}

/// Leaves that are found to fail from what is near them fail where all is measured, and few are missed.
TEST(ShownInterfaces, NewLeavesFailAsAllDo) {
  for (const char* name : {"shell3", "sphere", "random"}) {
    SCOPED_TRACE(name);
    const CoarseCells cells(name, 3);
    const std::vector<TetrahedronId> all = ascending(cells.shown().failing_leaves());
    ASSERT_GT(all.size(), 20u);
    const std::vector<TetrahedronId> leaves = cells.state().leaves();
    const std::vector<TetrahedronId> found = ascending(cells.shown().failing_among(leaves));
    EXPECT_TRUE(std::ranges::includes(all, found));
    EXPECT_GE(10 * found.size(), 9 * all.size());
    // Others near them do not matter for those that are asked for.
    std::vector<TetrahedronId> some;
    for (std::size_t i = 0; i < leaves.size(); i += 7) some.push_back(leaves[i]);
    std::vector<TetrahedronId> of_some;
    std::ranges::set_intersection(found, ascending(some), std::back_inserter(of_some));
    EXPECT_TRUE(std::ranges::includes(ascending(cells.shown().failing_among(some)), of_some));
  }
}

/// The leaves near some are those whose boxes are.
TEST(ShownInterfaces, LeavesNearOthersAreFoundByTheirBoxes) {
  const CoarseCells cells("reflex", 5);
  const ResamplingState& state = cells.state();
  const std::vector<TetrahedronId> leaves = state.leaves();
  std::vector<TetrahedronId> some;
  for (std::size_t i = 3; i < leaves.size(); i += leaves.size() / 5) some.push_back(leaves[i]);
  for (const double reach : {0.0, 0.05, 2.0}) {
    std::vector<TetrahedronId> near;
    for (const TetrahedronId t : leaves) {
      const Box3 box = state.box(t),
                 wide{box.min - Vec3{reach, reach, reach}, box.max + Vec3{reach, reach, reach}};
      if (std::ranges::any_of(some, [&](TetrahedronId s) { return wide.touches(state.box(s)); }))
        near.push_back(t);
    }
    EXPECT_EQ(state.leaves_near(some, reach), near);
  }
}

}  // namespace
}  // namespace adamas::interfaces
