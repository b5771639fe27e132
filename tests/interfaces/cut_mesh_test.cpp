#include "interfaces/cutting/cut_mesh.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <random>
#include <set>

#include "interfaces/cutting/cut_mesh_file.h"
#include "interfaces/probe/cell_locator.h"
#include "tests/interfaces/cutting_meshes.h"

namespace adamas::test {

using namespace datasets;
using namespace interfaces;

namespace {

struct CutCase {
  std::string scene;
  std::uint64_t seed = 0;
  std::size_t cells = 12;
  double error = 0.02;      ///< as a part of the diagonal
  bool same_bodies = true;  ///< no necks of bodies are thinner than the tolerance
};

std::ostream& operator<<(std::ostream& stream, const CutCase& c) {
  return stream << c.scene << " " << c.seed << " at " << c.error;
}

/// Returns numbers of points; points that coincide, within 1e-11 of the diagonal, have the same one.
std::vector<std::size_t> merged(const std::vector<Vec3>& points, double diagonal) {
  std::map<std::array<std::int64_t, 3>, std::vector<std::size_t>> cells;
  const double size = 1e-11 * diagonal;
  std::vector<std::size_t> number(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<std::int64_t, 3> at{};
    for (int axis = 0; axis < 3; ++axis)
      at[static_cast<std::size_t>(axis)] = std::llround(points[i][axis] / size);
    number[i] = i;
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        for (std::int64_t dz = -1; dz <= 1; ++dz) {
          const auto found = cells.find({at[0] + dx, at[1] + dy, at[2] + dz});
          if (found == cells.end()) continue;
          for (const std::size_t other : found->second) {
            if (distance(points[i], points[other]) <= size) number[i] = std::min(number[i], other);
          }
        }
      }
    }
    if (number[i] == i) cells[at].push_back(i);
  }
  return number;
}

class CutMeshes : public testing::TestWithParam<CutCase> {
 protected:
  void SetUp() override {
    const CutCase& c = GetParam();
    mesh_ = resampled_scene(c.scene, c.seed, c.cells, c.error);
    tolerance_ = 0.5 * c.error * mesh_.box.diagonal();
    cut_ = cut_mesh(mesh_, tolerance_);
  }

  void expect_to_conform() const;
  void expect_bodies_to_come_apart() const;
  void expect_no_slivers() const;
  void expect_distances_to_be_bounds(const CutMeshExamination& report) const;
  void expect_owners_of_the_mesh(const CutMeshExamination& report) const;

  ResampledMesh mesh_;
  ConformingMesh cut_;
  double tolerance_ = 0;
};

using Faces = std::map<std::array<std::size_t, 3>, int>;

std::array<std::size_t, 3> sorted(std::array<std::size_t, 3> face) {
  std::sort(face.begin(), face.end());
  return face;
}

/// Returns the number of tetrahedra at each face; points have these numbers.
Faces faces_of(const SolverMesh& mesh, const std::vector<std::size_t>& number) {
  Faces faces;
  for (const auto& v : mesh.tetrahedra) {
    for (std::size_t i = 0; i < 4; ++i)
      ++faces[sorted({number[v[(i + 1) % 4]], number[v[(i + 2) % 4]], number[v[(i + 3) % 4]]})];
  }
  return faces;
}

/// Returns the number of groups between materials that each face belongs to.
Faces interface_faces_of(const SolverMesh& mesh, const std::vector<std::size_t>& number) {
  Faces faces;
  for (const auto& group : mesh.face_groups) {
    if (group.name.find(" | ") == std::string::npos) continue;
    for (const SolverMesh::Face& face : group.faces) {
      const auto v = mesh.corners(face);
      ++faces[sorted({number[v[0]], number[v[1]], number[v[2]]})];
    }
  }
  return faces;
}

std::vector<std::size_t> own_numbers(const SolverMesh& mesh) {
  std::vector<std::size_t> number(mesh.points.size());
  std::iota(number.begin(), number.end(), std::size_t{0});
  return number;
}

bool on_box(const Box3& box, const std::vector<Vec3>& points, const std::array<std::size_t, 3>& face) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double wall : {box.min[axis], box.max[axis]}) {
      if (std::all_of(face.begin(), face.end(), [&](std::size_t p) { return points[p][axis] == wall; }))
        return true;
    }
  }
  return false;
}

/// Checks the mesh as it is written. By the numbers of points alone, each face inside the box belongs to two
/// tetrahedra, each other face lies on the box, and the faces with two bodies are those of the groups.
void CutMeshes::expect_to_conform() const {
  const SolverMesh written = to_solver_mesh(cut_, mesh_);
  for (const Vec3& p : written.points) ASSERT_TRUE(mesh_.box.contains(p));
  const auto number = own_numbers(written);
  for (const auto& [face, count] : faces_of(written, number)) {
    ASSERT_TRUE(face[0] != face[1] && face[1] != face[2]);
    ASSERT_EQ(count, on_box(mesh_.box, written.points, face) ? 1 : 2);
  }
  std::map<std::array<std::size_t, 3>, std::set<std::int32_t>> bodies;
  for (std::size_t t = 0; t < written.tetrahedra.size(); ++t) {
    const auto& v = written.tetrahedra[t];
    for (std::size_t i = 0; i < 4; ++i)
      bodies[sorted({v[(i + 1) % 4], v[(i + 2) % 4], v[(i + 3) % 4]})].insert(written.body[t]);
  }
  std::erase_if(bodies, [](const auto& entry) { return entry.second.size() < 2; });
  const Faces grouped = interface_faces_of(written, number);
  EXPECT_EQ(grouped.size(), bodies.size());
  for (const auto& [face, count] : grouped) {
    ASSERT_TRUE(bodies.contains(face));
    ASSERT_EQ(count, 1);
  }
}

/// Expects that, where points are split between bodies, no two bodies share a point, the faces between them
/// are open and in two groups that coincide, and nothing else changes.
void CutMeshes::expect_bodies_to_come_apart() const {
  const SolverMesh shared = to_solver_mesh(cut_, mesh_);
  const SolverMesh split = to_solver_mesh(cut_, mesh_, PointsOfBodies::kSplit);
  EXPECT_EQ(shared.body, split.body);
  std::vector<std::set<std::int32_t>> bodies(split.points.size());
  for (std::size_t t = 0; t < split.tetrahedra.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      bodies[split.tetrahedra[t][i]].insert(split.body[t]);
      ASSERT_EQ(split.points[split.tetrahedra[t][i]], shared.points[shared.tetrahedra[t][i]]);
    }
  }
  for (const auto& of_point : bodies) ASSERT_EQ(of_point.size(), 1u);
  std::size_t open = 0;
  for (const auto& [face, count] : faces_of(split, own_numbers(split)))
    open += count == 1 && !on_box(mesh_.box, split.points, face) ? 1 : 0;
  const Faces once = interface_faces_of(shared, own_numbers(shared));
  EXPECT_EQ(open, 2 * once.size());
  const Faces twice = interface_faces_of(split, merged(split.points, mesh_.box.diagonal()));
  EXPECT_EQ(twice.size(), once.size());
  for (const auto& [face, count] : twice) ASSERT_EQ(count, 2);
}

void CutMeshes::expect_no_slivers() const {
  double sum = 0;
  for (std::size_t t = 0; t < cut_.tetrahedra.size(); ++t) {
    const auto x = cut_.corners(t);
    const double volume = signed_volume(x[0], x[1], x[2], x[3]);
    ASSERT_GT(volume, 0);
    sum += volume;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        // The dihedral angle at the edge is the angle between the other two corners, seen along the edge.
        std::vector<Vec3> aside;
        const Vec3 along = normalized(x[i] - x[j]);
        for (std::size_t k = 0; k < 4; ++k) {
          if (k != i && k != j) aside.push_back((x[k] - x[j]) - dot(x[k] - x[j], along) * along);
        }
        const double angle = std::acos(dot(normalized(aside[0]), normalized(aside[1]))) * 180 / M_PI;
        ASSERT_GT(angle, 5) << "at (" << x[i].x << ", " << x[i].y << ", " << x[i].z << ")";
        ASSERT_LT(angle, 175);
      }
    }
  }
  EXPECT_NEAR(sum, mesh_.box.volume(), 1e-12 * mesh_.box.volume());
}

/// Expects that the reported distances are bounds: no point of a face between materials is farther from the
/// mesh's interfaces, nor the other way round.
void CutMeshes::expect_distances_to_be_bounds(const CutMeshExamination& report) const {
  if (GetParam().same_bodies) {
    EXPECT_LE(report.distance.networks.upper, 2 * tolerance_);
  }
  const ExtractedInterfaces of_mesh = approximated_interfaces(mesh_);
  const ExtractedInterfaces of_cut = interfaces_of(cut_, mesh_.table);
  const auto seen = [](const InterfaceMesh& from, const InterfaceMesh& to) {
    std::vector<ClosestPointTree::Triangle> triangles;
    for (const auto& t : to.triangles) triangles.push_back(t.points);
    const ClosestPointTree tree(to.points, triangles);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    double greatest = 0;
    for (const auto& t : from.triangles) {
      double u = uniform(random), v = uniform(random);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3 p = from.points[t.points[0]] + u * (from.points[t.points[1]] - from.points[t.points[0]]) +
                     v * (from.points[t.points[2]] - from.points[t.points[0]]);
      greatest = std::max(greatest, std::sqrt(tree.closest(p)->squared_distance));
      for (const std::uint32_t c : t.points)
        greatest = std::max(greatest, std::sqrt(tree.closest(from.points[c])->squared_distance));
    }
    return greatest;
  };
  EXPECT_LE(seen(of_cut.mesh, of_mesh.mesh), report.distance.networks.upper * (1 + 1e-9) + 1e-12);
  EXPECT_LE(seen(of_mesh.mesh, of_cut.mesh), report.distance.networks.upper * (1 + 1e-9) + 1e-12);
}

/// Expects that a tetrahedron that is farther from the interfaces than the certified distance has the owner
/// that the mesh gives its middle.
void CutMeshes::expect_owners_of_the_mesh(const CutMeshExamination& report) const {
  if (GetParam().same_bodies) {
    EXPECT_TRUE(report.changed.empty());
  }
  const ExtractedInterfaces of_mesh = approximated_interfaces(mesh_);
  std::vector<ClosestPointTree::Triangle> triangles;
  for (const auto& t : of_mesh.mesh.triangles) triangles.push_back(t.points);
  const ClosestPointTree tree(of_mesh.mesh.points, triangles);
  const CellLocator locator(mesh_);
  std::size_t looked_at = 0;
  for (std::size_t t = 0; t < cut_.tetrahedra.size(); ++t) {
    const auto x = cut_.corners(t);
    const Vec3 middle = 0.25 * (x[0] + x[1] + x[2] + x[3]);
    if (std::sqrt(tree.closest(middle)->squared_distance) <= report.distance.materials.upper) continue;
    const auto place = locator.locate(middle);
    CellOwnership ownership;
    mesh_.ownership(place->cell, ownership);
    const std::uint32_t owner =
        ownership.pure() ? ownership.problem.candidates[0].owner : ownership.problem.owner(place->weights);
    ASSERT_EQ(owner, cut_.bodies[t].value);
    ++looked_at;
  }
  EXPECT_GT(looked_at, cut_.tetrahedra.size() / 20);
}

TEST_P(CutMeshes, KeepTheirLaws) {
  expect_to_conform();
  expect_bodies_to_come_apart();
  expect_no_slivers();
  const CutMeshExamination report = examine_cut_mesh(cut_, mesh_, tolerance_);
  expect_distances_to_be_bounds(report);
  expect_owners_of_the_mesh(report);
}

INSTANTIATE_TEST_SUITE_P(Scenes, CutMeshes,
                         testing::Values(CutCase{"sphere"}, CutCase{"sphere", 0, 16, 0.01},
                                         CutCase{"plate", 0, 12, 0.02, false}, CutCase{"plate", 0, 16, 0.01},
                                         CutCase{"tjunction", 0, 16}, CutCase{"reflex"},
                                         CutCase{"voronoi10", 0, 12, 0.03},
                                         CutCase{"random", 1, 8, 0.04, false},
                                         CutCase{"random", 3, 8, 0.04, false}));

}  // namespace

}  // namespace adamas::test
