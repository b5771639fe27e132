#include "adamas/probe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "adamas/files.h"
#include "adamas/generate.h"
#include "adamas/mesh_files.h"
#include "tests/support/scratch.h"

namespace adamas {
namespace {

/// Collects the notes of a call.
class Notes : public Progress {
 public:
  void report(std::string_view, double) override {}
  void note(NoteKind, std::string_view text) override { texts.emplace_back(text); }
  std::vector<std::string> texts;
};

TEST(Probing, ReadsPointsFromTables) {
  const test::Scratch scratch;
  std::ofstream(scratch / "p.csv") << "x,y,z,note\n# ends\n0.5,1,2,left\n\n1e-1,+2,-3,right\n";
  const std::vector<Vec3> points = read_points(scratch / "p.csv");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].x, 0.5);
  EXPECT_EQ(points[1].y, 2);
  EXPECT_EQ(points[1].z, -3);
  std::ofstream(scratch / "q.csv") << "0,5;1;2\n";
  EXPECT_THROW(read_points(scratch / "q.csv"), Error);
}

TEST(Probing, TablesHaveAColumnPerComponentAndEmptyCells) {
  PointSamples samples{{"iron, cast"}, {{"v", "m/s", 2}, {"p", "", 1}}, {}};
  samples.points.push_back({{0, 1, 2}, 0, {1, 2, std::nan("")}, 0.25});
  samples.points.push_back(
      {{9, 9, 9}, PointSample::kNoMaterial, {std::nan(""), std::nan(""), std::nan("")}, std::nan("")});
  EXPECT_EQ(to_csv(samples),
            "x,y,z,material,interface distance,v:0 [m/s],v:1 [m/s],p\n"
            "0,1,2,\"iron, cast\",0.25,1,2,\n9,9,9,,,,,\n");
}

TEST(Probing, IntegratesOverInputsOnce) {
  const GeneratedScene scene = generate_scene("voronoi10", {8, 8, 8});
  const GridData data = scene.data.view();
  const Input input(data);
  const Box3& box = input.domain();
  const std::vector<Vec3> points = line_points(box.min, box.max + Vec3{1, 0, 0}, 5);
  Notes notes;
  const InputProbe probed = probe_and_integrate(input, points, {}, notes);
  EXPECT_FALSE(probed.interfaces);
  ASSERT_EQ(notes.texts.size(), 1u);
  EXPECT_NE(notes.texts[0].find("of 5 points"), std::string::npos);
  EXPECT_EQ(to_csv(probed.samples), to_csv(probe(input, points)));
  const std::vector<double> volumes = material_volumes(data);
  ASSERT_EQ(probed.totals.size(), volumes.size());
  for (std::size_t m = 0; m < volumes.size(); ++m)
    EXPECT_NEAR(probed.totals[m].volume, volumes[m], 1e-9 * box.volume());
}

TEST(Probing, FindsTheSameInAMeshReadFromItsFile) {
  const test::Scratch scratch;
  const GeneratedScene scene = generate_scene("voronoi10", {8, 8, 8});
  const AdaptiveMesh mesh = resample(scene.data.view());
  write_mesh(scratch / "m.vtu", mesh.view());
  const AdaptiveMesh read = read_adaptive_mesh(scratch / "m.vtu");
  const std::vector<Vec3> points = line_points({0.1, 0.2, 0.3}, {0.9, 0.8, 0.7}, 20);
  EXPECT_EQ(to_csv(probe(read, points)), to_csv(probe(mesh, points)));
  EXPECT_EQ(read.report().tetrahedra, mesh.report().tetrahedra);
  std::ofstream(scratch / "no.vtu") << "<VTKFile/>";
  EXPECT_THROW(read_adaptive_mesh(scratch / "no.vtu"), Error);
}

}  // namespace
}  // namespace adamas
