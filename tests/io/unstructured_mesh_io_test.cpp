#include "core/io/unstructured_mesh_io.h"

#include <bit>
#include <cstring>
#include <limits>

#include "adamas/file_summary.h"
#include "sample_data.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::says;

UnstructuredMesh sample_mesh(CellKind kind) {
  UnstructuredMesh mesh;
  mesh.kind = kind;
  mesh.points = {{0, 0, 0}, {1, 1.0 / 3, 0}, {0, 1e-300, -0.0}, {0, 0, 1e17}, {2, 3, 4}};
  mesh.connectivity = {0, 1, 2, 3, 1, 2, 3, 4};
  mesh.offsets = {0, 4, 8};
  if (kind != CellKind::kTetrahedra) mesh.offsets = {0, 3, 8};
  if (kind == CellKind::kLines) mesh.offsets = {0, 2, 8};
  const double nan = std::bit_cast<double>(0x7ff8000000001234ull);
  mesh.point_arrays = {
      {"p<&>\"", 1, std::vector<double>{1, nan, -0.0, std::numeric_limits<double>::infinity(), 5e-324}},
      {"v", 3, std::vector<float>(15, 0.1f)}};
  mesh.cell_arrays = {{"i", 2, std::vector<std::int32_t>{-2147483647 - 1, 2147483647, 0, -1}},
                      {"b", 1, std::vector<std::uint8_t>{0, 255}}};
  mesh.field_arrays = {
      {"names", 1, std::vector<std::string>{"Armor Plate", "", "a, b <&> \"c\"", "\xc3\xa4 = \xe2\x82\xac"}},
      {"total", 1, std::vector<double>{1.0 / 3}},
      {"none", 1, std::vector<double>{}}};
  return mesh;
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  if constexpr (std::is_same_v<T, std::string>) {
    return a == b;
  } else {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
  }
}

void expect_same(const std::vector<NamedArray>& a, const std::vector<NamedArray>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].name, b[i].name);
    EXPECT_EQ(a[i].components, b[i].components) << a[i].name;
    ASSERT_EQ(a[i].values.index(), b[i].values.index()) << a[i].name;
    std::visit(
        [&](const auto& values) {
          EXPECT_TRUE(same_bits(values, std::get<std::decay_t<decltype(values)>>(b[i].values))) << a[i].name;
        },
        a[i].values);
  }
}

void expect_same(const UnstructuredMesh& a, const UnstructuredMesh& b) {
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_TRUE(same_bits(a.points, b.points));
  EXPECT_EQ(a.connectivity, b.connectivity);
  EXPECT_EQ(a.offsets, b.offsets);
  expect_same(a.point_arrays, b.point_arrays);
  expect_same(a.cell_arrays, b.cell_arrays);
  expect_same(a.field_arrays, b.field_arrays);
}

TEST(UnstructuredMeshIo, AllKindsComeBackBitForBit) {
  const test::Scratch scratch;
  for (const CellKind kind : {CellKind::kTetrahedra, CellKind::kPolygons, CellKind::kLines}) {
    for (const char* name : {"a.vtu", "a.vtp"}) {
      if (kind == CellKind::kTetrahedra && name == std::string("a.vtp")) continue;
      const UnstructuredMesh mesh = sample_mesh(kind);
      write_unstructured_mesh(scratch / name, mesh);
      expect_same(read_unstructured_mesh(scratch / name), mesh);
    }
  }
}

TEST(UnstructuredMeshIo, EmptyMeshComesBack) {
  const test::Scratch scratch;
  UnstructuredMesh mesh;
  write_unstructured_mesh(scratch / "a.vtu", mesh);
  expect_same(read_unstructured_mesh(scratch / "a.vtu"), mesh);
}

TEST(UnstructuredMeshIo, SameMeshGivesSameBytes) {
  const test::Scratch scratch;
  for (const char* name : {"a.vtu", "b.vtu"})
    write_unstructured_mesh(scratch / name, sample_mesh(CellKind::kTetrahedra));
  EXPECT_EQ(test::bytes_of(scratch / "a.vtu"), test::bytes_of(scratch / "b.vtu"));
}

TEST(UnstructuredMeshIo, WrongMeshesAreNotWritten) {
  const test::Scratch scratch;
  UnstructuredMesh mesh = sample_mesh(CellKind::kTetrahedra);
  EXPECT_TRUE(says(error_of([&] { write_unstructured_mesh(scratch / "a.vtp", mesh); }), "expected .vtu"));
  EXPECT_TRUE(says(error_of([&] { write_unstructured_mesh(scratch / "a.obj", mesh); }), "found '.obj'"));
  mesh.cell_arrays[1].values = std::vector<std::uint8_t>{1, 2, 3};
  EXPECT_TRUE(says(error_of([&] { write_unstructured_mesh(scratch / "a.vtu", mesh); }), "array 'b'"));
  mesh = sample_mesh(CellKind::kTetrahedra);
  mesh.connectivity[3] = 5;
  EXPECT_TRUE(
      says(error_of([&] { write_unstructured_mesh(scratch / "a.vtu", mesh); }), "points of the mesh"));
  EXPECT_TRUE(says(error_of([&] { write_unstructured_mesh(scratch / "no" / "a.vtu", mesh); }), "a.vtu"));
  EXPECT_EQ(scratch.entries(), 0);
}

TEST(UnstructuredMeshIo, SummaryCountsAndRanges) {
  const test::Scratch scratch;
  write_unstructured_mesh(scratch / "a.vtu", sample_mesh(CellKind::kTetrahedra));
  const FileSummary summary = summarize_file(scratch / "a.vtu");
  EXPECT_EQ(summary.kind, "tetrahedra");
  EXPECT_EQ(summary.points, 5u);
  EXPECT_EQ(summary.cells, 2u);
  EXPECT_EQ(summary.box.max, (Vec3{2, 3, 1e17}));
  ASSERT_EQ(summary.arrays.size(), 7u);
  EXPECT_EQ(summary.arrays[0].min, 0) << "infinity and NaN do not count";
  EXPECT_EQ(summary.arrays[0].max, 1);
  EXPECT_EQ(summary.arrays[2].max, 2147483647);
  EXPECT_EQ(summary.arrays[4].type, "string");
}

}  // namespace
}  // namespace adamas
