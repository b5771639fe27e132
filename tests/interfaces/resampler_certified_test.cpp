#include <algorithm>

#include "tests/interfaces/resampler_scenes.h"
#include "tests/support/surface_distance.h"

namespace adamas {
namespace {

using test::ResampledScene;
using test::SceneCase;

std::vector<test::TriangleIndices> indices(const InterfaceMesh& mesh) {
  std::vector<test::TriangleIndices> result;
  for (const InterfaceTriangle& t : mesh.triangles) result.push_back(t.points);
  return result;
}

/// Reported over measured, by samples on both sides; none where the surfaces are the same but for round-off.
std::optional<double> certified_ratio(const SceneCase& c, std::size_t samples) {
  const ResampledScene resampled(c);
  // The thinnest layers leave no interface in the fractions of a coarse grid.
  if (resampled.source.network->triangles().empty()) return std::nullopt;
  const auto& reported = resampled.resampler->certificate();
  EXPECT_TRUE(reported.has_value());
  if (!reported) return std::nullopt;
  const ExtractedInterfaces found = resampled.extracted();
  const InterfaceNetwork& network = *resampled.source.network;
  const std::vector<Vec3> points(network.points().begin(), network.points().end());
  const std::vector<test::TriangleIndices> triangles(network.triangles().begin(), network.triangles().end());
  const double measured = test::sampled_distance(points, triangles, found.mesh.points, indices(found.mesh),
                                                 resampled.source.box, samples, 1);
  EXPECT_GE(reported->networks.upper, measured * (1 - 1e-9));
  EXPECT_LE(reported->networks.upper, c.options.interface_error * (1 + 1e-12));
  if (measured < 1e-9) return std::nullopt;
  return reported->networks.upper / measured;
}

void expect_certified(bool meshes, const std::vector<double>& errors, std::size_t samples) {
  std::vector<double> ratios;
  for (const std::string name : {"sphere", "shell3", "shell2", "plate", "tjunction", "reflex", "random"}) {
    for (const double error : errors) {
      SCOPED_TRACE(name + (meshes ? " from meshes, error " : " from fractions, error ") +
                   std::to_string(error));
      SceneCase c;
      c.name = name;
      c.seed = 3;
      c.meshes = meshes;
      c.options.interface_error = error;
      if (const auto ratio = certified_ratio(c, samples)) {
        ratios.push_back(*ratio);
        EXPECT_LE(*ratio, 1.3);
      }
    }
  }
  std::sort(ratios.begin(), ratios.end());
  ASSERT_FALSE(ratios.empty());
  EXPECT_LE(ratios[ratios.size() / 2], 1.1);
  std::printf("reported / measured interface error: median %.3f, worst %.3f of %zu\n",
              ratios[ratios.size() / 2], ratios.back(), ratios.size());
}

TEST(LongCertifiedInterfaces, FromMeshes) { expect_certified(true, {0.06}, 100000); }
TEST(LongCertifiedInterfaces, FromFractions) { expect_certified(false, {0.1, 0.03}, 100000); }
TEST(CertifiedInterfaces, CoarseFromMeshes) { expect_certified(true, {0.2}, 1000); }

}  // namespace
}  // namespace adamas
