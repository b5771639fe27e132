#include "core/data/polyhedral_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "tests/support/hexahedra.h"

namespace adamas {
namespace {

using test::jittered;
using test::make_hexahedra;
using test::to_mesh;

double total_volume(const PolyhedralMesh& mesh) {
  double sum = 0;
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) sum += mesh.cell_volume(c);
  return sum;
}

std::string error_of(std::vector<Vec3> points, std::vector<std::uint32_t> face_points,
                     const std::vector<std::uint32_t>& face_ends,
                     const std::vector<std::uint32_t>& cell_ends) {
  try {
    PolyhedralMesh::make("mesh", std::move(points), std::move(face_points), face_ends, cell_ends);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

const std::vector<Vec3> kTetrahedronPoints{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};

TEST(PolyhedralMesh, HexahedraWithMovedPointsFillTheCube) {
  const PolyhedralMesh mesh =
      to_mesh(make_hexahedra({5, 4, 3}, [](const Vec3& p) { return jittered(p, 0.05); }));
  EXPECT_EQ(mesh.cell_count(), 60u);
  EXPECT_EQ(mesh.face_count(), 6u * 4 * 3 + 5u * 5 * 3 + 5u * 4 * 4);
  EXPECT_NEAR(total_volume(mesh), 1, 1e-14);
  EXPECT_TRUE(mesh.fills_box());
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) EXPECT_GT(mesh.cell_volume(c), 0);
}

TEST(PolyhedralMesh, FacesRunCounterClockwiseFromTheSecondCell) {
  const PolyhedralMesh mesh =
      to_mesh(make_hexahedra({3, 3, 3}, [](const Vec3& p) { return jittered(p, 0.05); }));
  std::size_t boundary = 0;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto points = mesh.face(f);
    Vec3 normal;
    for (std::size_t i = 0; i < points.size(); ++i)
      normal += cross(mesh.points()[points[i]] - mesh.face_center(f),
                      mesh.points()[points[(i + 1) % points.size()]] - mesh.face_center(f));
    const auto& [first, second] = mesh.cells_of_face(f);
    EXPECT_GT(dot(normal, mesh.face_center(f) - mesh.cell_center(first)), 0);
    if (second == PolyhedralMesh::kNone) {
      ++boundary;
    } else {
      EXPECT_GT(dot(normal, mesh.cell_center(second) - mesh.face_center(f)), 0);
      EXPECT_EQ(mesh.neighbour(first, f), second);
      EXPECT_EQ(mesh.neighbour(second, f), first);
    }
  }
  EXPECT_EQ(boundary, 54u);
}

/// A mirrored mesh has the same volumes: cells are turned the right way round.
TEST(PolyhedralMesh, TheFacesOfACellEncloseIt) {
  const PolyhedralMesh mesh =
      to_mesh(make_hexahedra({3, 3, 3}, [](const Vec3& p) { return jittered(p, 0.1); }));
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    Vec3 sum;
    for (const auto f : mesh.faces_of_cell(c))
      sum += (mesh.cells_of_face(f)[0] == c ? 1.0 : -1.0) * mesh.face_area(f);
    EXPECT_LT(norm(sum), 1e-15);
  }
}

TEST(PolyhedralMesh, TurnsCellsThatAreInsideOut) {
  const PolyhedralMesh mesh = to_mesh(make_hexahedra({2, 2, 2}, [](const Vec3& p) {
    return Vec3{1 - p.x, p.y, p.z};
  }));
  EXPECT_NEAR(total_volume(mesh), 1, 1e-14);
}

/// A point that is moved through the opposite side of a cell makes it tangled; volumes still add up.
TEST(PolyhedralMesh, TangledCellsHaveVolumesBelowZero) {
  const PolyhedralMesh mesh = to_mesh(make_hexahedra({4, 4, 4}, [](const Vec3& p) {
    return p == Vec3{0.5, 0.5, 0.5} ? Vec3{0.95, 0.95, 0.95} : p;
  }));
  EXPECT_NEAR(total_volume(mesh), 1, 1e-14);
  EXPECT_TRUE(mesh.fills_box());
  EXPECT_GT(mesh.tangled_cells(), 0u);
}

TEST(PolyhedralMesh, AMeshThatIsNoBoxDoesNotFillIt) {
  const PolyhedralMesh mesh = to_mesh(make_hexahedra({3, 3, 3}, [](const Vec3& p) {
    return Vec3{p.x + 0.3 * p.z, p.y, p.z};
  }));
  EXPECT_NEAR(total_volume(mesh), 1, 1e-14);
  EXPECT_FALSE(mesh.fills_box());
}

TEST(PolyhedralMesh, RefusesCellsThatCannotBe) {
  EXPECT_EQ(error_of(kTetrahedronPoints, {0, 1, 2, 0, 1, 3, 0, 2, 3}, {3, 6, 9}, {3}),
            "mesh: expected closed cells, found cell 0 with an edge of one or three faces");
  EXPECT_EQ(error_of(kTetrahedronPoints, {0, 1, 2, 0, 1, 3, 0, 2, 3, 1, 2}, {3, 6, 9, 11}, {4}),
            "mesh: cell 0: expected faces of three points and more, found 2");
  EXPECT_EQ(error_of(kTetrahedronPoints, {0, 1, 2, 0, 1, 3, 0, 2, 3, 1, 2, 7}, {3, 6, 9, 12}, {4}),
            "mesh: expected points below 5, found a cell at point 7");
  EXPECT_EQ(error_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, NAN}}, {0, 1, 2, 0, 1, 3, 0, 2, 3, 1, 2, 3},
                     {3, 6, 9, 12}, {4}),
            "mesh: expected finite coordinates, found none at point 3");
  // Two cells at one place.
  const std::vector<std::uint32_t> one{0, 1, 2, 0, 1, 3, 0, 2, 3, 1, 2, 3};
  std::vector<std::uint32_t> twice = one;
  twice.insert(twice.end(), one.begin(), one.end());
  EXPECT_EQ(error_of(kTetrahedronPoints, twice, {3, 6, 9, 12, 15, 18, 21, 24}, {4, 8}),
            "mesh: expected cells with a volume, found none round cell 0");
  twice.insert(twice.end(), one.begin(), one.end());
  EXPECT_EQ(error_of(kTetrahedronPoints, twice, {3, 6, 9, 12, 15, 18, 21, 24, 27, 30, 33, 36}, {4, 8, 12}),
            "mesh: expected faces of two cells at most, found one of the cells 0, 1 and 2");
  EXPECT_EQ(error_of(kTetrahedronPoints, {}, {}, {}), "mesh: expected cells, found none");
}

}  // namespace
}  // namespace adamas
