// Tests that cells are split until the relative error of each body's volume is small enough.

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "interfaces/cell_errors/volume_share.h"
#include "interfaces/resampling/resample_figures.h"
#include "tests/interfaces/network_meshes.h"
#include "tests/interfaces/resampler_scenes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

using test::ResampledScene;
using test::SceneCase;

/// Returns labels of a grid of `along`^3 balls of radius 3, ten cells apart and off the grid's symmetry.
MultiMaterialData balls(std::size_t along) {
  const std::size_t n = 10 * along;
  MultiMaterialData data;
  data.source = "balls";
  data.grid = RectilinearGrid::uniform({n, n, n}, {0, 0, 0}, {1, 1, 1});
  data.materials = {"air", "balls"};
  for (std::size_t site = 0; site < n * n * n; ++site) {
    const auto offset = [](std::size_t i, double shift) {
      return static_cast<double>(i % 10) + 0.5 - 5 - shift;
    };
    const std::size_t ball = site % n / 10 + site / n % n / 10 + site / (n * n) / 10;
    const double shift = 0.3 * static_cast<double>(ball % 4);
    const double x = offset(site % n, shift), y = offset(site / n % n, -shift), z = offset(site / (n * n), 0);
    data.labels.push_back(x * x + y * y + z * z <= 9 ? 1 : 0);
  }
  return data;
}

/// Says that a body is `times` as large as it is, at the cost of the largest body, which is returned.
BodyId state_volume(ResamplingSource& source, BodyId body, double times) {
  const auto largest = BodyId(
      static_cast<std::size_t>(std::ranges::max_element(source.body_volumes) - source.body_volumes.begin()));
  source.body_volumes[largest] -= (times - 1) * source.body_volumes[body];
  source.body_volumes[body] *= times;
  return largest;
}

/// Returns the sum of what the bodies of a mesh have too much or too little.
double missing_volume(const Resampler& resampler) {
  double sum = 0;
  for (const auto& body : measure(resampler, SilentProgress::instance()).bodies) sum += body.missing();
  return sum;
}

/// Returns the volumes that the mesh's interfaces enclose, by the divergence theorem.
std::vector<double> enclosed(const Resampler& resampler) {
  const ResamplingSource& source = resampler.source();
  const ExtractedInterfaces found =
      extract_interfaces(source.network->table(), resampler.cells(), source.box);
  std::vector<test::SidedTriangle> triangles;
  for (std::size_t t = 0; t < found.bodies.size(); ++t)
    triangles.push_back({found.mesh.triangles[t].points, found.bodies[t][0].value, found.bodies[t][1].value});
  return test::enclosed_volumes(found.mesh.points, triangles, source.network->table().body_count(),
                                source.box, resampler.owner_at(source.box.max).value,
                                1e-11 * source.box.diagonal());
}

double greatest_error(const Resampler& resampler) {
  const std::vector<double> volumes = enclosed(resampler);
  double greatest = 0;
  for (BodyId b(0); b.value < volumes.size(); ++b.value) {
    const double wanted = resampler.source().body_volumes[b];
    greatest = std::max(greatest, std::abs(volumes[b.value] - wanted) / wanted);
  }
  return greatest;
}

TEST(VolumeErrors, EveryBodyIsWithin) {
  for (const auto& [name, meshes] : {std::pair{"sphere", true}, {"voronoi10", false}, {"reflex", false}}) {
    SCOPED_TRACE(name);
    SceneCase c;
    c.name = name;
    c.seed = 2;
    c.meshes = meshes;
    c.options.interface_error = 0.1;
    c.options.volume_error = 0.005;
    const ResampledScene scene(c);
    test::expect_laws(scene);
    EXPECT_LE(greatest_error(*scene.resampler), 0.005);
    EXPECT_LE(scene.resampler->certificate()->materials.upper, c.options.interface_error);
  }
}

/// The balls are smaller than the interface error, so their volumes would be arbitrary without an error of
/// volumes.
TEST(VolumeErrors, SmallBallsHaveTheirVolumes) {
  const MultiMaterialData data = balls(2);
  const ResamplingSource source = make_grid_source(data);
  ASSERT_EQ(source.body_volumes.size(), 9u);
  ResamplingOptions options;
  options.interface_error = 0.06 * source.box.diagonal();
  Resampler without(source, options);
  without.refine();
  EXPECT_GT(greatest_error(without), 0.1);
  std::size_t before = without.hierarchy().leaf_count();
  for (const double error : {0.1, 0.02}) {
    options.volume_error = error;
    Resampler resampler(source, options);
    resampler.refine();
    EXPECT_LE(greatest_error(resampler), error);
    EXPECT_LE(resampler.certificate()->materials.upper, options.interface_error);
    EXPECT_GT(resampler.hierarchy().leaf_count(), before);
    before = resampler.hierarchy().leaf_count();
    const ResampleFigures measured = measure(resampler, SilentProgress::instance());
    for (BodyId b(0); b.value < measured.bodies.size(); ++b.value)
      EXPECT_FALSE(volume_shortfall(resampler, measured, b));
  }
}

/// With conservation, which moves interfaces, volumes are exact, and far fewer cells are split for them.
TEST(VolumeErrors, TogetherWithConservation) {
  const MultiMaterialData data = balls(2);
  const ResamplingSource source = make_grid_source(data);
  ResamplingOptions options;
  options.interface_error = 0.06 * source.box.diagonal();
  options.volume_error = 0.01;
  Resampler split(source, options);
  split.refine();
  options.conserve = true;
  Resampler both(source, options);
  both.refine();
  EXPECT_LE(greatest_error(both), 1e-6);
  EXPECT_LT(2 * both.hierarchy().leaf_count(), split.hierarchy().leaf_count());
  EXPECT_LE(both.certificate()->materials.upper, options.interface_error * (1 + 1e-12));
}

/// Not all balls smaller than the interface error can be given their volumes. They are left as they are, and
/// no cell is split for any.
TEST(ConservedVolumes, SplitNoCells) {
  const MultiMaterialData data = balls(3);
  const ResamplingSource source = make_grid_source(data);
  for (const double part : {0.06, 0.08, 0.12}) {
    ResamplingOptions options;
    options.interface_error = part * source.box.diagonal();
    Resampler without(source, options);
    without.refine();
    options.conserve = true;
    Resampler with(source, options);
    with.refine();
    EXPECT_EQ(with.hierarchy().leaf_count(), without.hierarchy().leaf_count()) << part;
    EXPECT_LE(with.certificate()->upper(), options.interface_error * (1 + 1e-12)) << part;
    EXPECT_LT(missing_volume(with), missing_volume(without)) << part;
  }
}

/// One ball is said to be twenty times as large as it is, which no allowed move can do. It is left off, and
/// so is the air that it would take the volume from; all other balls get their volumes.
TEST(ConservedVolumes, OfOthersDoNotSufferFromAnUnreachableOne) {
  const MultiMaterialData data = balls(2);
  ResamplingSource source = make_grid_source(data);
  const BodyId odd(3);
  const BodyId air = state_volume(source, odd, 20);
  ASSERT_NE(odd, air);
  for (const bool certify : {false, true}) {
    ResamplingOptions options;
    options.interface_error = 0.02 * source.box.diagonal();
    options.certify = certify;
    options.conserve = true;
    Resampler resampler(source, options);
    resampler.refine();
    const ResampleFigures measured = measure(resampler, SilentProgress::instance());
    for (BodyId b(0); b.value < measured.bodies.size(); ++b.value) {
      const bool conserved = measured.bodies[b.value].missing() <= kConserved * source.box.volume();
      EXPECT_EQ(conserved, b != odd && b != air) << b.value;
    }
    if (certify) {
      EXPECT_LE(resampler.certificate()->upper(), options.interface_error * (1 + 1e-12));
    }
  }
}

/// Neither moves nor smaller cells give one ball the volume that is said. No more cells are split for it than
/// without moves, and all others get theirs.
TEST(VolumeErrors, TogetherWithConservationOfAnUnreachableOne) {
  const MultiMaterialData data = balls(2);
  ResamplingSource source = make_grid_source(data);
  const BodyId odd(3);
  const BodyId air = state_volume(source, odd, 1.8);
  ASSERT_NE(odd, air);
  ResamplingOptions options;
  options.interface_error = 0.02 * source.box.diagonal();
  options.volume_error = 0.01;
  Resampler split(source, options);
  split.refine();
  options.conserve = true;
  Resampler both(source, options);
  both.refine();
  EXPECT_LE(both.hierarchy().leaf_count(), split.hierarchy().leaf_count());
  EXPECT_LE(both.certificate()->upper(), options.interface_error * (1 + 1e-12));
  const ResampleFigures measured = measure(both, SilentProgress::instance());
  for (BodyId b(0); b.value < measured.bodies.size(); ++b.value) {
    if (b == odd) continue;
    EXPECT_LE(measured.bodies[b.value].volume_error(), 0.01) << b.value;
  }
}

TEST(VolumeErrors, KeepToAGreatestNumberOfTetrahedra) {
  const MultiMaterialData data = balls(2);
  const ResamplingSource source = make_grid_source(data);
  ResamplingOptions options;
  options.interface_error = 0.06 * source.box.diagonal();
  options.volume_error = 1e-4;
  options.max_tetrahedra = 5000;
  Resampler resampler(source, options);
  resampler.refine();
  EXPECT_LE(resampler.hierarchy().leaf_count(), 5000u);
  const ResampleFigures measured = measure(resampler, SilentProgress::instance());
  const auto worst = worst_volume(measured);
  ASSERT_TRUE(worst);
  const auto shortfall = volume_shortfall(resampler, measured, *worst);
  ASSERT_TRUE(shortfall);
  EXPECT_NE(shortfall->reason.find("5000"), std::string::npos);
}

/// A body whose stated volume differs from the one that its interfaces enclose is named, and gets the latter.
TEST(VolumeErrors, VolumesThatTheInterfacesDoNotEncloseAreNamed) {
  const MultiMaterialData data = balls(2);
  ResamplingSource source = make_grid_source(data);
  const BodyId odd(3);
  const double stated = source.body_volumes[odd];
  source.body_volumes[odd] = 1.5 * stated;
  ResamplingOptions options;
  options.interface_error = 0.06 * source.box.diagonal();
  options.volume_error = 0.01;
  Resampler resampler(source, options);
  resampler.refine();
  const ResampleFigures measured = measure(resampler, SilentProgress::instance());
  EXPECT_NEAR(measured.bodies[odd.value].volume_mesh, stated, 0.015 * stated);
  for (BodyId b(0); b.value < measured.bodies.size(); ++b.value) {
    const auto shortfall = volume_shortfall(resampler, measured, b);
    EXPECT_EQ(shortfall.has_value(), b == odd);
    if (shortfall) {
      EXPECT_NE(shortfall->reason.find("interfaces enclose"), std::string::npos);
    }
  }
}

/// The body is so small that the hierarchy has no cells for it.
TEST(VolumeErrors, BodiesBelowTheDepthAreNamed) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_sphere(mesh, {0.37, 0.41, 0.53}, 1e-7, MaterialId(0), MaterialId(1), 4);
  test::add_sphere(mesh, {0.67, 0.41, 0.53}, 1e-1, MaterialId(0), MaterialId(1), 8);
  const ResamplingSource source = make_mesh_source(mesh, test::unit_box(), nullptr);
  ResamplingOptions options;
  options.interface_error = 0.05;
  options.volume_error = 0.01;
  Resampler resampler(source, options);
  resampler.refine();
  const ResampleFigures measured = measure(resampler, SilentProgress::instance());
  std::size_t missed = 0;
  for (BodyId b(0); b.value < measured.bodies.size(); ++b.value) {
    const auto shortfall = volume_shortfall(resampler, measured, b);
    EXPECT_EQ(shortfall.has_value(), measured.bodies[b.value].volume_error() > 0.01);
    if (!shortfall) continue;
    ++missed;
    EXPECT_LT(source.body_volumes[b], 1e-20);
    EXPECT_NE(shortfall->reason.find("deep"), std::string::npos) << shortfall->reason;
  }
  EXPECT_EQ(missed, 1u);
}

TEST(VolumeErrors, OnOneThreadAndOnTwo) {
  const MultiMaterialData data = balls(2);
  std::vector<std::vector<Vec3>> points;
  for (const unsigned threads : {1u, 2u}) {
    set_thread_limit(threads);
    const ResamplingSource source = make_grid_source(data);
    ResamplingOptions options;
    options.interface_error = 0.06 * source.box.diagonal();
    options.volume_error = 0.1;
    Resampler resampler(source, options);
    resampler.refine();
    points.push_back(extract_interfaces(source.network->table(), resampler.cells(), source.box).mesh.points);
  }
  set_thread_limit(0);
  EXPECT_EQ(points[0], points[1]);
}

/// Distances with a common offset move a plane: each cell gains what its parts gain.
TEST(VolumeShares, AreThoseOfAPlaneThatIsMoved) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_patch(mesh, {0, 0, 0.47}, {1, 0, 0}, {0, 1, 0}, MaterialId(0), MaterialId(1), 3);
  const InterfaceNetwork network(mesh, test::unit_box());
  std::vector<std::uint32_t> triangles(network.triangles().size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) triangles[t] = t;
  const Tetrahedron cell({{{0.2, 0.3, 0.3}, {0.5, 0.3, 0.35}, {0.25, 0.7, 0.6}, {0.3, 0.4, 0.8}}});
  ASSERT_GT(cell.volume, 0);
  const auto owned = [&](double by, bool estimated) {
    std::array<VertexDistances, 4> vertices;
    for (std::size_t v = 0; v < 4; ++v) {
      vertices[v].radius = 1;
      vertices[v].body = network.body_at(cell.corners[v]);
      const double height = cell.corners[v].z - 0.47;
      // Only the network can tell whether the interface's first body is the one above the plane.
      const BodyId above = network.body_at({0.5, 0.5, 0.9});
      const double distance = network.table().sides(InterfaceId(0))[0] == above ? height : -height;
      vertices[v].near = {{InterfaceId(0), distance + by}};
      list_known_bodies(network.table(), vertices[v]);
    }
    CellOwnership owners;
    find_cell_ownership(network.table(), {&vertices[0], &vertices[1], &vertices[2], &vertices[3]}, owners);
    if (estimated) {
      const auto shares = estimate_volume_shares(network, cell, owners, triangles);
      EXPECT_EQ(shares.size(), 2u);
      EXPECT_NEAR(shares[0].gained, -shares[1].gained, 1e-15);
      return shares[0].gained;
    }
    std::vector<OwnedTetrahedron> parts;
    partition_cell(owners, parts);
    double volume = 0;
    for (const OwnedTetrahedron& part : parts) {
      if (part.owner == 0) volume += cell.volume * volume_fraction(part.corners);
    }
    return volume;
  };
  for (const double by : {-1e-3, 1e-4, 2e-3}) {
    const double gained = owned(by, false) - owned(0, false);
    EXPECT_NEAR(owned(by, true), gained, 0.02 * std::abs(gained));
  }
  EXPECT_NEAR(owned(0, true), 0, 1e-15);
  // When the plane moves beyond the cell, at most the whole cell is gained or lost.
  EXPECT_NEAR(owned(1, true), 0.5 * cell.volume, 0.5 * cell.volume);
}

/// A cell without a part of the input's interfaces belongs to one body, so all that it gives to others is
/// gained.
TEST(VolumeShares, OfACellWithoutInterfacesAreWhatItShows) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_patch(mesh, {0, 0, 0.2}, {1, 0, 0}, {0, 1, 0}, MaterialId(0), MaterialId(1), 3);
  const InterfaceNetwork network(mesh, test::unit_box());
  const Tetrahedron cell({{{0.2, 0.3, 0.3}, {0.5, 0.3, 0.35}, {0.25, 0.7, 0.6}, {0.3, 0.4, 0.8}}});
  std::array<VertexDistances, 4> vertices;
  for (std::size_t v = 0; v < 4; ++v) {
    vertices[v].radius = 1;
    vertices[v].body = BodyId(0);
    vertices[v].near = {{InterfaceId(0), v == 0 ? -0.1 : 0.1}};
    list_known_bodies(network.table(), vertices[v]);
  }
  CellOwnership owners;
  find_cell_ownership(network.table(), {&vertices[0], &vertices[1], &vertices[2], &vertices[3]}, owners);
  const auto shares = estimate_volume_shares(network, cell, owners, {});
  ASSERT_EQ(shares.size(), 2u);
  EXPECT_NEAR(shares[1].gained, cell.volume / 8, 1e-12);
  EXPECT_NEAR(shares[0].gained, -cell.volume / 8, 1e-12);
}

}  // namespace
}  // namespace adamas
