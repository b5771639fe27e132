#include "adamas/summary.h"

#include <gtest/gtest.h>

#include <fstream>

#include "adamas/files.h"
#include "adamas/generate.h"
#include "adamas/mesh_files.h"
#include "adamas/reconstruct.h"
#include "adamas/resample.h"
#include "tests/support/scratch.h"

namespace adamas {
namespace {

using test::Scratch;

TEST(Summaries, SayWhatAMeshHolds) {
  const Scratch scratch;
  const GeneratedScene scene = generate_scene("voronoi10", {8, 8, 8});
  const GridData data = scene.data.view();
  const AdaptiveMesh mesh = resample(data);
  write_mesh(scratch / "m.vtu", mesh.view());
  const FileSummary file = summarize_file(scratch / "m.vtu");
  EXPECT_EQ(file.kind, "tetrahedra");
  EXPECT_EQ(file.cells, mesh.tetrahedra().size());
  EXPECT_EQ(file.points, mesh.points().size());
  const auto summary = summarize_mesh(scratch / "m.vtu");
  ASSERT_TRUE(summary);
  std::size_t tetrahedra = 0;
  for (const auto& [level, count] : summary->levels) tetrahedra += count;
  EXPECT_EQ(tetrahedra, mesh.tetrahedra().size());
  ASSERT_EQ(summary->materials.size(), data.materials.size());
  double whole = 0;
  for (const MaterialVolume& material : summary->materials) whole += material.volume;
  EXPECT_NEAR(whole, data.grid.domain().volume(), 1e-9);
  EXPECT_THROW(check_readable(scratch / "none.vtu"), Error);
}

TEST(Summaries, SayWhatInterfacesAndGridsHold) {
  const Scratch scratch;
  const GeneratedScene scene = generate_scene("voronoi10", {8, 8, 8});
  const ReconstructedInterfaces interfaces = reconstruct(scene.data.view());
  write_mesh(scratch / "i.vtp", interfaces.mesh);
  InputOptions options;
  options.path = scratch / "i.vtp";
  const NetworkSummary network = summarize_interfaces(options);
  EXPECT_EQ(network.unsound, "");
  EXPECT_EQ(network.interfaces.size(), interfaces.interfaces.size());
  std::size_t triangles = 0;
  for (const InterfaceArea& area : network.interfaces) triangles += area.triangles;
  EXPECT_EQ(triangles, interfaces.mesh.triangles.size());

  std::ofstream(scratch / "a.nrrd")
      << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n"
         "0 0 0 0 1 1 1 1\n";
  InputOptions labels;
  labels.path = labels.data.labels = (scratch / "a.nrrd").string();
  const MaterialDataSummary grid = summarize_materials(labels);
  ASSERT_EQ(grid.materials.size(), 2u);
  EXPECT_EQ(grid.materials[0].volume, grid.materials[1].volume);
  EXPECT_FALSE(grid.fraction_sums);
}

}  // namespace
}  // namespace adamas
