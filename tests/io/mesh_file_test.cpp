#include "core/io/mesh_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataSetWriter.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkStructuredGrid.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLMultiBlockDataWriter.h>
#include <vtkXMLStructuredGridWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <cmath>
#include <random>

#include "core/io/mesh_data_reader.h"
#include "sample_data.h"
#include "tests/support/hexahedra.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::bytes_of;
using test::error_of;
using test::put_bytes;
using test::says;
using test::Scratch;

vtkSmartPointer<vtkUnstructuredGrid> grid_of(const std::vector<Vec3>& points) {
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  const auto places = vtkSmartPointer<vtkPoints>::New();
  places->SetDataTypeToDouble();
  for (const Vec3& p : points) places->InsertNextPoint(p.x, p.y, p.z);
  grid->SetPoints(places);
  return grid;
}

void add_values(vtkDataSetAttributes& attributes, const char* name, const std::vector<double>& values) {
  const auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  for (const double v : values) array->InsertNextValue(v);
  attributes.AddArray(array);
}

template <class Writer, class Data>
void write(const std::filesystem::path& path, Data* data) {
  const auto writer = vtkSmartPointer<Writer>::New();
  writer->SetFileName(path.c_str());
  writer->SetInputData(data);
  ASSERT_EQ(writer->Write(), 1);
}

/// The mesh of hexahedra, with the x coordinates of cells and points as arrays.
vtkSmartPointer<vtkUnstructuredGrid> hexahedra_grid(const test::Hexahedra& hexahedra) {
  const auto grid = grid_of(hexahedra.points);
  std::vector<double> of_cells, of_points;
  for (const auto& cell : hexahedra.cells) {
    std::array<vtkIdType, 8> ids{};
    std::copy(cell.begin(), cell.end(), ids.begin());
    grid->InsertNextCell(VTK_HEXAHEDRON, 8, ids.data());
    double sum = 0;
    for (const auto p : cell) sum += hexahedra.points[p].x / 8;
    of_cells.push_back(sum);
  }
  for (const Vec3& p : hexahedra.points) of_points.push_back(p.x);
  add_values(*grid->GetCellData(), "x of cells", of_cells);
  add_values(*grid->GetPointData(), "x of points", of_points);
  return grid;
}

double volume_of(const MeshFile& file) {
  const PolyhedralMesh mesh =
      PolyhedralMesh::make("mesh", file.points, file.face_points, file.face_ends, file.cell_ends);
  double sum = 0;
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) sum += mesh.cell_volume(c);
  return sum;
}

struct Shape {
  int type;
  std::vector<Vec3> points;
  double volume;
};

/// Regular prisms of five and six sides of radius and height 1.
std::vector<Vec3> prism(int sides) {
  std::vector<Vec3> points;
  for (const double z : {0.0, 1.0}) {
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * M_PI * i / sides;
      points.push_back({std::cos(angle), std::sin(angle), z});
    }
  }
  return points;
}

TEST(MeshFile, CellsOfAllShapesHaveTheirVolumes) {
  const std::vector<Vec3> cube{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                               {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  std::vector<Vec3> quadratic = cube;
  for (int i = 0; i < 12; ++i) quadratic.push_back({0.5, 0.5, 0.5});
  const std::vector<Shape> shapes{
      {VTK_TETRA, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1.0 / 6},
      {VTK_HEXAHEDRON, cube, 1},
      {VTK_VOXEL, {cube[0], cube[1], cube[3], cube[2], cube[4], cube[5], cube[7], cube[6]}, 1},
      {VTK_WEDGE, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}}, 0.5},
      {VTK_PYRAMID, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}}, 1.0 / 3},
      {VTK_PENTAGONAL_PRISM, prism(5), 2.5 * std::sin(2 * M_PI / 5)},
      {VTK_HEXAGONAL_PRISM, prism(6), 3 * std::sin(2 * M_PI / 6)},
      {VTK_QUADRATIC_HEXAHEDRON, quadratic, 1},
  };
  const Scratch scratch;
  for (const Shape& shape : shapes) {
    const auto grid = grid_of(shape.points);
    std::vector<vtkIdType> ids;
    for (std::size_t i = 0; i < shape.points.size(); ++i) ids.push_back(static_cast<vtkIdType>(i));
    grid->InsertNextCell(shape.type, static_cast<vtkIdType>(ids.size()), ids.data());
    write<vtkXMLUnstructuredGridWriter>(scratch / "a.vtu", grid.Get());
    const MeshFile file = read_mesh_file(scratch / "a.vtu");
    EXPECT_NEAR(volume_of(file), shape.volume, 1e-14) << shape.type;
    EXPECT_EQ(file.remark.empty(), shape.type != VTK_QUADRATIC_HEXAHEDRON);
  }
}

TEST(MeshFile, APolyhedronIsReadByItsFaces) {
  // A cube whose side x = 1 is divided into two.
  const auto grid = grid_of({{0, 0, 0},
                             {1, 0, 0},
                             {1, 1, 0},
                             {0, 1, 0},
                             {0, 0, 1},
                             {1, 0, 1},
                             {1, 1, 1},
                             {0, 1, 1},
                             {1, 0, 0.5},
                             {1, 1, 0.5}});
  const std::vector<vtkIdType> faces{7, 4, 0, 1, 2, 3, 4, 4, 5, 6, 7, 4, 0, 3, 7, 4, 4, 1, 2,
                                     9, 8, 4, 8, 9, 6, 5, 5, 0, 1, 8, 5, 4, 5, 3, 2, 9, 6, 7};
  const auto stream = vtkSmartPointer<vtkIdList>::New();
  for (const vtkIdType id : faces) stream->InsertNextId(id);
  grid->InsertNextCell(VTK_POLYHEDRON, stream);
  const Scratch scratch;
  write<vtkXMLUnstructuredGridWriter>(scratch / "a.vtu", grid.Get());
  const MeshFile file = read_mesh_file(scratch / "a.vtu");
  EXPECT_EQ(file.face_ends.size(), 7u);
  EXPECT_NEAR(volume_of(file), 1, 1e-14);
}

TEST(MeshFile, ArraysOfCellsAndPointsComeAlong) {
  const Scratch scratch;
  const auto hexahedra =
      test::make_hexahedra({3, 2, 2}, [](const Vec3& p) { return test::jittered(p, 0.05); });
  const auto grid = hexahedra_grid(hexahedra);
  write<vtkXMLUnstructuredGridWriter>(scratch / "a.vtu", grid.Get());
  write<vtkDataSetWriter>(scratch / "a.vtk", grid.Get());
  EXPECT_TRUE(is_mesh_by_header(scratch / "a.vtk"));
  EXPECT_TRUE(is_mesh_by_header(scratch / "a.vtu"));
  for (const char* name : {"a.vtu", "a.vtk"}) {
    const MeshFile file = read_mesh_file(scratch / name);
    EXPECT_EQ(file.cell_ends.size(), 12u);
    EXPECT_EQ(file.points.size(), 36u);
    ASSERT_EQ(file.arrays.size(), 2u);
    for (const GridArray& array : file.arrays) {
      const bool on_cells = array.centering == Centering::kCells;
      EXPECT_EQ(array.name, on_cells ? "x of cells" : "x of points");
      EXPECT_EQ(array.size(), on_cells ? 12u : 36u);
    }
  }
}

TEST(MeshFile, AStructuredGridIsReadAsHexahedra) {
  const auto grid = vtkSmartPointer<vtkStructuredGrid>::New();
  const auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  // A ring that is closed: the first and the last layer of points lie on each other.
  grid->SetDimensions(2, 13, 2);
  for (int k = 0; k < 2; ++k) {
    for (int j = 0; j < 13; ++j) {
      for (int i = 0; i < 2; ++i)
        points->InsertNextPoint((1 + i) * std::cos(2 * M_PI * j / 12), (1 + i) * std::sin(2 * M_PI * j / 12),
                                k);
    }
  }
  grid->SetPoints(points);
  const Scratch scratch;
  write<vtkXMLStructuredGridWriter>(scratch / "a.vts", grid.Get());
  const MeshFile file = read_mesh_file(scratch / "a.vts");
  EXPECT_EQ(file.cell_ends.size(), 12u);
  EXPECT_EQ(file.points.size(), 48u);
  EXPECT_NEAR(volume_of(file), 3 * 6 * std::sin(2 * M_PI / 12), 1e-12);
}

TEST(MeshFile, BlocksBecomeOneMesh) {
  const auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (unsigned b = 0; b < 2; ++b) {
    const auto grid = hexahedra_grid(test::make_hexahedra({2, 2, 2}, [b](const Vec3& p) {
      return Vec3{p.x + b, p.y, p.z};
    }));
    if (b == 1) add_values(*grid->GetCellData(), "only here", std::vector<double>(8, 1.0));
    blocks->SetBlock(b, grid);
    blocks->GetMetaData(b)->Set(vtkCompositeDataSet::NAME(), b == 0 ? "steel" : "air");
  }
  const Scratch scratch;
  write<vtkXMLMultiBlockDataWriter>(scratch / "a.vtm", blocks.Get());
  const MeshFile file = read_mesh_file(scratch / "a.vtm");
  EXPECT_EQ(file.cell_ends.size(), 16u);
  EXPECT_EQ(file.points.size(), 45u);
  EXPECT_EQ(file.blocks, (std::vector<std::string>{"steel", "air"}));
  EXPECT_TRUE(says(file.remark, "array 'only here' is not read"));
  // Blocks are materials where nothing else is.
  std::vector<std::string> notes;
  MaterialDataOptions options;
  options.note = [&](const std::string& text) { notes.push_back(text); };
  const MeshData data = read_mesh_data(scratch / "a.vtm", options);
  ASSERT_EQ(data.materials.size(), 2u);
  EXPECT_EQ(data.materials[MaterialId(0)], "steel");
  EXPECT_NEAR(data.volumes()[MaterialId(1)], 1, 1e-14);
  EXPECT_TRUE(data.mesh.fills_box());
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_TRUE(says(notes[0], "its 2 blocks are the materials"));
}

/// Pieces of an unstructured grid have points of their own, which lie on each other.
TEST(MeshFile, PiecesAreJoinedAtTheirPoints) {
  const Scratch scratch;
  for (const int n : {0, 1}) {
    const auto grid = hexahedra_grid(test::make_hexahedra({2, 2, 2}, [n](const Vec3& p) {
      return Vec3{p.x + n, p.y, p.z};
    }));
    write<vtkXMLUnstructuredGridWriter>(scratch / fmt::format("piece{}.vtu", n), grid.Get());
  }
  put_bytes(
      scratch / "a.pvtu",
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"0.1\">\n"
      "<PUnstructuredGrid GhostLevel=\"0\">\n<PCellData><PDataArray type=\"Float64\" Name=\"x of "
      "cells\"/></PCellData>\n"
      "<PPointData><PDataArray type=\"Float64\" Name=\"x of points\"/></PPointData>\n"
      "<PPoints><PDataArray type=\"Float64\" NumberOfComponents=\"3\"/></PPoints>\n"
      "<Piece Source=\"piece0.vtu\"/>\n<Piece Source=\"piece1.vtu\"/>\n</PUnstructuredGrid>\n</VTKFile>\n");
  const MeshFile file = read_mesh_file(scratch / "a.pvtu");
  EXPECT_EQ(file.cell_ends.size(), 16u);
  EXPECT_EQ(file.points.size(), 45u);
  EXPECT_TRUE(says(file.remark, "9 points at the places of others are left out"));
}

/// A hexahedron without thickness vanishes, and its neighbours meet.
TEST(MeshFile, CollapsedCellsAreLeftOut) {
  auto hexahedra = test::make_hexahedra({3, 1, 1}, [](const Vec3& p) {
    return Vec3{p.x > 0.5 && p.x < 0.9 ? 1.0 / 3 : p.x, p.y, p.z};
  });
  const auto grid = hexahedra_grid(hexahedra);
  const Scratch scratch;
  write<vtkXMLUnstructuredGridWriter>(scratch / "a.vtu", grid.Get());
  const MeshFile file = read_mesh_file(scratch / "a.vtu");
  EXPECT_EQ(file.cell_ends.size(), 2u);
  EXPECT_EQ(file.arrays[0].size(), 2u);
  EXPECT_TRUE(says(file.remark, "1 cells that have collapsed are left out"));
  EXPECT_NEAR(volume_of(file), 1, 1e-14);
}

TEST(MeshFile, CopiesOfCellsOfOtherPiecesAreLeftOut) {
  const auto grid = hexahedra_grid(test::make_hexahedra({2, 2, 2}, [](const Vec3& p) { return p; }));
  const auto ghosts = vtkSmartPointer<vtkUnsignedCharArray>::New();
  ghosts->SetName("vtkGhostType");
  for (int c = 0; c < 8; ++c) ghosts->InsertNextValue(c < 2 ? 1 : 0);
  grid->GetCellData()->AddArray(ghosts);
  const Scratch scratch;
  write<vtkXMLUnstructuredGridWriter>(scratch / "a.vtu", grid.Get());
  EXPECT_EQ(read_mesh_file(scratch / "a.vtu").cell_ends.size(), 6u);
}

TEST(MeshData, FlatCellsTurnedRoundTheAxisAreRings) {
  const Scratch scratch;
  // Two columns of two rectangles, from the axis out to 2 and from 0 up to 1.
  std::vector<Vec3> points;
  for (const double y : {0.0, 0.25, 1.0}) {
    for (const double x : {0.0, 0.5, 2.0}) points.push_back({x, y, 0});
  }
  const auto grid = grid_of(points);
  std::vector<double> of_points;
  for (const Vec3& p : points) of_points.push_back(p.x);
  for (const vtkIdType corner : {0, 1, 3, 4}) {
    const std::array<vtkIdType, 4> ids{corner, corner + 1, corner + 4, corner + 3};
    grid->InsertNextCell(VTK_QUAD, 4, ids.data());
  }
  add_values(*grid->GetCellData(), "Volume Fraction for oil", {1, 0, 0, 0.5});
  add_values(*grid->GetCellData(), "Volume Fraction for air", {0, 1, 1, 0.5});
  add_values(*grid->GetPointData(), "r", of_points);
  write<vtkXMLUnstructuredGridWriter>(scratch / "flat.vtu", grid.Get());
  MaterialDataOptions options;
  EXPECT_TRUE(says(error_of([&] { read_mesh_data(scratch / "flat.vtu", options); }), "--axisymmetric"));
  options.axisymmetric = true;
  const MeshData data = read_mesh_data(scratch / "flat.vtu", options);
  EXPECT_EQ(data.mesh.tangled_cells(), 0u);
  const double inner = M_PI * 0.25, outer = M_PI * (4 - 0.25);
  EXPECT_NEAR(data.volumes()[MaterialId(0)], 0.25 * inner + 0.5 * 0.75 * outer, 1e-12);
  EXPECT_NEAR(data.volumes()[MaterialId(1)], 0.75 * inner + (0.25 + 0.375) * outer, 1e-12);
  ASSERT_EQ(data.fields.size(), 1u);
  const double stretch = data.mesh.box().max.x / 2;
  for (std::size_t p = 0; p < data.mesh.points().size(); ++p) {
    const Vec3& at = data.mesh.points()[p];
    EXPECT_NEAR(data.fields[0].values[p] * stretch, std::hypot(at.x, at.z), 1e-9);
  }
  points[0].x = -1;
  const auto wrong = grid_of(points);
  const std::array<vtkIdType, 4> ids{0, 1, 4, 3};
  wrong->InsertNextCell(VTK_QUAD, 4, ids.data());
  write<vtkXMLUnstructuredGridWriter>(scratch / "wrong.vtu", wrong.Get());
  EXPECT_TRUE(says(error_of([&] { read_mesh_data(scratch / "wrong.vtu", options); }),
                   "--axisymmetric: expected x of 0 or more, found -1"));
}

TEST(MeshData, FractionsAndFieldsAreFoundByTheirNames) {
  const auto hexahedra = test::make_hexahedra({2, 2, 2}, [](const Vec3& p) { return 2 * p; });
  const auto grid = hexahedra_grid(hexahedra);
  std::vector<double> water, air;
  for (int c = 0; c < 8; ++c) water.push_back(c / 8.0), air.push_back(1 - c / 8.0);
  add_values(*grid->GetCellData(), "Volume Fraction for water", water);
  add_values(*grid->GetCellData(), "Volume Fraction for air", air);
  add_values(*grid->GetCellData(), "density for water [kg/m3]", water);
  const Scratch scratch;
  write<vtkXMLUnstructuredGridWriter>(scratch / "a.vtu", grid.Get());
  const MeshData data = read_mesh_data(scratch / "a.vtu");
  ASSERT_EQ(data.materials.size(), 2u);
  EXPECT_EQ(data.fraction(MaterialId(0), 3), 0.375f);
  ASSERT_EQ(data.fields.size(), 3u);
  EXPECT_EQ(data.fields[1].unit, "kg/m3");
  EXPECT_TRUE(data.fields[1].per_material());
  EXPECT_EQ(data.fields[2].centering, Centering::kPoints);
  MaterialDataOptions labels;
  labels.labels = "x of points";
  EXPECT_TRUE(says(error_of([&] { read_mesh_data(scratch / "a.vtu", labels); }),
                   "expected labels of cells, found those of points"));
}

/// Every flipped byte and every truncation is answered: by data that are whole, or by an error of one line
/// that names the file.
TEST(MeshData, DamagedFilesAreAnsweredInOneLine) {
  const auto hexahedra = test::make_hexahedra({2, 2, 2}, [](const Vec3& p) { return p; });
  const auto grid = hexahedra_grid(hexahedra);
  add_values(*grid->GetCellData(), "Volume Fraction for a", {0, 0.5, 1, 0, 0, 0, 0, 0});
  add_values(*grid->GetCellData(), "Volume Fraction for b", {1, 0.5, 0, 1, 1, 1, 1, 1});
  const Scratch scratch;
  write<vtkXMLUnstructuredGridWriter>(scratch / "a.vtu", grid.Get());
  write<vtkDataSetWriter>(scratch / "a.vtk", grid.Get());
  std::mt19937 random(5);
  for (const char* name : {"a.vtu", "a.vtk"}) {
    const std::string whole = bytes_of(scratch / name);
    for (int n = 0; n < 40; ++n) {
      std::string damaged = whole;
      const std::size_t at = random() % whole.size();
      if (n % 2 == 0) {
        damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random() % 8)));
      } else {
        damaged.resize(at);
      }
      put_bytes(scratch / name, damaged);
      try {
        read_mesh_data(scratch / name).check();
      } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_TRUE(says(message, name)) << message;
      }
    }
  }
}

TEST(RealData, ExodusBlocksAreMaterials) {
  const auto path = test::shared_data("material/exodus_seacas/8-block.g");
  if (!std::filesystem::exists(path)) GTEST_SKIP();
  const MeshData data = read_mesh_data(path);
  ASSERT_EQ(data.materials.size(), 8u);
  EXPECT_EQ(data.mesh.cell_count(), 64u);
  for (const double volume : data.volumes()) EXPECT_NEAR(volume, 0.125, 1e-3);
}

}  // namespace
}  // namespace adamas
