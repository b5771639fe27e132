#include "interfaces/cutting/labelled_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "core/base/error.h"
#include "interfaces/cutting/cell_division.h"
#include "interfaces/cutting/local_changes.h"
#include "interfaces/cutting/mesh_improvement.h"
#include "interfaces/resampling/body_comparison.h"
#include "tests/interfaces/cutting_meshes.h"

namespace adamas::test {

using namespace interfaces;

namespace {

/// Throws Error that begins with `name` and names the first broken law: positive volumes; each face in two
/// cells or on the box; complete stars.
void validate(const LabelledMesh& cut, const std::string& name) {
  const ConformingMesh mesh = cut.finish();
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto x = mesh.corners(t);
    if (!(signed_volume(x[0], x[1], x[2], x[3]) > 0)) {
      fail("{}: tetrahedron at ({}, {}, {}): expected a positive volume, found {}", name, x[0].x, x[0].y,
           x[0].z, signed_volume(x[0], x[1], x[2], x[3]));
    }
  }
  for (std::uint32_t c = 0; c < cut.cell_count(); ++c) {
    if (!cut.is_alive(c)) continue;
    for (const std::uint32_t v : cut.cell(c).vertices) {
      if (std::count(cut.star(v).begin(), cut.star(v).end(), c) != 1)
        fail("{}: vertex {}: expected cell {} in its star once", name, v, c);
      std::uint8_t walls = 0x3f;
      for (const std::uint32_t w : cut.cell(c).vertices) {
        if (w != v) walls &= cut.walls(w);
      }
      if ((cut.neighbour(c, v) == kNoNeighbour) != (walls != 0))
        fail("{}: cell {}: expected two cells at each face inside the box, found one, or two at the box",
             name, c);
    }
  }
  (void)find_neighbours(mesh.tetrahedra, name);
}

/// The cells of a scene, divided between their owners.
struct Divided {
  Divided(const std::string& scene, std::uint64_t seed, std::size_t cells, double error)
      : Divided(resampled_scene(scene, seed, cells, error), 0.5 * error * std::sqrt(3.0)) {}
  Divided(ResampledMesh resampled, double length)
      : mesh(std::move(resampled)),
        tolerance(length),
        cut(divide_cells(BisectedCells(mesh, tolerance, SilentProgress::instance()))),
        target(approximated_interfaces(mesh), tolerance) {}

  [[nodiscard]] IdVector<BodyId, BodyTopology> topology() const {
    return body_topology(interfaces_of(cut.finish(), mesh.table), mesh.table.body_count(), mesh.box);
  }
  /// Returns Euler characteristics by the set of bodies, and of sides of the box, that meet: the number of
  /// simplices with this set, with alternating signs by dimension. They tell more than the bodies' own
  /// characteristics.
  [[nodiscard]] std::map<std::vector<std::uint32_t>, long> euler_by_bodies() const {
    std::map<std::vector<std::uint32_t>, std::vector<std::uint32_t>> simplices;  // points -> bodies and walls
    for (std::uint32_t c = 0; c < cut.cell_count(); ++c) {
      if (!cut.is_alive(c)) continue;
      for (unsigned set = 1; set < 16; ++set) {
        std::vector<std::uint32_t> points;
        std::uint8_t walls = 0x3f;
        for (std::size_t i = 0; i < 4; ++i) {
          if ((set >> i & 1u) == 0) continue;
          points.push_back(cut.cell(c).vertices[i]);
          walls &= cut.walls(points.back());
        }
        std::sort(points.begin(), points.end());
        auto& bodies = simplices[points];
        bodies.push_back(cut.cell(c).body.value);
        for (std::uint32_t wall = 0; wall < 6; ++wall) {
          if ((walls >> wall & 1u) != 0) bodies.push_back(1000 + wall);
        }
      }
    }
    std::map<std::vector<std::uint32_t>, long> euler;
    for (auto& [points, bodies] : simplices) {
      std::sort(bodies.begin(), bodies.end());
      bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
      euler[bodies] += points.size() % 2 == 1 ? 1 : -1;
    }
    std::erase_if(euler, [](const auto& entry) { return entry.second == 0; });
    return euler;
  }

  ResampledMesh mesh;
  double tolerance;
  LabelledMesh cut;
  InterfaceTarget target;
};

TEST(LabelledMeshes, DividedCellsConform) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Divided divided("random", seed, 5, 0.08);
    EXPECT_NO_THROW(validate(divided.cut, "divided"));
    double volume = 0;
    for (const double body : body_volumes(divided.cut.finish(), divided.mesh.table.body_count()))
      volume += body;
    EXPECT_NEAR(volume, divided.mesh.box.volume(), 1e-12 * divided.mesh.box.volume());
  }
}

/// Coordinates on the box are interpolated, and are a third away from any number with few digits; still they
/// lie exactly on the box.
TEST(LabelledMeshes, VerticesOnTheBoxLieThereExactly) {
  ResampledMesh mesh = uniform_mesh(6, [](const Vec3& p) { return distance(p, Vec3{0, 0.4, 0.9}) - 0.7; });
  const auto place = [](const Vec3& p) { return (1.0 / 3) * p + Vec3{-0.7, 0.1, 1.3}; };
  for (Vec3& p : mesh.points) p = place(p);
  mesh.box = {place(mesh.box.min), place(mesh.box.max)};
  const LabelledMesh cut =
      divide_cells(BisectedCells(mesh, 0.01 * mesh.box.diagonal(), SilentProgress::instance()));
  std::size_t on_box = 0;
  for (std::uint32_t v = 0; v < cut.vertex_count(); ++v) {
    EXPECT_TRUE(mesh.box.contains(cut.point(v)));
    for (int axis = 0; axis < 3; ++axis) {
      const unsigned ends = cut.walls(v) >> (2 * axis) & 3u;
      if (ends == 0) continue;
      EXPECT_EQ(cut.point(v)[axis], ends == 1 ? mesh.box.min[axis] : mesh.box.max[axis]);
      ++on_box;
    }
  }
  EXPECT_GT(on_box, mesh.points.size() / 3);
}

/// Random changes are made in random places. After each of them all laws hold, and the topology is the same:
/// the characteristics of all bodies, interfaces, lines and points, on the box and inside.
TEST(LabelledMeshes, RandomChangesKeepAllLaws) {
  std::array<int, 6> made{};
  for (const std::uint64_t seed : {1, 7}) {
    Divided divided("random", seed, 5, 0.08);
    LabelledMesh& cut = divided.cut;
    const auto before = divided.euler_by_bodies();
    const auto bodies = divided.topology();
    std::mt19937 random(static_cast<unsigned>(seed));
    LocalChange change;
    for (int step = 0; step < 2500; ++step) {
      const auto c = static_cast<std::uint32_t>(random() % cut.cell_count());
      if (!cut.is_alive(c)) continue;
      const auto v = cut.cell(c).vertices;
      const std::size_t i = random() % 4, j = (i + 1 + random() % 3) % 4;
      const auto kind = random() % 6;
      bool done = false;
      if (kind == 0)
        done = collapse_edge(cut, divided.target, v[i], v[j], least_quality(cut, cut.star(v[i])), change);
      if (kind == 1) done = remove_edge(cut, divided.target, v[i], v[j], change);
      if (kind == 2) done = remove_face(cut, c, v[i], change);
      if (kind == 3 && (done = split_edge(cut, v[i], v[j], change)))
        cut.add_vertex(change.point, change.walls);
      if (done) cut.replace(change.removed, change.added);
      if (kind == 4) done = smooth_vertex(cut, divided.target, v[i]);
      const std::uint32_t other = kind == 5 ? cut.neighbour(c, v[i]) : kNoNeighbour;
      if (kind == 5 && other != kNoNeighbour && cut.cell(other).body != cut.cell(c).body &&
          (done = may_change_body(cut, divided.target, c, cut.cell(other).body)))
        cut.set_body(c, cut.cell(other).body);
      if (!done) continue;
      if (++made[kind] % 16 == 0) {
        ASSERT_NO_THROW(validate(cut, "changed"));
      }
    }
    EXPECT_EQ(divided.euler_by_bodies(), before) << "seed " << seed;
    EXPECT_EQ(divided.topology(), bodies);
  }
  for (const int count : made) EXPECT_GT(count, 0);
}

TEST(LabelledMeshes, ImprovingKeepsTheTopologyOfBodies) {
  for (const auto& [scene, seed] :
       {std::pair<std::string, std::uint64_t>{"tjunction", 0}, {"voronoi10", 0}, {"random", 1}}) {
    SCOPED_TRACE(scene);
    Divided divided(scene, seed, 8, 0.04);
    const auto bodies = divided.topology();
    improve_mesh(divided.cut, divided.target, 0.2, SilentProgress::instance());
    ASSERT_NO_THROW(validate(divided.cut, "improved"));
    EXPECT_EQ(divided.topology(), bodies);
    const std::size_t cells = divided.cut.finish().tetrahedra.size();
    coarsen_mesh(divided.cut, divided.target, static_cast<std::uint32_t>(divided.mesh.points.size()), 0.2,
                 SilentProgress::instance());
    ASSERT_NO_THROW(validate(divided.cut, "coarsened"));
    EXPECT_EQ(divided.topology(), bodies);
    EXPECT_LT(divided.cut.finish().tetrahedra.size(), cells);
  }
}

/// The angles that are wanted are impossible where cells of a checkerboard meet: dividing edges there makes
/// ever more cells that are too flat.
TEST(LabelledMeshes, ImprovingEndsWhereItMakesMoreBadCells) {
  MultiMaterialData data;
  data.source = "checkerboard";
  data.grid = RectilinearGrid::uniform({4, 4, 4}, {0, 0, 0}, {1, 1, 1});
  data.materials = {"black", "white"};
  for (std::size_t site = 0; site < 64; ++site)
    data.labels.push_back(static_cast<std::uint16_t>((site + site / 4 + site / 16) % 2));
  const ResamplingSource source = make_grid_source(data);
  ResamplingOptions options;
  options.interface_error = 0.03 * source.box.diagonal();
  Resampler resampler(source, options);
  resampler.refine();
  Divided divided(resampled_mesh(resampler), 0.5 * options.interface_error);
  const auto bodies = divided.topology();
  const std::size_t before = divided.cut.alive_count();
  EXPECT_FALSE(improve_mesh(divided.cut, divided.target, 0.2, SilentProgress::instance()));
  ASSERT_NO_THROW(validate(divided.cut, "improved"));
  EXPECT_EQ(divided.topology(), bodies);
  EXPECT_LT(divided.cut.alive_count(), 2 * before);
}

TEST(LabelledMeshes, QualityOfSimpleTetrahedra) {
  EXPECT_NEAR(least_dihedral_sine({1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}), std::sqrt(8.0) / 3,
              1e-15);
  EXPECT_NEAR(least_dihedral_sine({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), std::sqrt(2.0 / 3), 1e-15);
  EXPECT_LT(least_dihedral_sine({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}), 0);
  EXPECT_EQ(least_dihedral_sine({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}), 0);
  EXPECT_EQ(least_dihedral_sine({0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {1, 1, 0}), 0);
}

}  // namespace

}  // namespace adamas::test
