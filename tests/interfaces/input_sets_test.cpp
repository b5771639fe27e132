#include "interfaces/cutting/input_sets.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <set>

#include "interfaces/mesh/conforming_mesh.h"
#include "tests/support/hexahedra.h"

namespace adamas::interfaces {
namespace {

using test::make_hexahedra;

/// Tetrahedra of the unit cube in two blocks, with its sides and the plane between the blocks as groups.
SolverMesh two_blocks(std::uint32_t n) {
  const test::Hexahedra hexahedra = make_hexahedra({n, n, n}, [](const Vec3& p) { return p; });
  SolverMesh mesh;
  mesh.points = hexahedra.points;
  mesh.blocks = {"left", "right"};
  mesh.face_groups = {{"boundary", {}}, {"left | right", {}}};
  for (const auto& cell : hexahedra.cells) {
    for (const auto& [b, c] : {std::pair(1, 2), std::pair(2, 3), std::pair(3, 7), std::pair(7, 4),
                               std::pair(4, 5), std::pair(5, 1)})
      mesh.tetrahedra.push_back(
          {cell[0], cell[static_cast<std::size_t>(b)], cell[static_cast<std::size_t>(c)], cell[6]});
  }
  std::map<std::set<std::uint32_t>, std::vector<SolverMesh::Face>> faces;
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    Vec3 center;
    for (const std::uint32_t p : mesh.tetrahedra[t]) center += 0.25 * mesh.points[p];
    mesh.block.push_back(center.x < 0.5 ? 0 : 1);
    for (std::uint8_t i = 0; i < 4; ++i) {
      const auto corners = mesh.corners({t, i});
      faces[{corners.begin(), corners.end()}].push_back({t, i});
    }
  }
  for (const auto& [key, of_face] : faces) {
    if (of_face.size() == 1) mesh.face_groups[0].faces.push_back(of_face[0]);
    if (of_face.size() == 2 && mesh.block[of_face[0].tetrahedron] != mesh.block[of_face[1].tetrahedron])
      mesh.face_groups[1].faces.push_back(of_face[0]);
  }
  return mesh;
}

Vec3 center_of(const SolverMesh& mesh, const SolverMesh::Face& face) {
  Vec3 center;
  for (const std::uint32_t p : mesh.corners(face)) center += (1.0 / 3) * mesh.points[p];
  return center;
}

/// Coarse cells with sets of their faces: those for which the functions are true of the centre.
MeshData with_sets(const std::map<std::string, std::function<bool(const Vec3&)>>& sets) {
  MeshData data;
  data.mesh = test::to_mesh(make_hexahedra({4, 4, 4}, [](const Vec3& p) { return p; }));
  for (const auto& [name, is_in] : sets) {
    MeshSet set{name};
    for (std::size_t f = 0; f < data.mesh.face_count(); ++f) {
      if (is_in(data.mesh.face_center(f))) set.add_side(data.mesh.face(f));
    }
    data.sets.push_back(set);
  }
  return data;
}

TEST(InputSets, FacesAreInTheSetsOfTheInputsFacesThatTheyLieOn) {
  const std::map<std::string, std::function<bool(const Vec3&)>> sets{
      {"inlet", [](const Vec3& p) { return p.x == 0 && p.y < 0.5; }},
      {"wall", [](const Vec3& p) { return p.x == 0 || p.y == 0; }},
      {"membrane", [](const Vec3& p) { return p.x == 0.5 && p.z < 0.5; }},
      {"somewhere else", [](const Vec3& p) { return p.y == 0.5; }}};
  const MeshData data = with_sets(sets);
  SolverMesh mesh = two_blocks(8);
  const SolverMesh before = mesh;
  add_input_sets(data, 0.01, mesh);
  // No face of a group lies on the last set.
  ASSERT_EQ(mesh.face_groups.size(), 5u);
  for (std::size_t g = 2; g < 5; ++g) {
    const SolverMesh::FaceGroup& found = mesh.face_groups[g];
    std::set<std::pair<std::uint32_t, std::uint8_t>> wanted, had;
    for (std::size_t known = 0; known < 2; ++known) {
      for (const SolverMesh::Face& face : before.face_groups[known].faces) {
        if (sets.at(found.name)(center_of(mesh, face))) wanted.insert({face.tetrahedron, face.opposite});
      }
    }
    for (const SolverMesh::Face& face : found.faces) had.insert({face.tetrahedron, face.opposite});
    EXPECT_EQ(had, wanted) << found.name;
    EXPECT_EQ(had.size(), found.faces.size()) << "no face is there twice";
    EXPECT_FALSE(wanted.empty());
  }
}

TEST(InputSets, ATakenNameIsToldApart) {
  SolverMesh mesh = two_blocks(4);
  add_input_sets(with_sets({{"boundary", [](const Vec3& p) { return p.z == 1; }}}), 0.01, mesh);
  ASSERT_EQ(mesh.face_groups.size(), 3u);
  EXPECT_EQ(mesh.face_groups[2].name, "boundary (input)");
  EXPECT_EQ(mesh.face_groups[2].faces.size(), 32u);
}

/// Node sets have no sides.
TEST(InputSets, NodeSetsAddNothing) {
  MeshData data = with_sets({});
  data.sets.push_back({"corner", true, {0, 1, 2}, {}});
  SolverMesh mesh = two_blocks(4);
  add_input_sets(data, 0.01, mesh);
  EXPECT_EQ(mesh.face_groups.size(), 2u);
}

}  // namespace
}  // namespace adamas::interfaces
