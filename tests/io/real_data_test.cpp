#include <algorithm>
#include <map>

#include "adamas/file_summary.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/multi_material_reader.h"
#include "sample_data.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::shared_data;

std::map<std::size_t, std::size_t> triangles_per_edge(const InterfaceMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> edges;
  for (const InterfaceTriangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[std::minmax(t.points[i], t.points[(i + 1) % 3])];
  }
  std::map<std::size_t, std::size_t> counts;
  for (const auto& [edge, count] : edges) ++counts[count];
  return counts;
}

TEST(SharedData, LiesWhereTheVariableSays) {
  const char* before = std::getenv("ADAMAS_DATA");
  const std::string kept = before != nullptr ? before : "";
  ::setenv("ADAMAS_DATA", "/somewhere", 1);
  EXPECT_EQ(shared_data("a/b.vtr"), "/somewhere/a/b.vtr");
  ::unsetenv("ADAMAS_DATA");
  EXPECT_EQ(shared_data("a.vtr").lexically_normal(),
            (std::filesystem::path(ADAMAS_SOURCE_DIR) / "../shared/data/a.vtr").lexically_normal());
  if (before != nullptr) ::setenv("ADAMAS_DATA", kept.c_str(), 1);
}

TEST(RealData, CthImpact) {
  const auto path = shared_data("material/pyvista_misc/cth.vtr");
  ADAMAS_SKIP_WITHOUT(path);
  const MultiMaterialData data = read_multi_material_data(path);
  EXPECT_EQ(data.materials, (IdVector<MaterialId, std::string>{"Void", "Armor Plate", "Body, Nose"}));
  EXPECT_EQ(data.grid.centering, Centering::kCells);
  EXPECT_EQ(data.grid.sites(0), 128u);
  EXPECT_EQ(data.grid.sites(1), 64u);
  EXPECT_EQ(data.grid.sites(2), 64u);
  EXPECT_NEAR(data.report.sum_min, 0.998, 5e-4);
  EXPECT_NEAR(data.report.sum_max, 1.002, 5e-4);
  const auto& x = data.grid.nodes[0];
  EXPECT_GT(x[1] - x[0], 1.5 * (x[50] - x[49])) << "the uneven x is kept";
  std::size_t triple = 0;
  for (std::size_t i = 0; i < data.grid.site_count(); ++i) {
    triple += std::all_of(data.fractions.begin(), data.fractions.end(),
                          [i](const auto& f) { return f[i] > 1e-3f; });
  }
  EXPECT_EQ(triple, 1306u);
  ASSERT_EQ(data.fields.size(), 3u);
  EXPECT_EQ(data.fields[1].name, "Velocity");
  EXPECT_EQ(data.fields[1].components, 3);
  EXPECT_EQ(data.fields[2].name, "Mass");
  EXPECT_TRUE(data.fields[2].material_values[MaterialId(0)].empty());
  EXPECT_EQ(data.fields[2].material_values[MaterialId(1)].size(), data.grid.site_count());
}

TEST(RealData, CthMassBecomesTheDensityOfMetal) {
  const auto path = shared_data("material/pyvista_misc/cth.vtr");
  ADAMAS_SKIP_WITHOUT(path);
  MaterialDataOptions options;
  options.extensive = {"Mass"};
  const MultiMaterialData data = read_multi_material_data(path, options);
  std::vector<double> densities;
  for (std::size_t i = 0; i < data.grid.site_count(); ++i) {
    if (data.fraction(MaterialId(1), i) > 0.99f)
      densities.push_back(data.fields[2].material_values[MaterialId(1)][i]);
  }
  ASSERT_FALSE(densities.empty());
  std::nth_element(densities.begin(), densities.begin() + static_cast<std::ptrdiff_t>(densities.size() / 2),
                   densities.end());
  EXPECT_NEAR(densities[densities.size() / 2], 11.35, 0.05) << "lead, in g/cm^3";
}

TEST(RealData, BrainTissues) {
  const std::string stem = "material/nilearn_mni152/mni_icbm152_", end = "_tal_nlin_sym_09a_converted.nii.gz";
  const auto grey = shared_data(stem + "gm" + end), white = shared_data(stem + "wm" + end);
  ADAMAS_SKIP_WITHOUT(grey);
  MaterialDataOptions options;
  options.fractions = {{"grey", grey.filename().string()}, {"white", white.filename().string()}};
  options.fields = {{"t1", shared_data(stem + "t1" + end).string()}};
  options.fraction_scale = 255;
  options.rest = "rest";
  const MultiMaterialData data = read_multi_material_data(grey, options);
  EXPECT_EQ(data.grid.centering, Centering::kCells);
  EXPECT_EQ(data.grid.site_count(), 197u * 233u * 189u);
  EXPECT_EQ(data.grid.domain().min, (Vec3{-98.5, -134.5, -72.5}));
  EXPECT_EQ(data.grid.domain().size(), (Vec3{197, 233, 189}));
  EXPECT_EQ(data.materials.size(), 3u);
  ASSERT_EQ(data.fields.size(), 1u);
  EXPECT_EQ(data.fields[0].name, "t1");
  EXPECT_EQ(data.report.renormalised, 0u) << "grey and white never exceed one";
}

TEST(RealData, ElectrodeAndItsTiffAgree) {
  const auto stack = shared_data("material/taufactor/electrode.tiff");
  const auto labels = shared_data("derived/labels/electrode_256x256x256.nrrd");
  ADAMAS_SKIP_WITHOUT(stack);
  ADAMAS_SKIP_WITHOUT(labels);
  MaterialDataOptions options;
  options.labels = stack.filename().string();
  const MultiMaterialData tiff = read_multi_material_data(stack, options);
  options.labels = labels.filename().string();
  const MultiMaterialData nrrd = read_multi_material_data(labels, options);
  EXPECT_EQ(tiff.materials, (IdVector<MaterialId, std::string>{"0", "85", "170"}));
  EXPECT_EQ(nrrd.materials, (IdVector<MaterialId, std::string>{"0", "1", "2"}));
  std::array<double, 3> tiff_share{}, nrrd_share{};
  for (const SiteArray<std::uint16_t> all = tiff.labels.dense(); const std::uint16_t v : all)
    tiff_share.at(v) += 1.0 / 16777216;
  for (const SiteArray<std::uint16_t> all = nrrd.labels.dense(); const std::uint16_t v : all)
    nrrd_share.at(v) += 1.0 / 16777216;
  EXPECT_NEAR(nrrd_share[0], 0.45, 0.005);
  EXPECT_NEAR(nrrd_share[1], 0.40, 0.005);
  EXPECT_NEAR(nrrd_share[2], 0.15, 0.005);
  for (std::size_t m = 0; m < 3; ++m) EXPECT_NEAR(tiff_share[m], nrrd_share[m], 1e-9);
}

TEST(RealData, SteelGrains) {
  const auto path = shared_data("derived/labels/al6xn_grains_46x64x68.nrrd");
  ADAMAS_SKIP_WITHOUT(path);
  MaterialDataOptions options;
  options.labels = path.filename().string();
  const MultiMaterialData data = read_multi_material_data(path, options);
  EXPECT_EQ(data.materials.size(), 92u);
  EXPECT_NEAR(data.grid.nodes[0][1] - data.grid.nodes[0][0], 3.6, 1e-9);
  EXPECT_NEAR(data.grid.nodes[2][1] - data.grid.nodes[2][0], 3.3, 1e-9);
}

TEST(RealData, LegacyFileWithVectors) {
  const auto path = shared_data("volume/pyvista_misc/carotid.vtk");
  ADAMAS_SKIP_WITHOUT(path);
  const FileSummary summary = summarize_file(path);
  EXPECT_EQ(summary.nodes, (std::array<std::size_t, 3>{76, 49, 45}));
  ASSERT_EQ(summary.arrays.size(), 2u);
  EXPECT_EQ(summary.arrays[1].components, 3);
  EXPECT_EQ(summary.arrays[0].max, 580);
}

TEST(RealData, GeologicalModelIsClosedAndOriented) {
  const auto path = shared_data("surface/ringmesh/geomodel3d_labelled.txt");
  ADAMAS_SKIP_WITHOUT(path);
  const InterfaceMesh mesh =
      read_labelled_network(path, shared_data("surface/ringmesh/geomodel3d_regions.txt"));
  EXPECT_EQ(mesh.points.size(), 25827u);
  EXPECT_EQ(mesh.triangles.size(), 55426u - 997u) << "997 lie inside a region";
  ASSERT_EQ(mesh.materials.size(), 15u);
  EXPECT_EQ(mesh.materials[MaterialId(1)], "H2b_1");
  const auto edges = triangles_per_edge(mesh);
  EXPECT_EQ(edges.size(), 2u) << "no open edge";
  EXPECT_EQ(edges.at(3), 3605u);
  double sum = 0;
  for (MaterialId m(1); m.value < 15; ++m.value) {
    EXPECT_GT(test::enclosed_volume(mesh, m), 0);
    sum += test::enclosed_volume(mesh, m);
  }
  EXPECT_NEAR(test::enclosed_volume(mesh, MaterialId(0)), -sum, 1e-9 * sum);
}

TEST(RealData, InterfaceNetworksHavePositiveRegions) {
  for (const char* name : {"enright", "zalesak", "merge", "cyclicflow", "noise"}) {
    const auto path = shared_data("surface/multitracker/" + std::string(name) + ".arec");
    ADAMAS_SKIP_WITHOUT(path);
    const InterfaceMesh mesh = read_labelled_network(path);
    ASSERT_EQ(mesh.materials[MaterialId(0)], "0");
    for (MaterialId m(0); m.value < mesh.materials.size(); ++m.value) {
      EXPECT_EQ(test::enclosed_volume(mesh, m) > 0, m.value > 0) << name << " region " << mesh.materials[m];
    }
  }
  const InterfaceMesh enright = read_labelled_network(shared_data("surface/multitracker/enright.arec"));
  EXPECT_EQ(enright.materials.size(), 5u);
  EXPECT_EQ(triangles_per_edge(enright).at(3), 285u);
  EXPECT_EQ(read_labelled_network(shared_data("surface/multitracker/mcf_raw.arec")).materials.size(), 2000u);
}

TEST(RealData, Surfaces) {
  const auto blade = shared_data("surface/pyvista/turbineblade.ply");
  ADAMAS_SKIP_WITHOUT(blade);
  EXPECT_EQ(summarize_file(blade).cells, 199034u);
  const InterfaceMesh sphere = read_surface(shared_data("surface/axom/boxedSphere.stl"), "out", "in");
  EXPECT_EQ(summarize_file(shared_data("surface/axom/boxedSphere.stl")).cells, 65492u);
  EXPECT_EQ(triangles_per_edge(sphere).size(), 1u);
  for (const char* name : {"cgal/bunny00.off", "cgal/boeing.off", "libigl/fertility.off", "hayashi/test.obj",
                           "axom/cap.stl", "axom/unit_sphere.stl"}) {
    EXPECT_GT(read_surface(shared_data("surface/" + std::string(name)), "out", "in").triangles.size(), 100u)
        << name;
  }
}

}  // namespace
}  // namespace adamas
