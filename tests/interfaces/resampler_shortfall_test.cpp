#include <gtest/gtest.h>

#include <cmath>

#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/resample_figures.h"
#include "interfaces/resampling/resampler.h"
#include "tests/interfaces/resampler_scenes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

using test::ResampledScene;
using test::SceneCase;

/// Returns the distance of a point from the other one of the two networks: from the input's where the point
/// lies on the mesh's.
double distance_to_the_other(const ResampledScene& scene, const Vec3& p) {
  const InterfaceNetwork& network = *scene.source.network;
  const InterfaceMesh shown = approximated_interfaces(*scene.resampler).mesh;
  std::vector<ClosestPointTree::Triangle> triangles;
  for (const InterfaceTriangle& t : shown.triangles) triangles.push_back(t.points);
  const ClosestPointTree mesh(shown.points, triangles);
  const double to_input = std::sqrt(network.tree().closest(p)->squared_distance);
  const double to_mesh = std::sqrt(mesh.closest(p)->squared_distance);
  EXPECT_LT(std::min(to_input, to_mesh), 1e-9) << "the place lies on neither";
  return std::max(to_input, to_mesh);
}

TEST(Shortfall, OfABudgetNamesItAndThePlace) {
  SceneCase c;
  c.name = "voronoi10";
  c.options.interface_error = 0.01;
  c.options.max_tetrahedra = 1200;
  const ResampledScene scene(c);
  const auto shortfall = interface_shortfall(*scene.resampler, scene.resampler->certificate()->networks);
  ASSERT_TRUE(shortfall);
  EXPECT_NE(shortfall->reason.find("1200"), std::string::npos);
  EXPECT_NEAR(distance_to_the_other(scene, shortfall->place), scene.resampler->certificate()->networks.lower,
              1e-9);
}

TEST(Shortfall, IsNoneWhereTheErrorWasReached) {
  SceneCase c;
  c.name = "sphere";
  c.options.interface_error = 0.05;
  const ResampledScene scene(c);
  EXPECT_FALSE(interface_shortfall(*scene.resampler, scene.resampler->certificate()->networks));
  EXPECT_EQ(scene.resampler->interface_end(), RefinementEnd::kReached);
  EXPECT_NEAR(distance_to_the_other(scene, scene.resampler->certificate()->networks.worst),
              scene.resampler->certificate()->networks.lower, 1e-9);
}

TEST(Shortfall, OfAFieldLiesAtTheElementWithTheGreatestError) {
  SceneCase c;
  c.name = "sphere";
  c.fields = true;
  c.cells = 10;
  c.options.interface_error = 0.05;
  c.options.max_tetrahedra = 1500;
  // The fields are constant, linear and smooth, and the same three as mixed fields.
  c.options.field_errors = {1e-3, 1e-3, 1e-3, std::nullopt, 1e-3, 1e-3};
  const ResampledScene scene(c);
  const Resampler& resampler = *scene.resampler;
  std::size_t missed = 0;
  for (std::size_t f = 0; f < scene.source.fields->fields().size(); ++f) {
    FieldError all;
    resampler.hierarchy().for_each_leaf(
        [&](TetrahedronId t) { all.add(resampler.hierarchy().payload(t).fields[f]); });
    const auto shortfall = field_shortfall(resampler, f, all);
    const auto& target = resampler.options().field_errors[f];
    EXPECT_EQ(shortfall.has_value(), target && all.max > *target);
    if (!shortfall) continue;
    ++missed;
    EXPECT_FALSE(shortfall->reason.empty());
    const CellRecord& cell = resampler.hierarchy().payload(resampler.leaf_at(shortfall->place));
    EXPECT_NEAR(cell.fields[f].max, all.max, 1e-12);
  }
  EXPECT_GT(missed, 0u);
}

}  // namespace
}  // namespace adamas
