#include "adamas/probe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "adamas/files.h"
#include "adamas/generate.h"
#include "adamas/mesh_files.h"
#include "tests/support/scratch.h"

namespace adamas {
namespace {

/// Collects the notes and the stages of a call.
class Notes : public Progress {
 public:
  void report(std::string_view stage, double) override { stages.emplace(stage); }
  void note(NoteKind, std::string_view text) override { texts.emplace_back(text); }
  std::vector<std::string> texts;
  std::set<std::string> stages;
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

TEST(Probing, IntegralsOfDataNeedNoInterfaces) {
  const GeneratedScene scene = generate_scene("voronoi10", {8, 8, 8});
  const Input input(scene.data.view());
  Notes none, some;
  const InputProbe alone = probe_and_integrate(input, {}, {}, none);
  const std::vector<Vec3> points{input.domain().center()};
  const InputProbe probed = probe_and_integrate(input, points, {}, some);
  EXPECT_TRUE(alone.samples.points.empty());
  EXPECT_EQ(alone.samples.materials, probed.samples.materials);
  ASSERT_EQ(alone.totals.size(), probed.totals.size());
  for (std::size_t m = 0; m < alone.totals.size(); ++m) {
    EXPECT_EQ(alone.totals[m].name, probed.totals[m].name);
    EXPECT_EQ(alone.totals[m].volume, probed.totals[m].volume);
  }
  EXPECT_FALSE(none.stages.contains("reconstructing interfaces"));
  EXPECT_TRUE(some.stages.contains("reconstructing interfaces"));
  ReconstructOptions bad;
  bad.smooth_labels = true;
  EXPECT_THROW(probe_and_integrate(input, {}, bad), Error);
  bad = {};
  bad.fractions.blur = StandardDeviation{-1.0};
  EXPECT_THROW(probe_and_integrate(input, {}, bad), Error);
}

/// A few points of labels are probed without the interfaces of all cells, with the same result.
TEST(Probing, FewPointsOfLabelsAreThoseOfMany) {
  const std::size_t n = 34;
  GridData data;
  data.grid.centering = Centering::kCells;
  for (auto& nodes : data.grid.nodes) {
    for (std::size_t i = 0; i <= n; ++i) nodes.push_back(0.5 * static_cast<double>(i));
  }
  data.materials = {"outside", "ball", "shell"};
  std::vector<std::uint16_t> labels;
  std::vector<float> sums;
  for (std::size_t site = 0; site < n * n * n; ++site) {
    const auto away = [&](std::size_t i) {
      return static_cast<double>(i) - 0.5 * static_cast<double>(n) + 0.5;
    };
    const double r = std::hypot(away(site % n), away(site / n % n), away(site / n / n));
    labels.push_back(r < 6 ? 1 : r < 9 ? 2 : 0);
    sums.push_back(static_cast<float>(r));
  }
  data.labels = std::span<const std::uint16_t>(labels);
  data.fields.push_back({.name = "r", .values = std::span<const float>(sums)});
  const Input input(data);
  const std::vector<Vec3> few = line_points({8.1, 8.2, 8.3}, {12.7, 13.1, 9.9}, 7),
                          many = line_points({8.1, 8.2, 8.3}, {12.7, 13.1, 9.9}, 601);
  Notes of_few, of_many;
  const PointSamples found = probe(input, few, {}, of_few), all = probe(input, many, {}, of_many);
  EXPECT_FALSE(of_few.stages.contains("joining interfaces"));
  EXPECT_TRUE(of_many.stages.contains("joining interfaces"));
  for (std::size_t i = 0; i < few.size(); ++i) {
    const PointSample &a = found.points[i], &b = all.points[100 * i];
    EXPECT_LT(distance(a.point, b.point), 1e-12);
    EXPECT_EQ(a.material, b.material);
    EXPECT_EQ(a.body, b.body);
    EXPECT_NEAR(a.interface_distance, b.interface_distance, 1e-12);
    EXPECT_NEAR(a.values.at(0), b.values.at(0), 1e-12);
  }
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
