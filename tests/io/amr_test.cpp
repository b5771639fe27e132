#include <gtest/gtest.h>
#include <vtkAMRBox.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkOverlappingAMR.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkUniformGrid.h>
#include <vtkXMLUniformGridAMRWriter.h>

#include <cmath>
#include <map>
#include <random>
#include <set>

#include "core/data/polyhedral_mesh.h"
#include "core/io/amr_cells.h"
#include "core/io/mesh_data_reader.h"
#include "core/io/mesh_file.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::says;
using test::Scratch;

/// Cells of up to three levels in the unit cube: the coarsest has 4 along each axis, and some cells of each
/// level, chosen at random, are refined, each by a block of its own.
AmrBlocks random_blocks(unsigned seed, std::int64_t ratio, bool flat, bool covered_cells) {
  std::mt19937 random(seed);
  AmrBlocks amr;
  amr.flat = flat;
  amr.origin = {1, -2, flat ? 0.0 : 5};
  std::vector<std::array<std::int64_t, 3>> to_refine;
  const std::array<std::int64_t, 3> coarse{4, 4, flat ? 1 : 4};
  amr.spacing.push_back({0.25, 0.25, 0.25});
  amr.blocks.push_back({0, {0, 0, 0}, coarse, {}});
  std::vector<std::size_t> parents{0};
  for (std::size_t level = 1; level < 3; ++level) {
    amr.spacing.push_back((1.0 / static_cast<double>(ratio)) * amr.spacing.back());
    std::vector<std::size_t> children;
    for (const std::size_t parent : parents) {
      AmrBlock& block = amr.blocks[parent];
      const auto [begin, size] = std::pair(block.begin, block.size);
      std::vector<bool> left_out(static_cast<std::size_t>(size[0] * size[1] * size[2]), false);
      std::vector<AmrBlock> made;
      for (std::int64_t c = 0; c < size[0] * size[1] * size[2]; ++c) {
        if (random() % 4 != 0) continue;
        left_out[static_cast<std::size_t>(c)] = true;
        const std::array<std::int64_t, 3> at{begin[0] + c % size[0], begin[1] + c / size[0] % size[1],
                                             begin[2] + c / size[0] / size[1]};
        made.push_back({level,
                        {at[0] * ratio, at[1] * ratio, flat ? 0 : at[2] * ratio},
                        {ratio, ratio, flat ? 1 : ratio},
                        {}});
      }
      if (!covered_cells) block.left_out = left_out;
      for (AmrBlock& child : made) {
        children.push_back(amr.blocks.size());
        amr.blocks.push_back(std::move(child));
      }
    }
    parents = children;
  }
  return amr;
}

/// A cell's middle, by the definition of blocks.
Vec3 middle_of(const AmrBlocks& amr, const AmrBlock& block, std::int64_t cell) {
  const std::array<std::int64_t, 3> at{cell % block.size[0], cell / block.size[0] % block.size[1],
                                       cell / block.size[0] / block.size[1]};
  Vec3 p = amr.origin;
  for (int axis = 0; axis < (amr.flat ? 2 : 3); ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    p[axis] += (static_cast<double>(block.begin[a] + at[a]) + 0.5) * amr.spacing[block.level][axis];
  }
  return p;
}

using Place = std::array<std::int64_t, 3>;

/// Expects that no point of the mesh lies inside an edge of a face. Edges run along axes, and points lie at
/// multiples of `step`.
void expect_no_hanging_point(const MeshFile& file, double step) {
  const auto place = [step](const Vec3& p) {
    return Place{std::llround(p.x / step), std::llround(p.y / step), std::llround(p.z / step)};
  };
  std::set<Place> places;
  for (const Vec3& p : file.points) places.insert(place(p));
  std::size_t begin = 0;
  for (const std::uint32_t end : file.face_ends) {
    for (std::size_t i = begin; i < end; ++i) {
      const Place a = place(file.points[file.face_points[i]]),
                  b = place(file.points[file.face_points[i + 1 < end ? i + 1 : begin]]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        Place at = a;
        for (at[axis] = std::min(a[axis], b[axis]) + 1; at[axis] < std::max(a[axis], b[axis]); ++at[axis])
          ASSERT_FALSE(places.contains(at));
      }
    }
    begin = end;
  }
}

class Amr : public testing::TestWithParam<std::tuple<unsigned, int, bool>> {};

TEST_P(Amr, NeighboursShareTheirFacesAcrossLevels) {
  const auto [seed, ratio, covered] = GetParam();
  const AmrBlocks amr = random_blocks(seed, ratio, false, covered);
  MeshFile file;
  const AmrSources sources = add_amr_cells("amr", amr, file);
  const PolyhedralMesh mesh =
      PolyhedralMesh::make("amr", file.points, file.face_points, file.face_ends, file.cell_ends);
  std::size_t cell = 0;
  double sum = 0;
  for (std::size_t b = 0; b < amr.blocks.size(); ++b) {
    const double size = amr.spacing[amr.blocks[b].level].x, volume = size * size * size;
    for (const std::int64_t of_block : sources.cells[b]) {
      EXPECT_NEAR(mesh.cell_volume(cell), volume, 1e-12);
      Box3 box;
      for (const auto p : mesh.points_of_cell(cell)) box.extend(mesh.points()[p]);
      EXPECT_LE(distance(box.center(), middle_of(amr, amr.blocks[b], of_block)), 1e-12);
      sum += mesh.cell_volume(cell++);
    }
  }
  EXPECT_EQ(cell, mesh.cell_count());
  EXPECT_NEAR(sum, 1, 1e-12);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.cells_of_face(f)[1] != PolyhedralMesh::kNone) continue;
    const Vec3 at = mesh.face_center(f) - amr.origin;
    const double edge = std::min({at.x, at.y, at.z, 1 - at.x, 1 - at.y, 1 - at.z});
    EXPECT_NEAR(edge, 0, 1e-12) << "a face inside the cube has one cell";
  }
  expect_no_hanging_point(file, amr.spacing.back().x);
}

INSTANTIATE_TEST_SUITE_P(Hierarchies, Amr,
                         testing::Combine(testing::Values(1u, 2u), testing::Values(2, 3), testing::Bool()));

TEST(AmrCells, FlatCellsAreRectangles) {
  const AmrBlocks amr = random_blocks(5, 2, true, true);
  MeshFile file;
  const AmrSources sources = add_amr_cells("amr", amr, file);
  ASSERT_TRUE(file.flat);
  std::size_t cells = 0;
  double area = 0;
  for (std::size_t b = 0; b < amr.blocks.size(); ++b) {
    cells += sources.cells[b].size();
    area += static_cast<double>(sources.cells[b].size()) * std::pow(amr.spacing[amr.blocks[b].level].x, 2);
  }
  EXPECT_EQ(file.cell_ends.size(), cells);
  EXPECT_NEAR(area, 1, 1e-12);
  expect_no_hanging_point(file, amr.spacing.back().x);
  extrude("amr", file, 0.5);
  const PolyhedralMesh mesh =
      PolyhedralMesh::make("amr", file.points, file.face_points, file.face_ends, file.cell_ends);
  double volume = 0;
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) volume += mesh.cell_volume(c);
  EXPECT_NEAR(volume, 0.5, 1e-12);
}

TEST(AmrCells, LevelsThatDoNotFitAreRefused) {
  const auto refusal = [](const AmrBlocks& amr) {
    return error_of([&] {
      MeshFile file;
      add_amr_cells("amr", amr, file);
    });
  };
  AmrBlocks amr;
  amr.spacing = {{1, 1, 1}, {0.4, 0.4, 0.4}};
  amr.blocks = {{0, {0, 0, 0}, {2, 2, 2}, {}}, {1, {0, 0, 0}, {2, 2, 2}, {}}};
  EXPECT_TRUE(says(refusal(amr), "by a whole number, found 2.5"));
  amr.spacing[1] = {0.5, 0.5, 0.5};
  EXPECT_NO_THROW({
    MeshFile file;
    add_amr_cells("amr", amr, file);
  });
  amr.blocks[1].size = {2, 2, 1};
  EXPECT_TRUE(says(refusal(amr), "cover whole or not at all"));
  amr.blocks[1].size = {2, 2, std::int64_t{1} << 40};
  EXPECT_TRUE(says(refusal(amr), "of the smallest cells along an axis"));
}

/// A coarse block of 8 cells along each axis and a finer one in its middle, with the x coordinates of cells
/// and points as arrays.
vtkSmartPointer<vtkOverlappingAMR> two_levels() {
  const auto amr = vtkSmartPointer<vtkOverlappingAMR>::New();
  const std::array<int, 2> blocks{1, 1};
  amr->Initialize(2, blocks.data());
  const std::array<double, 3> origin{-1, 0, 2};
  amr->SetOrigin(origin.data());
  amr->SetGridDescription(VTK_XYZ_GRID);
  for (unsigned level = 0; level < 2; ++level) {
    const std::array<double, 3> spacing{0.5 / (level + 1), 0.25 / (level + 1), 0.5 / (level + 1)};
    amr->SetSpacing(level, spacing.data());
    const int low = level == 0 ? 0 : 4, high = level == 0 ? 7 : 11;
    const std::array<int, 3> lows{low, low, low}, highs{high, high, high};
    amr->SetAMRBox(level, 0, vtkAMRBox(lows.data(), highs.data()));
    amr->SetRefinementRatio(level, 2);
    const auto grid = vtkSmartPointer<vtkUniformGrid>::New();
    grid->SetOrigin(origin[0] + low * spacing[0], origin[1] + low * spacing[1], origin[2] + low * spacing[2]);
    grid->SetSpacing(spacing.data());
    grid->SetDimensions(9, 9, 9);
    const auto of_cells = vtkSmartPointer<vtkDoubleArray>::New(),
               of_points = vtkSmartPointer<vtkDoubleArray>::New();
    of_cells->SetName("x of cells");
    of_points->SetName("x of points");
    for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
      of_cells->InsertNextValue(grid->GetOrigin()[0] + (static_cast<double>(c % 8) + 0.5) * spacing[0]);
    for (vtkIdType p = 0; p < grid->GetNumberOfPoints(); ++p)
      of_points->InsertNextValue(grid->GetPoint(p)[0]);
    grid->GetCellData()->AddArray(of_cells);
    grid->GetPointData()->AddArray(of_points);
    amr->SetDataSet(level, 0, grid);
  }
  return amr;
}

double value_of(const GridArray& array, std::size_t i) {
  return std::visit([i](const auto& values) { return static_cast<double>(values[i]); }, array.values);
}

TEST(AmrFile, CellsComeBackWithTheirValues) {
  const Scratch folder;
  const auto writer = vtkSmartPointer<vtkXMLUniformGridAMRWriter>::New();
  writer->SetFileName((folder / "two.vth").c_str());
  writer->SetInputData(two_levels());
  ASSERT_EQ(writer->Write(), 1);
  MeshFile file = read_mesh_file(folder / "two.vth");
  EXPECT_EQ(file.kind, "VTK XML AMR");
  EXPECT_EQ(file.remark, "");
  EXPECT_EQ(file.cell_ends.size(), 512 - 64 + 512u);
  ASSERT_EQ(file.arrays.size(), 2u);
  const PolyhedralMesh mesh =
      PolyhedralMesh::make("amr", file.points, file.face_points, file.face_ends, file.cell_ends);
  double volume = 0;
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    volume += mesh.cell_volume(c);
    Box3 box;
    for (const auto p : mesh.points_of_cell(c)) box.extend(mesh.points()[p]);
    EXPECT_NEAR(value_of(file.arrays[0], c), box.center().x, 1e-12);
  }
  EXPECT_NEAR(volume, 4 * 2 * 4, 1e-9);
  for (std::size_t p = 0; p < file.points.size(); ++p)
    EXPECT_NEAR(value_of(file.arrays[1], p), file.points[p].x, 1e-12);
  EXPECT_TRUE(mesh.fills_box());
}

TEST(AmrFile, DamagedFilesAreRefused) {
  const Scratch folder;
  test::put_bytes(folder / "other.vth", "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\"/>\n");
  EXPECT_TRUE(says(error_of([&] { read_mesh_file(folder / "other.vth"); }), "other.vth: "));
  test::put_bytes(
      folder / "lost.vth",
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"vtkOverlappingAMR\" version=\"1.1\" "
      "byte_order=\"LittleEndian\">\n<vtkOverlappingAMR origin=\"0 0 0\" "
      "grid_description=\"XYZ\">\n<Block level=\"0\" spacing=\"1 1 1\">\n<DataSet index=\"0\" "
      "amr_box=\"0 1 0 1 0 1\" file=\"none.vti\"/>\n</Block>\n</vtkOverlappingAMR>\n</VTKFile>\n");
  EXPECT_TRUE(says(error_of([&] { read_mesh_file(folder / "lost.vth"); }), "lost.vth: "));
}

}  // namespace
}  // namespace adamas
