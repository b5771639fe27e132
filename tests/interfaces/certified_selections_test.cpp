#include "interfaces/selection/certified_selections.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <random>

#include "interfaces/network/interface_network.h"
#include "interfaces/selection/saved_hierarchy_file.h"
#include "interfaces/selection/selection.h"
#include "tests/interfaces/resampler_scenes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

test::SceneCase scene_case(const std::string& name, std::size_t cells, double error, std::uint64_t seed = 0) {
  test::SceneCase c;
  c.name = name;
  c.seed = seed;
  c.cells = cells;
  c.options.interface_error = error;
  return c;
}

/// Returns the distance of a point from a triangle: from its plane where the point lies above it, else from
/// its sides.
double distance_to(const Vec3& p, const std::array<Vec3, 3>& corners) {
  double least = std::numeric_limits<double>::infinity();
  bool inside = true;
  const Vec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = corners[i], side = corners[(i + 1) % 3] - a;
    const double length = dot(side, side);
    const double along = length > 0 ? std::clamp(dot(p - a, side) / length, 0.0, 1.0) : 0.0;
    least = std::min(least, norm(p - (a + along * side)));
    inside = inside && dot(cross(normal, side), p - a) >= 0;
  }
  const double size = norm(normal);
  return inside && size > 0 ? std::min(least, std::abs(dot(normal, p - corners[0])) / size) : least;
}

/// Returns the triangles that bound a material.
std::vector<std::array<Vec3, 3>> boundary(const InterfaceMesh& mesh, MaterialId material) {
  std::vector<std::array<Vec3, 3>> result;
  for (const InterfaceTriangle& t : mesh.triangles) {
    if (t.front != material && t.back != material) continue;
    result.push_back({mesh.points[t.points[0]], mesh.points[t.points[1]], mesh.points[t.points[2]]});
  }
  return result;
}

/// Returns the greatest distance of random points on some triangles from other triangles.
double seen_distance(const std::vector<std::array<Vec3, 3>>& from, const std::vector<std::array<Vec3, 3>>& to,
                     const Box3& box, std::mt19937_64& random) {
  std::uniform_real_distribution<double> part(0, 1);
  double greatest = 0;
  for (int i = 0; i < 100 && !from.empty(); ++i) {
    const auto& t = from[random() % from.size()];
    double a = part(random), b = part(random);
    if (a + b > 1) a = 1 - a, b = 1 - b;
    const Vec3 p = t[0] + a * (t[1] - t[0]) + b * (t[2] - t[0]);
    if (!box.contains(p)) continue;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& other : to) least = std::min(least, distance_to(p, other));
    greatest = std::max(greatest, least);
  }
  return greatest;
}

/// Expects, for any error asked for and each material, that the certified distance is no less than that of
/// random points from the other boundary.
void expect_bounds(std::initializer_list<const char*> scenes, double error) {
  for (const char* const name : scenes) {
    SCOPED_TRACE(name);
    const test::ResampledScene scene(scene_case(name, 8, error, 5));
    const SavedHierarchy hierarchy = take_hierarchy(*scene.resampler);
    hierarchy.validate("saved");
    ASSERT_GE(hierarchy.certificates.size(), 3u);
    const InterfaceMesh input =
        network_mesh(*scene.source.network, scene.source.materials, scene.source.name);
    Selection selection(hierarchy);
    std::mt19937_64 random(17);
    std::uniform_real_distribution<double> power(std::log(error), std::log(0.5));
    for (int i = 0; i < 6; ++i) {
      SelectionTargets targets;
      targets.interface_error = std::exp(power(random));
      selection.select(targets);
      const InterfaceCertificate* certificate = selection.certificate();
      ASSERT_NE(certificate, nullptr);
      EXPECT_LE(certificate->upper(), *targets.interface_error);
      EXPECT_EQ(selection.interface_error(), certificate->upper());
      const ResampledMesh mesh = selection.mesh();
      const InterfaceMesh shown = approximated_interfaces(mesh).mesh;
      for (MaterialId m(0); m.value < mesh.materials.size(); ++m.value) {
        const auto of_input = boundary(input, m), of_mesh = boundary(shown, m);
        EXPECT_LE(seen_distance(of_input, of_mesh, mesh.box, random), certificate->materials.upper);
        EXPECT_LE(seen_distance(of_mesh, of_input, mesh.box, random), certificate->materials.upper);
      }
    }
  }
}

TEST(CertifiedSelections, ErrorsAreBounds) { expect_bounds({"tjunction", "shell3"}, 0.04); }

TEST(LongCertifiedSelections, ErrorsAreBounds) { expect_bounds({"sphere", "reflex", "voronoi10"}, 0.03); }

/// A selected mesh has hardly more tetrahedra than one that is made anew for its error.
TEST(LongCertifiedSelections, MeshesAreAsSmallAsNewOnes) {
  for (const auto& [name, seed] : {std::pair("tjunction", 0),
                                   {"sphere", 0},
                                   {"reflex", 0},
                                   {"plate", 0},
                                   {"shell3", 0},
                                   {"voronoi10", 4},
                                   {"voronoi10", 23}}) {
    SCOPED_TRACE(name);
    const auto number = static_cast<std::uint64_t>(seed);
    const double error = 0.02;
    const test::ResampledScene fine(scene_case(name, 12, error, number));
    const SavedHierarchy hierarchy = take_hierarchy(*fine.resampler);
    for (const double factor : {1.5, 2.5, 4.0}) {
      const test::ResampledScene anew(scene_case(name, 12, factor * error, number));
      Selection selection(hierarchy);
      SelectionTargets targets;
      targets.interface_error = factor * error;
      selection.select(targets);
      EXPECT_LE(selection.interface_error(), factor * error);
      EXPECT_LE(static_cast<double>(selection.size()),
                1.3 * static_cast<double>(anew.resampler->hierarchy().leaf_count()))
          << factor;
    }
  }
}

/// A selection with further splits of a certified mesh was not measured, so it has no certificate; the whole
/// mesh was measured.
TEST(CertifiedSelections, OnlyMeasuredMeshesHaveCertificates) {
  const test::ResampledScene scene(scene_case("tjunction", 8, 0.03));
  const SavedHierarchy hierarchy = take_hierarchy(*scene.resampler);
  Selection selection(hierarchy);
  selection.select({});
  ASSERT_NE(selection.certificate(), nullptr);
  EXPECT_EQ(selection.certificate()->upper(), scene.resampler->certificate()->upper());
  std::size_t certified = 0, others = 0;
  for (std::size_t size = hierarchy.root_count; size < hierarchy.root_count + hierarchy.split_cells.size();
       size += 7) {
    SelectionTargets targets;
    targets.max_tetrahedra = size;
    selection.select(targets);
    ++(selection.certificate() != nullptr ? certified : others);
  }
  EXPECT_GT(others, certified);
}

}  // namespace
}  // namespace adamas
