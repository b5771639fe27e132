#include "adamas/files.h"

#include <gtest/gtest.h>

#include "adamas/cut_mesh.h"
#include "adamas/generate.h"
#include "adamas/mesh_files.h"
#include "adamas/picture.h"
#include "adamas/reconstruct.h"
#include "adamas/slice.h"
#include "core/data/grid_data.h"
#include "core/io/multi_material_writer.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::Scratch;

TEST(Files, GridDataComeBack) {
  const Scratch scratch;
  const GeneratedScene scene = generate_scene("sphere", {7, 6, 5});
  write_multi_material_data(scratch / "a.vtr", to_multi_material_data(scene.data.view()));
  const OwnedGridData read = read_grid_data(scratch / "a.vtr");
  EXPECT_EQ(material_volumes(read.view()), material_volumes(scene.data.view()));
  EXPECT_EQ(read.view().fields.size(), scene.data.view().fields.size());
  EXPECT_NE(test::error_of([&] { read_grid_data(scratch / "b.vtr"); }).find("b.vtr"), std::string::npos);
}

TEST(Files, VolumesComeBack) {
  const Scratch scratch;
  for (const SampleType type : {SampleType::kUint8, SampleType::kUint16, SampleType::kFloat32}) {
    const Volume ball = generate_buckyball({9, 8, 7}, type);
    for (const char* name : {"a.vti", "a.nrrd", "a.mha"}) {
      write_volume(scratch / name, ball.grid, ball.samples);
      const Volume read = read_volume(scratch / name);
      EXPECT_EQ(read.samples, ball.samples) << name;
      EXPECT_EQ(read.grid.dimensions, ball.grid.dimensions);
      EXPECT_EQ(read.grid.type, type);
    }
    EXPECT_NE(test::error_of([&] { write_volume(scratch / "b.vti", ball.grid, {}); }).find("found 0"),
              std::string::npos);
  }
}

/// A sheet with normals and values; `far`: coordinates that need doubles.
TriangleSurface bent_sheet(bool far) {
  TriangleSurface surface;
  surface.value_name = "height";
  constexpr std::uint32_t kSide = 7;
  for (std::uint32_t j = 0; j < kSide; ++j) {
    for (std::uint32_t i = 0; i < kSide; ++i) {
      const double x = 0.1 * i, y = 0.3 * j, z = 0.7 * x * y;
      surface.points.push_back({x + (far ? 1e9 : 0), y, z});
      surface.normals.push_back(normalized(Vec3{-0.7 * y, -0.7 * x, 1}));
      surface.values.push_back(static_cast<float>(z));
    }
  }
  for (std::uint32_t j = 0; j + 1 < kSide; ++j) {
    for (std::uint32_t i = 0; i + 1 < kSide; ++i) {
      const std::uint32_t p = i + kSide * j;
      // The points are not in the order of their first use.
      surface.triangles.push_back({p + kSide + 1, p, p + 1});
      surface.triangles.push_back({p + kSide, p, p + kSide + 1});
    }
  }
  return surface;
}

Vec3 as_floats(const Vec3& p) {
  const auto single = [](double v) { return static_cast<double>(static_cast<float>(v)); };
  return {single(p.x), single(p.y), single(p.z)};
}

TEST(Files, SurfacesComeBack) {
  const Scratch scratch;
  for (const bool far : {false, true}) {
    const TriangleSurface surface = bent_sheet(far);
    for (const char* name : {"a.ply", "a.vtp", "a.obj"}) {
      write_mesh(scratch / name, surface);
      const TriangleSurface read = read_surface(scratch / name);
      EXPECT_EQ(read.triangles, surface.triangles) << name;
      ASSERT_EQ(read.points.size(), surface.points.size()) << name;
      for (std::size_t i = 0; i < read.points.size(); ++i) {
        if (far) {
          EXPECT_EQ(read.points[i], surface.points[i]) << name;
        } else {
          EXPECT_EQ(as_floats(read.points[i]), as_floats(surface.points[i])) << name;
        }
      }
      if (std::string(name) == "a.obj") continue;
      EXPECT_EQ(read.values, surface.values) << name;
      EXPECT_EQ(read.value_name, "height");
      ASSERT_EQ(read.normals.size(), surface.normals.size()) << name;
      for (std::size_t i = 0; i < read.normals.size(); ++i)
        EXPECT_EQ(read.normals[i], as_floats(surface.normals[i])) << name;
      write_mesh(scratch / (std::string("b") + name), read);
      EXPECT_EQ(test::bytes_of(scratch / (std::string("b") + name)), test::bytes_of(scratch / name));
    }
  }
  TriangleSurface bare = bent_sheet(false);
  bare.normals.clear(), bare.values.clear();
  write_mesh(scratch / "bare.ply", bare);
  EXPECT_TRUE(read_surface(scratch / "bare.ply").normals.empty());
  EXPECT_TRUE(read_surface(scratch / "bare.ply").values.empty());
  EXPECT_EQ(read_surface(scratch / "bare.ply").triangles, bare.triangles);
}

/// An .stl has the corners of each triangle and no points in common.
TEST(Files, TrianglesOfAnStlComeBackOnSharedPoints) {
  const Scratch scratch;
  const TriangleSurface surface = bent_sheet(false);
  write_mesh(scratch / "a.stl", surface);
  const TriangleSurface read = read_surface(scratch / "a.stl");
  EXPECT_EQ(read.points.size(), surface.points.size());
  ASSERT_EQ(read.triangles.size(), surface.triangles.size());
  for (std::size_t t = 0; t < read.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ(read.points[read.triangles[t][c]], as_floats(surface.points[surface.triangles[t][c]]));
  }
}

TEST(Files, SurfacesThatAreCutOffOrNoneAreRefused) {
  const Scratch scratch;
  write_mesh(scratch / "a.ply", bent_sheet(false));
  const std::string bytes = test::bytes_of(scratch / "a.ply");
  test::put_bytes(scratch / "short.ply", bytes.substr(0, bytes.size() - 1));
  EXPECT_NE(test::error_of([&] { read_surface(scratch / "short.ply"); }).find("short.ply"),
            std::string::npos);
  std::string wrong = bytes;
  wrong[bytes.size() - 1] = 1;
  test::put_bytes(scratch / "wrong.ply", wrong);
  EXPECT_NE(test::error_of([&] { read_surface(scratch / "wrong.ply"); }).find("wrong.ply"),
            std::string::npos);
  EXPECT_NE(test::error_of([&] { read_surface(scratch / "none.ply"); }).find("none.ply"), std::string::npos);
  test::put_bytes(scratch / "a.glb", bytes);
  EXPECT_NE(test::error_of([&] { read_surface(scratch / "a.glb"); }).find(".glb"), std::string::npos);
}

TEST(Files, CutMeshesComeBack) {
  const Scratch scratch;
  const GeneratedScene scene = generate_scene("sphere", {8, 8, 8});
  const AdaptiveMesh mesh = resample(scene.data.view(), {.interface_error = 0.1});
  const MaterialTetrahedra plain = mesh.cut_mesh();
  const CutMesh measured = cut_mesh(mesh);
  write_mesh(scratch / "plain.vtu", plain);
  write_mesh(scratch / "measured.vtu", measured);
  for (const auto& [name, cut] : {std::pair{"plain.vtu", plain}, {"measured.vtu", measured.tetrahedra()}}) {
    const MaterialTetrahedra read = read_tetrahedra(scratch / name);
    EXPECT_EQ(read.points, cut.points);
    EXPECT_EQ(read.tetrahedra, cut.tetrahedra);
    EXPECT_EQ(read.tetrahedron_materials, cut.tetrahedron_materials);
    EXPECT_EQ(read.materials, cut.materials);
  }
  write_mesh(scratch / "mesh.vtu", mesh.view());
  EXPECT_NE(test::error_of([&] { read_tetrahedra(scratch / "mesh.vtu"); }).find("mesh.vtu"),
            std::string::npos);
}

TEST(Files, MeshesOfEveryKindAreWrittenAndDrawn) {
  const Scratch scratch;
  const GeneratedScene scene = generate_scene("sphere", {10, 10, 10});
  const ReconstructedInterfaces found = reconstruct(scene.data.view());
  write_mesh(scratch / "interfaces.vtp", found.mesh);
  const InterfaceTriangles read = read_interfaces(scratch / "interfaces.vtp");
  EXPECT_EQ(read.points, found.mesh.points);
  EXPECT_EQ(read.triangles, found.mesh.triangles);
  EXPECT_EQ(read.sides, found.mesh.sides);
  EXPECT_EQ(read.materials, found.mesh.materials);

  TriangleSurface surface;
  surface.points = found.mesh.points;
  surface.triangles = found.mesh.triangles;
  write_mesh(scratch / "surface.ply", surface);

  const AdaptiveMesh mesh = resample(scene.data.view(), {.interface_error = 0.1});
  for (const char* name : {"cut.vtu", "cut.msh", "cut.exo"}) write_mesh(scratch / name, mesh.cut_mesh());
  write_picture(scratch / "surface.png", surface, {.width = 300, .height = 240});
  write_picture(scratch / "interfaces.png", found.mesh, {.width = 300, .height = 240});
  const Slice cut = slice(mesh, {{0.5, 0.5, 0.5}, {0, 0, 1}}, {.field = "smooth"});
  write_picture(scratch / "slice.svg", cut, {.width = 300, .height = 240, .cells = true});
  EXPECT_EQ(scratch.entries(), 8);

  InterfaceTriangles wrong = found.mesh;
  wrong.sides.pop_back();
  EXPECT_NE(test::error_of([&] { write_mesh(scratch / "wrong.vtp", wrong); }).find("sides"),
            std::string::npos);
  wrong.sides.push_back({7, 0});
  EXPECT_NE(test::error_of([&] { write_mesh(scratch / "wrong.vtp", wrong); }).find("found 7"),
            std::string::npos);
  EXPECT_NE(test::error_of([&] { write_picture(scratch / "wrong.png", wrong); }).find("found 7"),
            std::string::npos);
  Slice broken = cut;
  broken.values.pop_back();
  EXPECT_NE(test::error_of([&] { write_picture(scratch / "wrong.svg", broken); }).find("values"),
            std::string::npos);
  EXPECT_EQ(scratch.entries(), 8);
}

}  // namespace
}  // namespace adamas
