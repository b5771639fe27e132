#include "adamas/files.h"

#include <gtest/gtest.h>

#include "adamas/generate.h"
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
