#include "interfaces/mesh_reconstruction/mesh_reconstruction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <set>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "interfaces/input/mesh_source.h"
#include "interfaces/mesh_reconstruction/mesh_interfaces.h"
#include "interfaces/network/interface_mesh_check.h"
#include "interfaces/network/network_measures.h"
#include "interfaces/reconstruction/reconstruction.h"
#include "tests/interfaces/mesh_data_scenes.h"

namespace adamas::interfaces {
namespace {

using test::jittered;
using test::make_hexahedra;
using test::sampled_data;
using test::to_mesh;

PolyhedralMesh jittered_cube(std::uint32_t n) {
  return to_mesh(make_hexahedra({n, n, n}, [n](const Vec3& p) { return jittered(p, 0.2 / n); }));
}

/// A quarter of a tube: no box.
PolyhedralMesh tube(std::uint32_t n) {
  return to_mesh(make_hexahedra({n, 2 * n, n}, [](const Vec3& p) {
    const double r = 1 + p.x, angle = 0.5 * M_PI * p.y;
    return Vec3{r * std::cos(angle), r * std::sin(angle), p.z};
  }));
}

/// Checks that interfaces are closed and agree with each other, and returns the volumes that they enclose.
IdVector<MaterialId, double> checked_volumes(const InterfaceMesh& mesh, const Box3& box) {
  const InterfaceMeshReport report = check_interface_mesh(mesh, &box);
  EXPECT_EQ(report.open_border_edges, 0u);
  EXPECT_EQ(report.flipped_edges, 0u);
  const InterfaceNetwork network(mesh, box);
  EXPECT_EQ(network.inconsistencies(), 0u);
  EXPECT_FALSE(network.has_open_border());
  return measure_network(network, box, mesh.materials.size()).volumes;
}

void expect_volumes(const MeshData& data, const InterfaceMesh& mesh) {
  const IdVector<MaterialId, double> found = checked_volumes(mesh, data.mesh.box()), wanted = data.volumes();
  const double domain = data.mesh.box().volume();
  for (MaterialId m(0); m.value < wanted.size(); ++m.value)
    EXPECT_NEAR(found[m], wanted[m], 1e-9 * domain) << data.materials[m];
}

std::size_t bodies_of(const InterfaceMesh& mesh, const Box3& box) {
  return InterfaceNetwork(mesh, box).table().body_count();
}

std::size_t bodies_of(const InterfaceMesh& mesh, const Box3& box, MaterialId material) {
  const InterfaceNetwork network(mesh, box);
  std::size_t count = 0;
  for (BodyId b(0); b.value < network.table().body_count(); ++b.value)
    count += network.table().material(b) == material ? 1 : 0;
  return count;
}

TEST(MeshSubdivision, LinearFunctionsComeBackExactly) {
  for (const PolyhedralMesh& mesh : {jittered_cube(4), tube(4)}) {
    const MeshSubdivision subdivision(mesh);
    const auto f = [](const Vec3& p) { return 0.3 + 2 * p.x - 0.7 * p.y + 1.1 * p.z; };
    MeshSubdivision::Stencil stencil;
    for (std::uint32_t p = 0; p < subdivision.cell_center(0); ++p) {
      subdivision.find_stencil(p, stencil);
      double sum = 0;
      for (std::size_t i = 0; i < stencil.cells.size(); ++i)
        sum += stencil.weights[i] * f(mesh.cell_center(stencil.cells[i]));
      EXPECT_NEAR(sum, f(subdivision.position(p)), 1e-6) << "point " << p;
    }
  }
}

TEST(MeshSubdivision, TetrahedraFillTheCells) {
  const PolyhedralMesh mesh = tube(4);
  const MeshSubdivision subdivision(mesh);
  for (std::uint32_t c = 0; c < mesh.cell_count(); ++c) {
    double sum = 0;
    subdivision.for_each_tetrahedron(c, [&](const std::array<std::uint32_t, 4>& corners) {
      EXPECT_GT(subdivision.volume(corners), 0);
      sum += subdivision.volume(corners);
    });
    EXPECT_NEAR(sum, mesh.cell_volume(c), 1e-14);
  }
}

TEST(MeshReconstruction, APlaneIsFoundUpToTheBoundary) {
  const Vec3 normal = normalized(Vec3{1, 0.4, 0.7});
  const auto plane = [&](const Vec3& p) { return dot(p - Vec3{0.5, 0.5, 0.5}, normal); };
  const MeshData data = sampled_data(jittered_cube(8), plane, 12);
  const MeshReconstruction found = reconstruct_mesh(data);
  expect_volumes(data, found.mesh);
  // Fractions by sampling are off by some 0.002.
  for (const Vec3& p : found.mesh.points) EXPECT_NEAR(plane(p), 0, 0.02 / 8);
}

TEST(MeshReconstruction, ABallIsFound) {
  constexpr int kCells = 12;
  const auto ball = [](const Vec3& p) { return 0.31 - distance(p, {0.52, 0.49, 0.5}); };
  const MeshData data = sampled_data(jittered_cube(kCells), ball);
  const MeshReconstruction found = reconstruct_mesh(data);
  expect_volumes(data, found.mesh);
  double sum = 0, most = 0;
  for (const Vec3& p : found.mesh.points) {
    sum += std::abs(ball(p));
    most = std::max(most, std::abs(ball(p)));
  }
  EXPECT_LT(sum / static_cast<double>(found.mesh.points.size()), 0.02 / kCells);
  EXPECT_LT(most, 0.15 / kCells);
  EXPECT_LT(found.agreement.cells.mean_difference, 0.005);
}

/// Tetrahedra hold their fractions, and yet no value stands out among those round it, which would cut off
/// pieces.
TEST(MeshReconstruction, ABallOnTetrahedraIsInOnePiece) {
  constexpr std::uint32_t kCells = 8;
  const double size = 1 / (kCells * std::cbrt(6.0));
  const auto ball = [](const Vec3& p) { return 0.31 - distance(p, {0.52, 0.49, 0.5}); };
  const MeshData data =
      sampled_data(test::to_tetrahedra(make_hexahedra(
                       {kCells, kCells, kCells}, [](const Vec3& p) { return jittered(p, 0.2 / kCells); })),
                   ball, 4);
  const MeshReconstruction found = reconstruct_mesh(data);
  expect_volumes(data, found.mesh);
  EXPECT_EQ(bodies_of(found.mesh, data.mesh.box()), 2u);
  double most = 0;
  for (const Vec3& p : found.mesh.points) most = std::max(most, std::abs(ball(p)));
  EXPECT_LT(most, 0.35 * size);
  EXPECT_LT(found.agreement.cells.mean_difference, 3e-4);
}

/// Three regions that meet in a line, one of them reflex: each is one body, and the pieces that correction
/// cuts off where they meet are none, as on grids.
TEST(MeshReconstruction, FlakesOnTetrahedraAreNoBodies) {
  constexpr std::uint32_t kCells = 5;
  const Vec3 line = normalized(Vec3{0.3, 0.5, 1}), across = normalized(cross(line, {1, 0.2, 0.1})),
             up = cross(line, across);
  for (const Vec3& origin : {Vec3{0.52, 0.47, 0.51}, {0.44, 0.55, 0.49}}) {
    const auto material_at = [&](const Vec3& p) -> std::size_t {
      const double angle = std::atan2(dot(p - origin, up), dot(p - origin, across));
      return angle < 0 || angle > 2 * M_PI / 3 ? 0 : angle < M_PI / 3 ? 1 : 2;
    };
    const MeshData data = test::sampled_materials(
        test::to_tetrahedra(make_hexahedra({kCells, kCells, kCells},
                                           [](const Vec3& p) { return jittered(p, 0.2 / kCells); })),
        3, material_at, 3);
    const MeshReconstruction found = reconstruct_mesh(data);
    expect_volumes(data, found.mesh);
    EXPECT_EQ(found.bodies.materials.size(), 3u);
    EXPECT_EQ(bodies_of(found.mesh, data.mesh.box()), 3u);
  }
}

TEST(MeshReconstruction, TheBoundaryOfWhatIsNoBoxIsAnInterface) {
  const auto ball = [](const Vec3& p) { return 0.4 - distance(p, {1.1, 1.0, 0.9}); };
  const MeshData data = sampled_data(tube(6), ball);
  const MeshReconstruction found = reconstruct_mesh(data);
  ASSERT_EQ(found.mesh.materials.size(), 3u);
  EXPECT_EQ(found.mesh.materials[MaterialId(2)], "outside");
  expect_volumes(data, found.mesh);
}

/// A ball in the upper half of a cube of 24 cells a side, and a mist of some per cent below.
MeshData ball_and_mist(const PolyhedralMesh& mesh, bool with_mist) {
  MeshData data = sampled_data(
      mesh,
      [](const Vec3& p) {
        return 0.2 - distance(p, {0.5, 0.5, 0.75});
      },
      4);
  data.materials.push_back("mist");
  data.fractions.push_back(std::vector<float>(data.mesh.cell_count(), 0.0f));
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(0.02f, 0.04f);
  for (std::size_t c = 0; with_mist && c < data.mesh.cell_count(); ++c) {
    if (data.mesh.cell_center(c).z > 0.3) continue;
    const float mist = uniform(random);
    data.fractions[MaterialId(2)].own()[c] = mist;
    data.fractions[MaterialId(1)].own()[c] -= mist;
  }
  data.normalise();
  return data;
}

/// What is dispersed on a grid is so on the mesh of its cells, and the interfaces of the others are those of
/// data without it.
TEST(MeshReconstruction, AMistIsDispersedAsOnAGrid) {
  constexpr std::uint32_t kCells = 24;
  const PolyhedralMesh cubes =
      to_mesh(make_hexahedra({kCells, kCells, kCells}, [](const Vec3& p) { return p; }));
  const MeshData data = ball_and_mist(cubes, true);
  MultiMaterialData on_grid;
  on_grid.source = "grid";
  on_grid.grid = RectilinearGrid::uniform({kCells, kCells, kCells}, {0, 0, 0},
                                          {1.0 / kCells, 1.0 / kCells, 1.0 / kCells});
  on_grid.materials = data.materials;
  for (const SiteArray<float>& fractions : data.fractions)
    on_grid.fractions.push_back(std::vector<float>(fractions.begin(), fractions.end()));
  const double wanted = Reconstruction(on_grid).findings().dispersed[2], mist = data.volumes()[MaterialId(2)];
  ASSERT_GT(wanted, 0.9 * mist);
  const MeshReconstruction found = reconstruct_mesh(data);
  EXPECT_NEAR(found.agreement.findings.dispersed[2], wanted, 0.01 * mist);
  EXPECT_EQ(found.agreement.findings.dispersed[0] + found.agreement.findings.dispersed[1], 0);
  EXPECT_TRUE(found.agreement.lost.empty());
  const MeshData without = ball_and_mist(cubes, false);
  const MeshReconstruction clear = reconstruct_mesh(without);
  expect_volumes(without, clear.mesh);
  EXPECT_EQ(clear.agreement.findings.dispersed[2], 0);
  EXPECT_EQ(found.mesh.triangles, clear.mesh.triangles);
  ASSERT_EQ(found.mesh.points.size(), clear.mesh.points.size());
  for (std::size_t n = 0; n < clear.mesh.points.size(); ++n)
    EXPECT_LT(distance(found.mesh.points[n], clear.mesh.points[n]), 1e-10);
  const IdVector<MaterialId, double> volumes = checked_volumes(found.mesh, data.mesh.box());
  for (MaterialId m(0); m.value < 3; ++m.value) EXPECT_NEAR(volumes[m], found.agreement.volumes[m], 1e-9);
  EXPECT_NEAR(volumes[MaterialId(1)], data.volumes()[MaterialId(1)] + mist, 1e-6);
}

TEST(MeshReconstruction, DispersedVolumeIsKeptWhereThatIsWanted) {
  const MeshData data = ball_and_mist(jittered_cube(12), true);
  EXPECT_GT(reconstruct_mesh(data).agreement.findings.dispersed[2], 0.9 * data.volumes()[MaterialId(2)]);
  const MeshReconstruction kept = reconstruct_mesh(data, {.keep_dispersed = true});
  EXPECT_EQ(kept.agreement.findings.dispersed[2], 0);
  const double shown = checked_volumes(kept.mesh, data.mesh.box())[MaterialId(2)];
  EXPECT_TRUE(shown > 0 || !kept.agreement.lost.empty());
}

/// A material that fills less than half of each cell along a wall is a layer there, no row of islands.
TEST(MeshReconstruction, AFaintLayerAtAWallIsOneBody) {
  MeshData data;
  data.source = "layer";
  data.mesh = tube(8);
  for (const char* name : {"mold", "melt", "crust"}) data.materials.push_back(name);
  std::array<std::vector<float>, 3> fractions;
  for (std::size_t c = 0; c < data.mesh.cell_count(); ++c) {
    const Vec3 p = data.mesh.cell_center(c);
    const double r = 8 * (std::hypot(p.x, p.y) - 1);
    const float crust = r > 6 ? 0 : r > 5 ? 0.29f : r > 4 ? 0.05f : 0;
    fractions[0].push_back(r > 6 ? 1 : 0);
    fractions[1].push_back(r > 6 ? 0 : 1 - crust);
    fractions[2].push_back(crust);
  }
  for (std::vector<float>& own : fractions) data.fractions.push_back(std::move(own));
  data.normalise();
  EXPECT_EQ(bodies_of(reconstruct_mesh(data).mesh, data.mesh.box(), MaterialId(2)), 1u);
}

/// A film thinner than half a cell is one body, and cells hold their fractions of it.
TEST(MeshReconstruction, AThinFilmIsKept) {
  constexpr std::uint32_t kCells = 8;
  const Vec3 normal = normalized(Vec3{1, 0.2, 0.1});
  const MeshData data = sampled_data(
      jittered_cube(kCells),
      [&](const Vec3& p) {
        return 0.2 / kCells - std::abs(dot(p - Vec3{0.51, 0.49, 0.5}, normal));
      },
      4);
  const MeshReconstruction found = reconstruct_mesh(data);
  expect_volumes(data, found.mesh);
  EXPECT_EQ(bodies_of(found.mesh, data.mesh.box(), MaterialId(0)), 1u);
  EXPECT_LT(found.agreement.cells.mean_difference, 0.01);
}

/// Films thinner than cells are whole on hexahedra and on tetrahedra, plane ones and closed shells, of any
/// thickness: they separate what lies on their two sides, and their faces are where they should be.
TEST(MeshReconstruction, FilmsAreWholeAndInTheirPlaces) {
  const Vec3 normal = normalized(Vec3{0.3, 1, 0.5}), center{0.51, 0.48, 0.5};
  const std::function<double(const Vec3&)> plane = [&](const Vec3&p) { return dot(p - center, normal); },
                                           ball = [&](const Vec3&p) { return distance(p, center) - 0.36; };
  struct Case {
    const std::function<double(const Vec3&)>& off;
    bool tetrahedra;
    std::uint32_t cells;  // hexahedra a side
    double thickness;     // in sides of the hexahedra
  };
  for (const auto& [off, tetrahedra, cells, thickness] : {Case{plane, true, 5, 0.4}, {ball, false, 8, 0.7}}) {
    const double cell = 1.0 / cells, half = 0.5 * thickness * cell;
    const test::Hexahedra hexahedra =
        make_hexahedra({cells, cells, cells}, [&](const Vec3& p) { return jittered(p, 0.2 * cell); });
    const MeshData data = sampled_data(
        tetrahedra ? test::to_tetrahedra(hexahedra) : to_mesh(hexahedra),
        [&, off = off](const Vec3& p) { return half - std::abs(off(p)); }, tetrahedra ? 6 : 4);
    const MeshReconstruction found = reconstruct_mesh(data);
    expect_volumes(data, found.mesh);
    EXPECT_EQ(found.bodies.materials.size(), 3u);
    EXPECT_EQ(found.agreement.findings.blur_share, 0);
    EXPECT_TRUE(found.agreement.lost.empty());
    double sum = 0, most = 0;
    for (const Vec3& p : found.mesh.points) {
      sum += std::abs(std::abs(off(p)) - half);
      most = std::max(most, std::abs(std::abs(off(p)) - half));
    }
    // Fractions that are sampled are off by up to a hundredth.
    EXPECT_LT(sum / static_cast<double>(found.mesh.points.size()), 0.04 * cell) << tetrahedra;
    EXPECT_LT(most, 0.4 * cell) << tetrahedra;
  }
}

/// A step that is blurred by a cell and a half, and the mould that it meets: each of its cells is full.
MeshData step_in_a_mould(bool with_mould) {
  MeshData data;
  data.source = "mould";
  data.mesh = tube(16);
  for (const char* name : {"mould", "melt", "solid"}) data.materials.push_back(name);
  std::array<std::vector<float>, 3> fractions;
  for (std::size_t c = 0; c < data.mesh.cell_count(); ++c) {
    const Vec3 p = data.mesh.cell_center(c);
    const bool mould = with_mould && std::hypot(p.x, p.y) > 1.75;
    const auto melt = static_cast<float>(0.5 * std::erfc((p.x - 0.9) / (0.1 * std::sqrt(2.0))));
    fractions[0].push_back(mould ? 1 : 0);
    fractions[1].push_back(mould ? 0 : melt);
    fractions[2].push_back(mould ? 0 : 1 - melt);
  }
  for (std::vector<float>& own : fractions) data.fractions.push_back(std::move(own));
  data.normalise();
  return data;
}

/// The faces of a mould are interfaces, whatever blurred steps do beside them, and these run up to it as they
/// would without it.
TEST(MeshReconstruction, BlurredStepsEndAtWalls) {
  constexpr double kCell = 1.0 / 16;
  const MaterialId mould(0), melt(1), solid(2), outside(3);
  double off_wall = 0;
  std::array<double, 2> off_step{}, outermost{};
  for (const bool with_mould : {false, true}) {
    const MeshData data = step_in_a_mould(with_mould);
    const MeshReconstruction found = reconstruct_mesh(data);
    expect_volumes(data, found.mesh);
    EXPECT_GT(found.agreement.findings.blur_share, 0.99);
    for (const InterfaceTriangle& t : found.mesh.triangles) {
      if (t.front == outside || t.back == outside) continue;
      for (const std::uint32_t point : t.points) {
        const Vec3& p = found.mesh.points[point];
        const double r = std::hypot(p.x, p.y);
        // Where the step meets the wall, within a cell, the wall is not exact.
        if ((t.front == mould || t.back == mould) && std::abs(p.x - 0.9) > 1.5 * kCell)
          off_wall = std::max(off_wall, std::abs(r - 1.75));
        if (std::set{t.front, t.back} != std::set{melt, solid} || r > 1.76) continue;
        off_step[with_mould] = std::max(off_step[with_mould], std::abs(p.x - 0.9));
        outermost[with_mould] = std::max(outermost[with_mould], r);
      }
    }
  }
  EXPECT_LT(off_wall, 0.15 * kCell);
  EXPECT_LT(off_step[1], off_step[0] + 0.2 * kCell);
  EXPECT_GT(outermost[1], 1.75 - 0.5 * kCell) << "the step reaches the wall";
}

TEST(MeshReconstruction, AGivenBlurIsTaken) {
  const MeshData data = sampled_data(jittered_cube(8), [](const Vec3& p) { return 0.47 - p.x; });
  EXPECT_EQ(reconstruct_mesh(data, {.blur = 0.0}).agreement.findings.blur_share, 0);
  const FractionFindings found = reconstruct_mesh(data, {.blur = 0.8}).agreement.findings;
  EXPECT_EQ(found.blur_share, 1);
  EXPECT_NEAR(found.blur_median, std::sqrt(0.64 + 1.0 / 12), 1e-12);
}

/// Random fractions of four materials, in cells that are next to each other, make all kinds of junctions,
/// also at the boundary.
TEST(MeshReconstruction, JunctionsOfRandomFractionsAreClosed) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    MeshData data;
    data.source = "random";
    data.mesh = seed == 1 ? jittered_cube(4) : tube(3);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::array<std::vector<float>, 4> fractions;
    for (std::size_t c = 0; c < data.mesh.cell_count(); ++c) {
      std::array<double, 4> own{};
      double sum = 0;
      for (double& f : own) sum += f = uniform(random) < 0.5 ? 0 : uniform(random);
      if (sum == 0) sum = own[c % 4] = 1;
      for (std::size_t m = 0; m < 4; ++m) fractions[m].push_back(static_cast<float>(own[m] / sum));
    }
    for (std::size_t m = 0; m < 4; ++m) {
      data.materials.push_back(std::string(1, static_cast<char>('a' + m)));
      data.fractions.push_back(std::move(fractions[m]));
    }
    data.normalise();
    const MeshReconstruction found = reconstruct_mesh(data);
    expect_volumes(data, found.mesh);
  }
}

TEST(MeshReconstruction, InterfacesOfLabelsAreFacesOfCells) {
  MeshData data;
  data.source = "labels";
  data.mesh = tube(5);
  for (const char* name : {"a", "b", "c"}) data.materials.push_back(name);
  std::mt19937 random(7);
  for (std::size_t c = 0; c < data.mesh.cell_count(); ++c)
    data.labels.push_back(static_cast<std::uint16_t>(random() % 3));
  data.check();
  const MeshReconstruction found = reconstruct_mesh(data);
  expect_volumes(data, found.mesh);
}

/// The volumes of a ball blurred by a normal distribution, in cells of the jittered cube.
MeshData blurred_ball(std::uint32_t n, double deviation) {
  constexpr double kRadius = 0.31;
  MeshData data;
  data.source = "blurred";
  data.mesh = jittered_cube(n);
  data.materials.push_back("a");
  data.materials.push_back("b");
  const auto density = [&](const Vec3& p) {
    const double r = std::max(distance(p, {0.52, 0.49, 0.5}), 1e-9), s = deviation * std::sqrt(2.0);
    const double a = (kRadius - r) / s, b = (kRadius + r) / s;
    return 0.5 * (std::erf(a) + std::erf(b)) -
           deviation / (r * std::sqrt(2 * M_PI)) * (std::exp(-a * a) - std::exp(-b * b));
  };
  std::vector<float> fractions, rest;
  const MeshSubdivision subdivision(data.mesh);
  for (std::uint32_t c = 0; c < data.mesh.cell_count(); ++c) {
    double sum = 0;
    subdivision.for_each_tetrahedron(c, [&](const std::array<std::uint32_t, 4>& corners) {
      for (std::size_t i = 0; i < 4; ++i) {
        // Exact for densities of degree two.
        Vec3 p;
        for (std::size_t j = 0; j < 4; ++j)
          p += (i == j ? 0.58541020 : 0.13819660) * subdivision.position(corners[j]);
        sum += 0.25 * subdivision.volume(corners) * density(p);
      }
    });
    fractions.push_back(static_cast<float>(std::clamp(sum / data.mesh.cell_volume(c), 0.0, 1.0)));
    rest.push_back(1 - fractions.back());
  }
  data.fractions.push_back(std::move(fractions));
  data.fractions.push_back(std::move(rest));
  data.normalise();
  return data;
}

TEST(MeshReconstruction, ABlurredBallIsFound) {
  constexpr std::uint32_t kCells = 16;
  for (const double blur : {0.3, 1.0}) {
    const MeshData data = blurred_ball(kCells, blur / kCells);
    const MeshReconstruction found = reconstruct_mesh(data);
    expect_volumes(data, found.mesh);
    EXPECT_NEAR(found.agreement.findings.blur_median, std::sqrt(blur * blur + 1.0 / 12), 0.08);
    double sum = 0, most = 0;
    for (const Vec3& p : found.mesh.points) {
      const double off = std::abs(0.31 - distance(p, {0.52, 0.49, 0.5}));
      sum += off;
      most = std::max(most, off);
    }
    EXPECT_LT(sum / static_cast<double>(found.mesh.points.size()), 0.05 / kCells) << blur;
    EXPECT_LT(most, 0.25 / kCells) << blur;
  }
}

/// Adds normal errors to the fractions of mixed cells.
void add_errors(double deviation, MeshData& data) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0, deviation);
  for (std::size_t c = 0; c < data.mesh.cell_count(); ++c) {
    const float f = data.fraction(MaterialId(0), c);
    if (f < 1e-6f || f > 1 - 1e-6f) continue;
    const auto wrong = static_cast<float>(std::clamp(static_cast<double>(f) + normal(random), 0.0, 1.0));
    data.fractions[MaterialId(0)].own()[c] = wrong;
    data.fractions[MaterialId(1)].own()[c] = 1 - wrong;
  }
  data.normalise();
}

/// Errors of fractions are found, and surfaces are smooth in spite of them: within 0.06 cells in the mean and
/// 0.4 at most, on hexahedra and on tetrahedra, of sharp fractions and of blurred ones.
TEST(LongMeshReconstruction, BallsOfFractionsWithErrorsAreSmooth) {
  const Vec3 center{0.52, 0.49, 0.5};
  const auto ball = [&](const Vec3& p) { return 0.31 - distance(p, center); };
  const auto move = [](double n) { return [n](const Vec3& p) { return jittered(p, 0.2 / n); }; };
  struct Case {
    MeshData data;
    double size;
  };
  std::vector<Case> cases;
  cases.push_back({sampled_data(to_mesh(make_hexahedra({24, 24, 24}, move(24))), ball, 4), 1.0 / 24});
  cases.push_back({blurred_ball(16, 1.0 / 16), 1.0 / 16});
  cases.push_back({sampled_data(test::to_tetrahedra(make_hexahedra({14, 14, 14}, move(14))), ball, 4),
                   1.0 / (14 * std::cbrt(6.0))});
  for (auto& [data, size] : cases) {
    add_errors(0.02, data);
    const MeshReconstruction found = reconstruct_mesh(data);
    expect_volumes(data, found.mesh);
    EXPECT_NEAR(found.agreement.findings.fraction_error, 0.02, 0.01);
    double sum = 0, most = 0;
    for (const Vec3& p : found.mesh.points) {
      sum += std::abs(ball(p));
      most = std::max(most, std::abs(ball(p)));
    }
    EXPECT_LT(sum / static_cast<double>(found.mesh.points.size()), 0.06 * size);
    EXPECT_LT(most, 0.4 * size);
    EXPECT_EQ(bodies_of(found.mesh, data.mesh.box()), 2u);
    // Held to the end, errors make the surface rough.
    double rough = 0;
    for (const Vec3& p : reconstruct_mesh(data, {.error = 0.0}).mesh.points)
      rough = std::max(rough, std::abs(ball(p)));
    EXPECT_GT(rough, most);
  }
}

TEST(MeshReconstruction, AGivenErrorIsTaken) {
  MeshData data = sampled_data(jittered_cube(8), [](const Vec3& p) { return 0.47 - p.x + 0.1 * p.y; });
  EXPECT_EQ(reconstruct_mesh(data).agreement.findings.fraction_error, 0);
  EXPECT_EQ(reconstruct_mesh(data, {.error = 0.03}).agreement.findings.fraction_error, 0.03);
  expect_volumes(data, reconstruct_mesh(data, {.error = 0.03}).mesh);
}

/// Widths of steps are measured along the gradient, so that flat cells are no reason to see blur.
TEST(MeshReconstruction, SharpFractionsOfFlatCellsAreSharp) {
  const PolyhedralMesh mesh = to_mesh(make_hexahedra({8, 8, 4}, [](const Vec3& p) {
    return Vec3{p.x, p.y, 0.05 * p.z};
  }));
  const Vec3 normal = normalized(Vec3{0.02, 0.01, 1});
  const auto plane = [&](const Vec3& p) { return dot(p - Vec3{0.5, 0.5, 0.026}, normal); };
  const MeshData data = sampled_data(mesh, plane, 10);
  const MeshReconstruction found = reconstruct_mesh(data);
  expect_volumes(data, found.mesh);
  EXPECT_EQ(found.agreement.findings.blur_share, 0);
  for (const Vec3& p : found.mesh.points) EXPECT_NEAR(plane(p), 0, 0.05 * 0.05 / 4);
}

TEST(MeshReconstruction, InterfacesInTangledCellsAreClosed) {
  const PolyhedralMesh mesh = to_mesh(make_hexahedra({4, 4, 4}, [](const Vec3& p) {
    return p == Vec3{0.5, 0.5, 0.5} ? Vec3{0.95, 0.95, 0.95} : p;
  }));
  ASSERT_GT(mesh.tangled_cells(), 0u);
  MeshData data;
  data.source = "tangled";
  data.mesh = mesh;
  data.materials.push_back("a");
  data.materials.push_back("b");
  std::vector<float> a, b;
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    a.push_back(static_cast<float>(std::clamp(2 * mesh.cell_center(c).x - 0.6, 0.0, 1.0)));
    b.push_back(1 - a.back());
  }
  data.fractions.push_back(std::move(a));
  data.fractions.push_back(std::move(b));
  data.normalise();
  const MeshReconstruction found = reconstruct_mesh(data);
  const InterfaceMeshReport report = check_interface_mesh(
      found.mesh, &data.mesh.box(), {.allow_flipped_edges = true, .allow_intersections = true});
  EXPECT_EQ(report.open_border_edges, 0u);
  EXPECT_EQ(report.flipped_edges, 0u);
}

TEST(MeshReconstruction, OneMaterialFillsTheBox) {
  for (const bool labels : {false, true}) {
    MeshData data;
    data.source = "one";
    data.mesh = jittered_cube(3);
    for (const char* name : {"water", "air"}) data.materials.push_back(name);
    if (labels) {
      data.labels.assign(27, 1);
    } else {
      data.fractions.push_back(std::vector<float>(27, 0.0f));
      data.fractions.push_back(std::vector<float>(27, 1.0f));
    }
    MeshField field;
    field.name = "x";
    std::vector<double> values;
    for (std::size_t c = 0; c < 27; ++c) values.push_back(data.mesh.cell_center(c).x);
    field.values = std::move(values);
    data.fields.push_back(field);
    data.check();
    const ResamplingSource source = make_cells_source(data);
    EXPECT_EQ(source.network->table().material(source.body_at({0.5, 0.5, 0.5}, nullptr)), MaterialId(1));
    EXPECT_NEAR(source.volumes[MaterialId(1)], 1, 1e-14);
    std::vector<double> row(1);
    source.fields->values(MaterialId(1), {0.3, 0.6, 0.2}, row);
    EXPECT_NEAR(row[0], 0.3, 1e-9);
  }
}

TEST(MeshReconstruction, CellsThatShareOnlyPartsOfFacesAreRefused) {
  // A cube beside four of half its size.
  test::Hexahedra all = make_hexahedra({1, 1, 1}, [](const Vec3& p) { return p; });
  const test::Hexahedra small = make_hexahedra({1, 2, 2}, [](const Vec3& p) { return p + Vec3{1, 0, 0}; });
  const auto first = static_cast<std::uint32_t>(all.points.size());
  all.points.insert(all.points.end(), small.points.begin(), small.points.end());
  for (auto cell : small.cells) {
    for (std::uint32_t& p : cell) p += first;
    all.cells.push_back(cell);
  }
  MeshData data;
  data.source = "parts";
  data.mesh = to_mesh(all);
  data.materials.push_back("a");
  data.labels.assign(5, 0);
  try {
    reconstruct_mesh(data);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              "parts: expected cells that share whole faces, found 5 faces inside the mesh that one cell "
              "alone has, "
              "the first at 1,0.5,0.5");
  }
}

/// A droplet in one cell is too small for its value to be the greatest anywhere: it is named.
TEST(MeshReconstruction, WhatIsNotShownIsNamed) {
  MeshData data = sampled_data(jittered_cube(6), [](const Vec3& p) { return 0.5 - p.x; });
  data.materials.push_back("mist");
  std::vector<float> mist(data.mesh.cell_count(), 0.0f);
  mist[215] = 0.001f;
  data.fractions[MaterialId(1)].own()[215] = 0.999f;
  data.fractions.push_back(std::move(mist));
  data.normalise();
  const MeshReconstruction found = reconstruct_mesh(data);
  double volume = 0;
  for (const InterfaceTriangle& t : found.mesh.triangles)
    volume += t.front == MaterialId(2) || t.back == MaterialId(2) ? 1 : 0;
  if (volume == 0) {
    ASSERT_EQ(found.agreement.lost.size(), 1u);
    EXPECT_EQ(found.agreement.lost[0].material, 2u);
    EXPECT_EQ(found.agreement.lost[0].cells, 1u);
  } else {
    EXPECT_TRUE(found.agreement.lost.empty());
  }
}

TEST(MeshReconstruction, ThreadsChangeNothing) {
  const auto ball = [](const Vec3& p) { return 0.4 - distance(p, {1.1, 1.0, 0.9}); };
  const MeshData data = sampled_data(tube(5), ball, 4);
  set_thread_limit(1);
  const InterfaceMesh one = reconstruct_mesh(data).mesh;
  set_thread_limit(2);
  const InterfaceMesh two = reconstruct_mesh(data).mesh;
  set_thread_limit(0);
  EXPECT_EQ(one.points, two.points);
  EXPECT_EQ(one.triangles, two.triangles);
}

TEST(MeshFieldSource, AFieldOfDegreeOnePerMaterialComesBackExactly) {
  const auto ball = [](const Vec3& p) { return 0.4 - distance(p, {1.1, 1.0, 0.9}); };
  MeshData data = sampled_data(tube(6), ball);
  const ResamplingSource bare = make_cells_source(data);
  const auto is_in_a = [&](const Vec3& p) {
    return bare.network->table().material(bare.body_at(p, nullptr)) == MaterialId(0);
  };
  const auto of_a = [](const Vec3& p) { return 1 + 2 * p.x - p.y + 0.5 * p.z; };
  const auto of_b = [](const Vec3& p) { return 7 - p.x + 3 * p.y + p.z; };
  MeshField mixed, apart, on_points;
  mixed.name = "mixed", apart.name = "apart", on_points.name = "on points";
  on_points.centering = Centering::kPoints;
  std::vector<double> both, a, b, points;
  for (std::size_t c = 0; c < data.mesh.cell_count(); ++c) {
    const Vec3 p = data.mesh.cell_center(c);
    a.push_back(of_a(p)), b.push_back(of_b(p));
    both.push_back(is_in_a(p) ? of_a(p) : of_b(p));
  }
  mixed.values = std::move(both);
  apart.material_values.resize(2);
  apart.material_values[MaterialId(0)] = std::move(a);
  apart.material_values[MaterialId(1)] = std::move(b);
  for (const Vec3& p : data.mesh.points()) points.push_back(is_in_a(p) ? of_a(p) : of_b(p));
  on_points.values = std::move(points);
  data.fields = {mixed, apart, on_points};
  data.check();
  const ResamplingSource source = make_cells_source(data);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.01, 0.99);
  std::vector<double> row(3);
  std::vector<Vec3> gradients(3);
  for (int n = 0; n < 300; ++n) {
    const double r = 1 + uniform(random), angle = 0.5 * M_PI * uniform(random);
    const Vec3 p{r * std::cos(angle), r * std::sin(angle), uniform(random)};
    const bool in_a = is_in_a(p);
    source.fields->values_and_gradients(MaterialId(in_a ? 0 : 1), p, row, gradients);
    const double wanted = in_a ? of_a(p) : of_b(p);
    for (const double found : row) EXPECT_NEAR(found, wanted, 1e-6);
    const Vec3 slope = in_a ? Vec3{2, -1, 0.5} : Vec3{-1, 3, 1};
    for (const Vec3& g : gradients) EXPECT_LT(norm(g - slope), 1e-4);
  }
}

}  // namespace
}  // namespace adamas::interfaces
