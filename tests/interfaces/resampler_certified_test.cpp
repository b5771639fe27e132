#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/resampling/resampler.h"
#include "tests/interfaces/resampler_scenes.h"
#include "tests/support/surface_distance.h"

namespace adamas {

using namespace interfaces;

namespace {

using test::ResampledScene;
using test::SceneCase;

std::vector<test::TriangleIndices> indices(const InterfaceMesh& mesh) {
  std::vector<test::TriangleIndices> result;
  for (const InterfaceTriangle& t : mesh.triangles) result.push_back(t.points);
  return result;
}

/// Returns the certified distance divided by the one that is sampled on both sides; none where the surfaces
/// are the same up to round-off.
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

/// Returns the triangles that bound a material, of a mesh with the source's materials.
std::vector<test::TriangleIndices> boundary(const InterfaceMesh& mesh, MaterialId material) {
  std::vector<test::TriangleIndices> result;
  for (const InterfaceTriangle& t : mesh.triangles) {
    if (t.front == material || t.back == material) result.push_back(t.points);
  }
  return result;
}

/// Returns the edges round which three materials meet, as triangles without area. They are found by a
/// comparison of all triangles' edges.
std::vector<test::TriangleIndices> junctions(const InterfaceMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<std::uint32_t>> round;
  for (const InterfaceTriangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto edge = std::minmax(t.points[i], t.points[(i + 1) % 3]);
      round[{edge.first, edge.second}].insert({t.front.value, t.back.value});
    }
  }
  std::vector<test::TriangleIndices> result;
  for (const auto& [edge, materials] : round) {
    if (materials.size() > 2) result.push_back({edge.first, edge.second, edge.second});
  }
  return result;
}

/// Returns the greatest distance of points along the junction lines of one mesh from those of the other, both
/// ways.
double sampled_line_distance(const InterfaceMesh& a, const InterfaceMesh& b) {
  double greatest = 0;
  const auto one_way = [&](const InterfaceMesh& from, const InterfaceMesh& to) {
    const auto lines = junctions(from);
    const test::SurfaceGrid others(to.points, junctions(to));
    for (const auto& line : lines) {
      for (int i = 0; i <= 20; ++i) {
        const Vec3 p = from.points[line[0]] + (i / 20.0) * (from.points[line[1]] - from.points[line[0]]);
        greatest = std::max(greatest, others.distance(p));
      }
    }
  };
  one_way(a, b);
  one_way(b, a);
  return greatest;
}

/// Expects that each material's own boundary and the junction lines are as near as is certified, and within
/// the target.
void expect_certified_per_material(const SceneCase& c, std::size_t samples) {
  const ResampledScene resampled(c);
  const auto& certificate = resampled.resampler->certificate();
  ASSERT_TRUE(certificate);
  const InterfaceMesh shown = approximated_interfaces(*resampled.resampler).mesh;
  const InterfaceMesh input = network_mesh(*resampled.source.network, resampled.source.materials, "");
  double measured = 0;
  for (MaterialId m(0); m.value < resampled.source.materials.size(); ++m.value) {
    const auto of_input = boundary(input, m), of_shown = boundary(shown, m);
    measured = std::max(measured, test::sampled_distance(input.points, of_input, shown.points, of_shown,
                                                         resampled.source.box, samples, 1));
  }
  EXPECT_GE(certificate->materials.upper, measured * (1 - 1e-9));
  EXPECT_GE(certificate->materials.upper, certificate->networks.upper);
  EXPECT_LE(certificate->materials.upper, c.options.interface_error * (1 + 1e-12));
  EXPECT_LE(certificate->materials.upper, std::max(1.3 * measured, 0.01 * c.options.interface_error));
  ASSERT_EQ(certificate->junctions.has_value(), !junctions(input).empty());
  if (!certificate->junctions) return;
  const double lines = sampled_line_distance(input, shown);
  EXPECT_GE(certificate->junctions->upper, lines * (1 - 1e-9));
  EXPECT_LE(certificate->junctions->upper, std::max(1.3 * lines, 0.01 * c.options.interface_error));
  EXPECT_LE(certificate->junctions->upper, c.options.interface_error * (1 + 1e-12));
}

void expect_certified_per_material(const std::vector<std::string>& names, double error, std::size_t samples) {
  for (const std::string& name : names) {
    for (const bool meshes : {false, true}) {
      SCOPED_TRACE(name + (meshes ? " from meshes" : " from fractions"));
      SceneCase c;
      c.name = name;
      c.seed = 5;
      c.meshes = meshes;
      c.options.interface_error = error;
      expect_certified_per_material(c, samples);
    }
  }
}

TEST(LongCertifiedInterfaces, PerMaterialAndAlongJunctions) {
  expect_certified_per_material({"reflex", "random"}, 0.08, 3000);
}
TEST(CertifiedInterfaces, PerMaterialAndAlongJunctions) {
  expect_certified_per_material({"tjunction", "voronoi10"}, 0.15, 1000);
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
      // This many tetrahedra are enough for the errors; more would only be spent on the topology of the
      // shell.
      if (name == "shell3" && !meshes) c.options.max_tetrahedra = error < 0.1 ? 8000 : 5000;
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

constexpr MaterialId kBelow(0), kSpeck(1), kAbove(2);

void add_quad(InterfaceMesh& mesh, const std::array<Vec3, 4>& corners, MaterialId front, MaterialId back) {
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), corners.begin(), corners.end());
  mesh.triangles.push_back({{first, first + 1, first + 2}, front, back});
  mesh.triangles.push_back({{first, first + 2, first + 3}, front, back});
}

/// Adds the sides of a box of the material of specks from `low` to `high`, and its bottom and top where these
/// are not left open.
void add_speck(InterfaceMesh& mesh, const Vec3& low, const Vec3& high, MaterialId outside, bool bottom = true,
               bool top = true) {
  const auto corner = [&](double x, double y, double z) {
    return Vec3{x > 0 ? high.x : low.x, y > 0 ? high.y : low.y, z > 0 ? high.z : low.z};
  };
  const auto add = [&](const std::array<Vec3, 4>& corners) { add_quad(mesh, corners, outside, kSpeck); };
  add({corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1)});
  add({corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1)});
  add({corner(1, 1, 0), corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1)});
  add({corner(0, 1, 0), corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1)});
  if (bottom) add({corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0)});
  if (top) add({corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1)});
}

/// The only junction lines are round a speck that is far smaller than the error, at a plane: cells are as
/// small there as it takes to show them.
TEST(CertifiedInterfaces, JunctionsRoundASpeckFarSmallerThanTheError) {
  constexpr double kSize = 0.003;
  InterfaceMesh mesh;
  mesh.materials = IdVector<MaterialId, std::string>({"below", "speck", "above"});
  const Vec3 center{0.137, -0.211, 0.053}, half{kSize, kSize, 0}, up{0, 0, kSize};
  const std::array<Vec3, 4> ways{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 a = ways[i], b = ways[(i + 1) % 4], height{0, 0, center.z};
    add_quad(mesh, {a + height, b + height, center + kSize * b, center + kSize * a}, kAbove, kBelow);
  }
  add_speck(mesh, center - half - up, center + half, kBelow, true, false);
  add_speck(mesh, center - half, center + half + up, kAbove, false, true);
  add_speck(mesh, {-0.3, -0.3, 0.2}, {0.3, 0.3, 0.5}, kAbove);
  const ResamplingSource source = make_mesh_source(mesh, Box3{{-1, -1, -1}, {1, 1, 1}});
  ResamplingOptions options;
  options.interface_error = 0.5;
  Resampler resampler(source, options);
  resampler.refine();
  const auto& certificate = resampler.certificate();
  ASSERT_TRUE(certificate && certificate->junctions);
  const double lines = sampled_line_distance(network_mesh(*source.network, source.materials, ""),
                                             approximated_interfaces(resampler).mesh);
  EXPECT_LE(certificate->junctions->upper, options.interface_error);
  EXPECT_GE(certificate->junctions->upper, lines * (1 - 1e-9));
}

TEST(LongCertifiedInterfaces, FromMeshes) { expect_certified(true, {0.1}, 10000); }
TEST(LongCertifiedInterfaces, FromFractions) { expect_certified(false, {0.1}, 10000); }
TEST(CertifiedInterfaces, CoarseFromMeshes) { expect_certified(true, {0.2}, 2000); }

}  // namespace
}  // namespace adamas
