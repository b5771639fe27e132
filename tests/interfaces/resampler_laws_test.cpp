#include "tests/interfaces/resampler_scenes.h"
#include "tests/support/hierarchy_checksum.h"

namespace adamas {

using namespace datasets;

namespace {

using test::expect_laws;
using test::ResampledScene;
using test::SceneCase;

SceneCase make_case(const std::string& name, bool meshes, double error) {
  SceneCase c;
  c.name = name;
  c.meshes = meshes;
  c.options.interface_error = error;
  c.options.certify = false;
  return c;
}

/// The parameters are all scenes but `random`, each from meshes and from fractions.
class ResamplerLaws : public testing::TestWithParam<std::tuple<std::string, bool>> {
 protected:
  [[nodiscard]] SceneCase with_error(double error) const {
    return make_case(std::get<0>(GetParam()), std::get<1>(GetParam()), error);
  }
};

class LongResamplerLaws : public ResamplerLaws {};

TEST_P(ResamplerLaws, HoldAtACoarseError) { expect_laws(ResampledScene(with_error(0.1))); }

TEST_P(LongResamplerLaws, HoldAtAFineError) { expect_laws(ResampledScene(with_error(0.02))); }

/// The opposite order of materials, and another number of threads, change nothing.
class LongResamplerOrders : public ResamplerLaws {};

TEST_P(LongResamplerOrders, ChangeNothing) {
  SceneCase c = with_error(0.08);
  c.options.max_tetrahedra = 500;
  const ResampledScene one(c);
  SceneCase other = c;
  other.reversed = true;
  set_thread_limit(1);
  const ResampledScene two(other);
  set_thread_limit(0);
  EXPECT_EQ(test::checksum(one.resampler->hierarchy()), test::checksum(two.resampler->hierarchy()));
  for (const std::string& material : one.source.materials)
    EXPECT_NEAR(one.material_volume(material), two.material_volume(material), 1e-12) << material;
  set_thread_limit(1);
  const ResampledScene three(c);
  const auto found = one.extracted(), again = three.extracted();
  set_thread_limit(0);
  EXPECT_EQ(test::checksum(one.resampler->hierarchy()), test::checksum(three.resampler->hierarchy()));
  EXPECT_EQ(found.mesh.points, again.mesh.points);
  EXPECT_EQ(found.mesh.triangles, again.mesh.triangles);
}

std::string name_of(const testing::TestParamInfo<std::tuple<std::string, bool>>& info) {
  return std::get<0>(info.param) + (std::get<1>(info.param) ? "FromMeshes" : "FromFractions");
}

const auto kFewMaterials = testing::Values("sphere", "shell3", "shell2", "plate", "tjunction", "reflex");
const auto kAll = testing::Values("sphere", "shell3", "shell2", "plate", "tjunction", "reflex", "voronoi10");
INSTANTIATE_TEST_SUITE_P(Scenes, ResamplerLaws, testing::Combine(kFewMaterials, testing::Bool()), name_of);
INSTANTIATE_TEST_SUITE_P(Scenes, LongResamplerOrders, testing::Combine(kFewMaterials, testing::Bool()),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Scenes, LongResamplerLaws, testing::Combine(kAll, testing::Bool()), name_of);

/// Random scenes have planes and spheres, thin layers that end, and triple lines near vertices, edges and
/// faces. A limit on the number of tetrahedra keeps the mesh coarse where layers are thin.
class LongRandomScenes : public testing::TestWithParam<int> {
 protected:
  static constexpr int kSeedsEach = 20;
  static SceneCase random_case(int seed, bool meshes) {
    SceneCase c = make_case("random", meshes, 0.1);
    c.seed = static_cast<std::uint64_t>(seed);
    c.cells = meshes ? 6 : 4;
    c.depth = 1;
    c.options.max_tetrahedra = meshes ? 40 : 150;
    return c;
  }
};

TEST_P(LongRandomScenes, KeepTheLaws) {
  for (int seed = GetParam() * kSeedsEach; seed < (GetParam() + 1) * kSeedsEach; ++seed) {
    const bool meshes = seed % 2 == 0;
    SCOPED_TRACE("seed " + std::to_string(seed) + (meshes ? " from meshes" : " from fractions"));
    const SceneCase c = random_case(seed, meshes);
    // On so coarse a lattice a small shape may leave no triangle.
    if (meshes &&
        scene_interfaces(make_scene(c.name, c.seed), 1.0 / static_cast<double>(c.cells)).triangles.empty())
      continue;
    const ResampledScene resampled(c);
    // Two regions may be equal, but for round-off, over a part of a cell.
    expect_laws(resampled, 1e-9);
    SceneCase other = c;
    other.reversed = true;
    const ResampledScene again(other);
    EXPECT_EQ(test::checksum(resampled.resampler->hierarchy()), test::checksum(again.resampler->hierarchy()));
    for (const std::string& material : resampled.source.materials)
      EXPECT_NEAR(resampled.material_volume(material), again.material_volume(material), 1e-5) << material;
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, LongRandomScenes, testing::Range(0, 6));

}  // namespace
}  // namespace adamas
