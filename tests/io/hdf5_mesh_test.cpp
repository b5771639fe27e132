// Tests meshes in HDF5: those of Truchas, and the blocks of FLASH.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "adamas/files.h"
#include "adamas/series.h"
#include "core/base/error.h"
#include "core/io/input_formats.h"
#include "core/io/mesh_data_reader.h"
#include "core/io/mesh_file.h"
#include "core/io/unstructured_mesh_io.h"
#include "tests/support/hdf5_file.h"
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

/// Writes a cube of hexahedra of two materials at two times, as Truchas does. Returns the hexahedra.
test::Hexahedra write_truchas(const std::filesystem::path& path) {
  const test::Hexahedra cube =
      test::make_hexahedra({2, 2, 2}, [](const Vec3& p) { return test::jittered(p, 0.1); });
  test::Hdf5File file(path);
  std::vector<double> points;
  for (const Vec3& p : cube.points) points.insert(points.end(), {p.x, p.y, p.z});
  std::vector<std::int32_t> cells, blocks;
  for (const auto& cell : cube.cells) {
    for (const auto p : cell) cells.push_back(static_cast<std::int32_t>(p) + 1);
    blocks.push_back(blocks.size() < 4 ? 10 : 20);
  }
  file.add("Meshes/DEFAULT/Nodal Coordinates", {cube.points.size(), 3}, StoredType::kFloat64, points.data());
  file.add("Meshes/DEFAULT/Element Connectivity", {8, 8}, StoredType::kInt32, cells.data());
  file.add("Simulations/MAIN/Non-series Data/BLOCKID", {8}, StoredType::kInt32, blocks.data());
  for (const int step : {1, 2}) {
    const std::string group = fmt::format("Simulations/MAIN/Series Data/Series {}", step);
    std::vector<double> fractions, heat;
    for (int c = 0; c < 8; ++c) {
      const double solid = c < 2 * step ? 1 : c == 2 * step ? 0.5 : 0;
      fractions.insert(fractions.end(), {solid, 1 - solid});
      heat.push_back(100 * step + c);
    }
    file.add(group + "/VOF", {8, 2}, StoredType::kFloat64, fractions.data());
    file.add_text(group + "/VOF", "FIELDTYPE", "CELL");
    file.add_text(group + "/VOF", "FIELDNAME1", "solid     ");
    file.add_text(group + "/VOF", "FIELDNAME2", "melt      ");
    file.add(group + "/Z_TEMP", {8}, StoredType::kFloat64, heat.data());
    file.add_text(group + "/Z_TEMP", "FIELDNAME", "T");
    file.add_numbers(group, "time", {0.25 * step});
  }
  return cube;
}

TEST(Hdf5Mesh, MeshesOfTruchasHaveTheirMaterialsAndTimes) {
  const Scratch scratch;
  const PolyhedralMesh cube = test::to_mesh(write_truchas(scratch / "cast.h5"));
  EXPECT_EQ(mesh_times(scratch / "cast.h5"), (std::vector<double>{0.25, 0.5}));
  for (const std::uint64_t time : {0u, 1u}) {
    MaterialDataOptions options;
    options.time = time;
    const MeshData data = read_mesh_data(scratch / "cast.h5", options);
    ASSERT_EQ(data.materials.size(), 2u);
    EXPECT_EQ(data.materials[MaterialId(0)], "solid");
    EXPECT_EQ(data.materials[MaterialId(1)], "melt");
    double solid = 0;
    for (std::size_t c = 0; c < 8; ++c)
      solid += cube.cell_volume(c) * (c < 2 * (time + 1) ? 1 : c == 2 * (time + 1) ? 0.5 : 0);
    EXPECT_NEAR(data.volumes()[MaterialId(0)], solid, 1e-9);
    ASSERT_EQ(data.fields.size(), 1u);
    EXPECT_EQ(data.fields[0].name, "T");
    EXPECT_EQ(data.fields[0].values[3], static_cast<double>(100 * (time + 1) + 3));
  }
  std::vector<std::string> notes;
  MaterialDataOptions last;
  last.note = [&](const std::string& text) { notes.push_back(text); };
  read_mesh_data(scratch / "cast.h5", last);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(says(notes[0], "of 2 times the last one is read, 0.5"));
  last.time = 2;
  EXPECT_TRUE(
      says(error_of([&] { read_mesh_data(scratch / "cast.h5", last); }), "a time from 0 to 1, found 2"));
}

TEST(Hdf5Mesh, TetrahedraOfTruchasAreHexahedraWithEqualPoints) {
  const Scratch scratch;
  {
    test::Hdf5File file(scratch / "tet.h5");
    const std::vector<double> points{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::vector<std::int32_t> cells{1, 1, 2, 3, 4, 4, 4, 4};
    file.add("Meshes/DEFAULT/Nodal Coordinates", {4, 3}, StoredType::kFloat64, points.data());
    file.add("Meshes/DEFAULT/Element Connectivity", {1, 8}, StoredType::kInt32, cells.data());
  }
  const MeshFile file = read_mesh_file(scratch / "tet.h5");
  EXPECT_EQ(file.face_ends.size(), 4u);
  const PolyhedralMesh mesh =
      PolyhedralMesh::make("tet", file.points, file.face_points, file.face_ends, file.cell_ends);
  EXPECT_NEAR(mesh.cell_volume(0), 1.0 / 6, 1e-12);
}

/// Writes a block of 4 x 4 x 4 cells that is refined into eight and a coarse one beside it, as FLASH does.
void write_flash(const std::filesystem::path& path) {
  std::vector<std::int32_t> levels{1, 1}, types{2, 1};
  std::vector<double> boxes{0, 1, 0, 1, 0, 1, 1, 2, 0, 1, 0, 1};
  for (int child = 0; child < 8; ++child) {
    levels.push_back(2);
    types.push_back(1);
    for (int axis = 0; axis < 3; ++axis) {
      const double low = ((child >> axis) & 1) * 0.5;
      boxes.insert(boxes.end(), {low, low + 0.5});
    }
  }
  std::vector<double> values;
  for (std::size_t b = 0; b < levels.size(); ++b) {
    for (int c = 0; c < 64; ++c) {
      const double low = boxes[6 * b], size = (boxes[6 * b + 1] - low) / 4;
      values.push_back(low + size * (c % 4 + 0.5));
    }
  }
  test::Hdf5File file(path);
  file.add("refine level", {10}, StoredType::kInt32, levels.data());
  file.add("node type", {10}, StoredType::kInt32, types.data());
  file.add("bounding box", {10, 3, 2}, StoredType::kFloat64, boxes.data());
  file.add("dens", {10, 4, 4, 4}, StoredType::kFloat64, values.data());
}

TEST(Hdf5Mesh, BlocksOfFlashAreCellsWithoutCracks) {
  const Scratch scratch;
  write_flash(scratch / "run_hdf5_chk_0001");
  EXPECT_EQ(kind_by_format(scratch / "run_hdf5_chk_0001"), InputKind::kCells);
  const MeshFile file = read_mesh_file(scratch / "run_hdf5_chk_0001");
  EXPECT_EQ(file.kind, "FLASH HDF5");
  EXPECT_EQ(file.cell_ends.size(), 64u * 9);
  const PolyhedralMesh mesh =
      PolyhedralMesh::make("flash", file.points, file.face_points, file.face_ends, file.cell_ends);
  EXPECT_TRUE(mesh.fills_box());
  double volume = 0;
  ASSERT_EQ(file.arrays.size(), 1u);
  EXPECT_EQ(file.arrays[0].name, "dens");
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    volume += mesh.cell_volume(c);
    Box3 box;
    for (const auto p : mesh.points_of_cell(c)) box.extend(mesh.points()[p]);
    const double value =
        std::visit([c](const auto& values) { return static_cast<double>(values[c]); }, file.arrays[0].values);
    EXPECT_NEAR(value, box.center().x, 1e-12);
  }
  EXPECT_NEAR(volume, 2, 1e-12);
}

/// Writes two levels as VTKHDF has them: 4 x 4 x 4 cells, and in two blocks cells of half their size over
/// four of them.
void write_vtkhdf_amr(const std::filesystem::path& path) {
  test::Hdf5File file(path);
  const std::vector<std::vector<std::int64_t>> boxes{{0, 3, 0, 3, 0, 3},
                                                     {0, 3, 0, 1, 0, 1, 0, 3, 2, 3, 0, 1}};
  for (const int level : {0, 1}) {
    const std::string group = fmt::format("VTKHDF/Level{}", level);
    const double step = level == 0 ? 0.25 : 0.125;
    const auto& own = boxes[static_cast<std::size_t>(level)];
    std::vector<float> of_cells, of_points;
    for (std::size_t b = 0; b < own.size(); b += 6) {
      for (const int more : {0, 1}) {
        for (std::int64_t z = own[b + 4]; z <= own[b + 5] + more; ++z) {
          for (std::int64_t y = own[b + 2]; y <= own[b + 3] + more; ++y) {
            for (std::int64_t x = own[b]; x <= own[b + 1] + more; ++x)
              (more == 0 ? of_cells : of_points)
                  .push_back(
                      static_cast<float>(10 + step * (static_cast<double>(x) + (more == 0 ? 0.5 : 0))));
          }
        }
      }
    }
    file.add(group + "/AMRBox", {own.size() / 6, 6}, StoredType::kInt64, own.data());
    file.add(group + "/CellData/x", {of_cells.size()}, StoredType::kFloat32, of_cells.data());
    file.add(group + "/PointData/px", {of_points.size()}, StoredType::kFloat32, of_points.data());
    file.add_numbers(group, "Spacing", {step, step, step});
  }
  file.add_text("VTKHDF", "Type", "OverlappingAMR");
  file.add_text("VTKHDF", "GridDescription", "XYZ");
  file.add_numbers("VTKHDF", "Origin", {10, 0, -1});
}

TEST(VtkHdf, OverlappingLevelsAreCellsWithoutCracks) {
  const Scratch scratch;
  write_vtkhdf_amr(scratch / "amr.vtkhdf");
  const MeshFile file = read_mesh_file(scratch / "amr.vtkhdf");
  EXPECT_EQ(file.kind, "VTKHDF AMR");
  EXPECT_EQ(file.cell_ends.size(), 64u - 4 + 32);
  const PolyhedralMesh mesh =
      PolyhedralMesh::make("amr", file.points, file.face_points, file.face_ends, file.cell_ends);
  EXPECT_TRUE(mesh.fills_box());
  ASSERT_EQ(file.arrays.size(), 2u);
  const auto value = [&](std::size_t array, std::size_t i) {
    return std::visit([i](const auto& values) { return static_cast<double>(values[i]); },
                      file.arrays[array].values);
  };
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    Box3 box;
    for (const auto p : mesh.points_of_cell(c)) box.extend(mesh.points()[p]);
    EXPECT_NEAR(value(0, c), box.center().x, 1e-6);
  }
  for (std::size_t p = 0; p < file.points.size(); ++p) EXPECT_NEAR(value(1, p), file.points[p].x, 1e-6);
}

TEST(VtkHdf, ImagesAreGrids) {
  const Scratch scratch;
  {
    test::Hdf5File file(scratch / "image.vtkhdf");
    std::vector<std::int32_t> values;
    for (int i = 0; i < 24; ++i) values.push_back(i);
    file.add("VTKHDF/PointData/a", {2, 3, 4}, StoredType::kInt32, values.data());
    file.add_text("VTKHDF", "Type", "ImageData");
    for (const auto& [name, numbers] :
         std::vector<std::pair<const char*, std::vector<double>>>{{"WholeExtent", {0, 3, 0, 2, 0, 1}},
                                                                  {"Origin", {1, 2, 3}},
                                                                  {"Spacing", {0.5, 1, 2}},
                                                                  {"Direction", {1, 0, 0, 0, 1, 0, 0, 0, 1}},
                                                                  {"Version", {1, 0}}})
      file.add_numbers("VTKHDF", name, numbers);
  }
  const Volume volume = read_volume(scratch / "image.vtkhdf");
  EXPECT_EQ(volume.grid.dimensions, (std::array<std::uint64_t, 3>{4, 3, 2}));
  EXPECT_EQ(volume.grid.spacing, (Vec3{0.5, 1, 2}));
  EXPECT_EQ(volume.grid.origin, (Vec3{1, 2, 3}));
}

TEST(VtkHdf, MeshesThatAreWrittenAreReadByVtk) {
  const Scratch scratch;
  UnstructuredMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.connectivity = {0, 1, 2, 3, 1, 2, 3, 4};
  mesh.offsets = {0, 4, 8};
  mesh.point_arrays.push_back({"speed [m/s]", 1, std::vector<double>{1, 2, 3, 4, 5.5}});
  mesh.cell_arrays.push_back({"material", 1, std::vector<std::int32_t>{7, -1}});
  mesh.cell_arrays.push_back({"way", 3, std::vector<float>{1, 2, 3, 4, 5, 6}});
  mesh.field_arrays.push_back({"material_names", 1, std::vector<std::string>{"water", "air"}});
  write_unstructured_mesh(scratch / "mesh.vtkhdf", mesh);
  const MeshFile file = read_mesh_file(scratch / "mesh.vtkhdf");
  EXPECT_EQ(file.points, mesh.points);
  EXPECT_EQ(file.cell_ends.size(), 2u);
  ASSERT_EQ(file.arrays.size(), 3u);
  for (const GridArray& array : file.arrays) {
    EXPECT_EQ(array.components, array.name == "way" ? 3 : 1);
    EXPECT_EQ(array.centering == Centering::kPoints, array.name == "speed [m per s]");
    if (array.name != "material") continue;
    EXPECT_EQ(std::get<std::vector<std::int32_t>>(array.values), (std::vector<std::int32_t>{7, -1}));
  }
  const std::string first = bytes_of(scratch / "mesh.vtkhdf");
  write_unstructured_mesh(scratch / "again.vtkhdf", mesh);
  EXPECT_EQ(bytes_of(scratch / "again.vtkhdf"), first);
}

TEST(Hdf5Mesh, DamagedFilesAreAnsweredInOneLine) {
  const Scratch scratch;
  write_truchas(scratch / "cast.h5");
  write_flash(scratch / "flash.h5");
  write_vtkhdf_amr(scratch / "amr.vtkhdf");
  std::mt19937 random(11);
  for (const char* name : {"cast.h5", "flash.h5", "amr.vtkhdf"}) {
    const std::string whole = bytes_of(scratch / name);
    for (int n = 0; n < 24; ++n) {
      std::string damaged = whole;
      const std::size_t at = random() % whole.size();
      if (n % 2 == 0) {
        damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random() % 8)));
      } else {
        damaged.resize(at);
      }
      put_bytes(scratch / name, damaged);
      try {
        read_mesh_file(scratch / name);
      } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_TRUE(says(message, name)) << message;
      }
    }
  }
}

TEST(RealData, TruchasFractionsAddUpToTheirMesh) {
  for (const char* name : {"broken-dam.h5", "ds11.h5", "ustruc-ldrd.h5"}) {
    const auto path = test::shared_data(std::string("material/truchas/") + name);
    if (!std::filesystem::exists(path)) GTEST_SKIP();
    const MeshData data = read_mesh_data(path);
    double sum = 0, mesh = 0;
    for (const double volume : data.volumes()) sum += volume;
    for (std::size_t c = 0; c < data.mesh.cell_count(); ++c) mesh += data.mesh.cell_volume(c);
    EXPECT_NEAR(sum, mesh, 1e-6 * mesh) << name;
    EXPECT_EQ(data.mesh.tangled_cells(), 0u) << name;
    EXPECT_GE(mesh_times(path).size(), 2u) << name;
  }
}

}  // namespace
}  // namespace adamas
