#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "adamas/files.h"
#include "adamas/generate.h"
#include "adamas/probe.h"
#include "adamas/reconstruct.h"
#include "adamas/resample.h"
#include "adamas/slice.h"
#include "core/data/grid_data.h"
#include "core/io/unstructured_mesh_io.h"
#include "interfaces/input/grid_source.h"
#include "interfaces/mesh/interface_extraction.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/reconstruction/reconstruction.h"
#include "interfaces/resampling/resampler.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace interfaces;
using namespace io;

namespace {

/// A scene that is resampled by the library, and by the functions behind it.
class AdaptiveMeshOfAScene : public testing::Test {
 protected:
  static constexpr double kError = 0.04, kFieldError = 2;

  static const GridData& data() {
    static const GeneratedScene kScene = generate_scene("voronoi10", {9, 9, 9}, 3);
    static const GridData kData = kScene.data.view();
    return kData;
  }
  static const AdaptiveMesh& mesh() {
    static const AdaptiveMesh kMesh = resample(data(), options());
    return kMesh;
  }
  static ResampleOptions options() {
    ResampleOptions options;
    options.interface_error = kError;
    options.field_errors = {{"smooth", kFieldError}};
    options.ghost = GhostMode::kLinear;
    return options;
  }
};

TEST_F(AdaptiveMeshOfAScene, IsThatOfTheResampler) {
  const MultiMaterialData taken = to_multi_material_data(data());
  const ResamplingSource source = make_grid_source(taken);
  ResamplingOptions wanted;
  wanted.interface_error = kError;
  wanted.ghost = GhostMode::kLinear;
  wanted.field_errors.resize(source.fields->fields().size());
  for (std::size_t f = 0; f < wanted.field_errors.size(); ++f) {
    if (source.fields->fields()[f].name == "smooth") wanted.field_errors[f] = kFieldError;
  }
  Resampler resampler(source, wanted);
  resampler.refine();
  EXPECT_EQ(mesh().tetrahedra().size(), resampler.hierarchy().leaf_count());
  const ResampleReport& report = mesh().report();
  EXPECT_EQ(report.interface_error->certified, resampler.certificate()->networks.upper);
  EXPECT_EQ(report.interface_error_per_material->found, resampler.certificate()->materials.lower);
  EXPECT_LE(report.interface_error->found, report.interface_error->certified);
  EXPECT_LE(report.interface_error->certified, kError);
  EXPECT_TRUE(report.unreached.empty());

  const ResampledMesh program = resampled_mesh(resampler);
  const InterfaceMesh shown = approximated_interfaces(program).mesh;
  const InterfaceTriangles interfaces = mesh().interfaces();
  EXPECT_EQ(interfaces.points, shown.points);
  EXPECT_EQ(interfaces.triangles.size(), shown.triangles.size());
  EXPECT_EQ(interfaces.materials.size(), 10u);
}

TEST_F(AdaptiveMeshOfAScene, HasTheVolumesOfTheFractionsUnlessToldOtherwise) {
  EXPECT_FALSE(mesh().report().conservation_tolerance);  // an error of a field is wanted
  ResampleOptions by_default = options();
  by_default.field_errors.clear();
  const AdaptiveMesh conserved = resample(data(), by_default);
  const ResampleReport& report = conserved.report();
  ASSERT_TRUE(report.conservation_tolerance);
  EXPECT_FALSE(report.conservation_wanted);
  for (const ResampleReport::Body& body : report.bodies) EXPECT_TRUE(report.is_conserved(body));
  for (const ResampleReport::Material& material : report.materials)
    EXPECT_NEAR(material.volume_mesh, *material.volume_input, 1e-9) << material.name;

  ResampleOptions off = by_default, on = by_default;
  off.conserve = false;
  on.conserve = true;
  const AdaptiveMesh without = resample(data(), off), wanted = resample(data(), on);
  EXPECT_FALSE(without.report().conservation_tolerance);
  EXPECT_TRUE(wanted.report().conservation_wanted);
  EXPECT_EQ(without.tetrahedra().size(), conserved.tetrahedra().size());
  double greatest = 0;
  for (const ResampleReport::Body& body : without.report().bodies)
    greatest = std::max(greatest, body.missing());
  EXPECT_GT(greatest, 1e-5);
  for (std::size_t b = 0; b < report.bodies.size(); ++b)
    EXPECT_EQ(wanted.report().bodies[b].volume_mesh, report.bodies[b].volume_mesh);
}

TEST_F(AdaptiveMeshOfAScene, ItsFileIsThatOfTheProgram) {
  const test::Scratch scratch;
  write_mesh(scratch / "library.vtu", mesh().view());
  const ResampledMesh again =
      from_unstructured_mesh(read_unstructured_mesh(scratch / "library.vtu"), "library");
  EXPECT_EQ(again.cells.size(), mesh().tetrahedra().size());
  write_unstructured_mesh(scratch / "program.vtu", to_unstructured_mesh(again));
  EXPECT_EQ(test::bytes_of(scratch / "library.vtu"), test::bytes_of(scratch / "program.vtu"));
}

TEST_F(AdaptiveMeshOfAScene, ReportAndArraysAgree) {
  const ResampleReport& report = mesh().report();
  const auto errors = std::get<std::span<const double>>(mesh().cell_array("smooth error").values);
  ASSERT_EQ(errors.size(), mesh().tetrahedra().size());
  for (const ResampleReport::Field& field : report.fields) {
    if (field.name != "smooth") continue;
    EXPECT_EQ(field.target, kFieldError);
    EXPECT_EQ(field.everywhere.max_error, *std::max_element(errors.begin(), errors.end()));
    EXPECT_LE(field.everywhere.max_error, kFieldError);
  }
  double volume = 0, input = 0;
  for (const auto& material : report.materials) {
    volume += material.volume_mesh;
    input += *material.volume_input;
  }
  EXPECT_NEAR(volume, 1, 1e-9);
  EXPECT_NEAR(input, 1, 1e-6);
  const auto materials = std::get<std::span<const std::int32_t>>(mesh().cell_array("material").values);
  EXPECT_EQ(static_cast<std::size_t>(std::count(materials.begin(), materials.end(), -1)),
            report.interface_tetrahedra);
  EXPECT_NE(
      test::error_of([] { static_cast<void>(mesh().point_array("nothing")); }).find("'smooth in cell0'"),
      std::string::npos);
}

TEST_F(AdaptiveMeshOfAScene, SlicesHaveTheAreasOfTheCutMesh) {
  const Plane plane{{0.5, 0.5, 0.4}, {0, 0, 1}};
  const Slice cut = slice(mesh(), plane, {.field = "smooth"});
  double area = 0;
  for (const double a : cut.material_areas) area += a;
  EXPECT_NEAR(area, 1, 1e-9);
  EXPECT_EQ(cut.values.size(), cut.points.size());
  EXPECT_EQ(cut.offsets.back(), cut.points.size());
  EXPECT_EQ(cut.offsets.size(), cut.polygon_materials.size() + 1);
  EXPECT_FALSE(cut.interface_edges.empty());
  const Slice input = slice(data(), plane);
  EXPECT_TRUE(input.values.empty());
  for (std::size_t m = 0; m < 10; ++m) EXPECT_NEAR(input.material_areas[m], cut.material_areas[m], 0.05);
}

TEST_F(AdaptiveMeshOfAScene, CutMeshesHaveOneMaterialPerTetrahedron) {
  const MaterialTetrahedra cut = mesh().cut_mesh();
  ASSERT_EQ(cut.tetrahedron_materials.size(), cut.tetrahedra.size());
  std::vector<double> volumes(10);
  for (std::size_t t = 0; t < cut.tetrahedra.size(); ++t) {
    const auto [a, b, c, d] = cut.tetrahedra[t];
    const Vec3 p = cut.points[a];
    volumes[cut.tetrahedron_materials[t]] +=
        dot(cross(cut.points[b] - p, cut.points[c] - p), cut.points[d] - p) / 6;
  }
  for (std::size_t m = 0; m < 10; ++m)
    EXPECT_NEAR(volumes[m], mesh().report().materials[m].volume_mesh, 1e-6);
  EXPECT_NE(test::error_of([] { static_cast<void>(mesh().cut_mesh(-1)); }), "");
}

TEST_F(AdaptiveMeshOfAScene, ReconstructionsAreTheSame) {
  const ReconstructedInterfaces found = reconstruct(data());
  const MultiMaterialData taken = to_multi_material_data(data());
  const Reconstruction wanted(taken);
  EXPECT_EQ(found.mesh.points, wanted.mesh().points);
  EXPECT_EQ(found.mesh.triangles.size(), wanted.mesh().triangles.size());
  EXPECT_EQ(found.bodies, wanted.body_materials().size());
  for (MaterialId m(0); m.value < 10; ++m.value)
    EXPECT_EQ(found.materials[m.value].volume_reconstructed, wanted.volume_reconstructed()[m]);
  ReconstructOptions fewer;
  fewer.simplify.error = 0.02;
  const ReconstructedInterfaces simple = reconstruct(data(), fewer);
  EXPECT_LT(simple.mesh.triangles.size(), found.mesh.triangles.size() / 2);
  EXPECT_EQ(simple.mesh.materials, found.mesh.materials);
}

TEST_F(AdaptiveMeshOfAScene, GivenInterfacesAreResampledToo) {
  const InterfaceTriangles given = reconstruct(data()).mesh;
  const Box3 domain{{0, 0, 0}, {1, 1, 1}};
  ResampleOptions coarse;
  coarse.interface_error = 0.06;
  const AdaptiveMesh found = resample(given, domain, coarse);
  EXPECT_EQ(found.report().materials.size(), 10u);
  EXPECT_LE(found.report().interface_error->certified, 0.06);
  for (const auto& material : found.report().materials)
    EXPECT_NEAR(material.volume_mesh, *material.volume_input, 0.01);
  const auto greatest = [](const ResampleReport& report) {
    return report.bodies[*report.worst_volume].volume_error();
  };
  EXPECT_GT(greatest(found.report()), 0.001);
  coarse.volume_error = 0.001;
  const AdaptiveMesh finer = resample(given, domain, coarse);
  EXPECT_LE(greatest(finer.report()), 0.001);
  EXPECT_EQ(finer.report().volume_error_target, 0.001);
  EXPECT_TRUE(std::ranges::none_of(finer.report().bodies,
                                   [](const auto& body) { return body.missed_volume.has_value(); }));
  EXPECT_GT(finer.tetrahedra().size(), found.tetrahedra().size());
  const auto has = [](const std::string& message, const char* text) {
    EXPECT_NE(message.find(text), std::string::npos) << message;
  };
  has(test::error_of([&] { resample(given, {{2, 2, 2}, {3, 3, 3}}); }), "inside the box");
  has(test::error_of([&] { resample(given, Box3()); }), "interfaces");
  InterfaceTriangles wrong = given;
  wrong.points[3].y = std::nan("");
  has(test::error_of([&] { resample(wrong, domain); }), "finite");
  wrong = given;
  wrong.triangles[3][1] = static_cast<std::uint32_t>(wrong.points.size());
  has(test::error_of([&] { resample(wrong, domain); }), "expected points below");
}

TEST_F(AdaptiveMeshOfAScene, PointsHaveTheirMaterialAndItsField) {
  std::vector<Vec3> points{{2, 2, 2}};
  for (std::size_t t = 0; t < mesh().tetrahedra().size(); t += 7) {
    Vec3 center;
    for (const std::uint32_t corner : mesh().tetrahedra()[t]) center += 0.25 * mesh().points()[corner];
    points.push_back(center);
  }
  const PointSamples found = probe(mesh(), points);
  ASSERT_EQ(found.points.size(), points.size());
  EXPECT_EQ(found.points[0].material, PointSample::kNoMaterial);
  EXPECT_TRUE(std::isnan(found.points[0].values[0]));
  const auto smooth = std::ranges::find(found.fields, "smooth", &FieldDescription::name);
  ASSERT_NE(smooth, found.fields.end());
  std::size_t at = 0;
  for (auto field = found.fields.begin(); field != smooth; ++field)
    at += static_cast<std::size_t>(field->components);
  const auto materials = std::get<std::span<const std::int32_t>>(mesh().cell_array("material").values);
  for (std::size_t n = 1; n < points.size(); ++n) {
    const std::size_t t = 7 * (n - 1);
    const PointSample& sample = found.points[n];
    if (materials[t] < 0) continue;
    EXPECT_EQ(static_cast<std::int32_t>(sample.material), materials[t]);
    // The value is the mean of the corners' values of that material's own field.
    const auto values = std::get<std::span<const double>>(
        mesh().point_array("smooth in " + found.materials[sample.material]).values);
    double mean = 0;
    for (const std::uint32_t corner : mesh().tetrahedra()[t]) mean += 0.25 * values[corner];
    EXPECT_NEAR(sample.values[at], mean, 1e-9 * (1 + std::abs(mean)));
  }
  const std::vector<MaterialTotals> totals = material_totals(mesh()), given = material_totals(data());
  ASSERT_EQ(totals.size(), given.size());
  for (std::size_t m = 0; m < totals.size(); ++m) {
    EXPECT_NEAR(totals[m].volume, mesh().report().materials[m].volume_mesh, 1e-9);
    EXPECT_NEAR(given[m].volume, *mesh().report().materials[m].volume_input, 1e-6);
    EXPECT_NEAR(totals[m].means[at], given[m].means[at], kFieldError);
  }
  // The input has the same materials except near interfaces, which the mesh may displace by its error.
  const PointSamples input = probe(Input(data()), points);
  for (std::size_t n = 1; n < points.size(); ++n) {
    if (!(input.points[n].interface_distance > kError)) continue;
    EXPECT_EQ(input.points[n].material, found.points[n].material);
  }
}

TEST_F(AdaptiveMeshOfAScene, WrongOptionsAreToldInALine) {
  const auto error_with = [](const auto& change) {
    ResampleOptions wrong;
    change(wrong);
    return test::error_of([&] { resample(data(), wrong); });
  };
  const auto has = [](const std::string& message, const char* text) {
    EXPECT_NE(message.find(text), std::string::npos) << message;
  };
  has(error_with([](auto& o) { o.interface_error = 0; }), "expected a positive error");
  has(error_with([](auto& o) { o.interface_error = std::nan(""); }), "found nan");
  has(error_with([](auto& o) { o.interface_error = 2; }), "domain's diagonal");
  has(error_with([](auto& o) { o.field_errors = {{"rough", 1}}; }), "found 'rough'");
  has(error_with([](auto& o) { o.max_tetrahedra = 1; }), "tetrahedra");
  has(error_with([](auto& o) { o.volume_error = 0; }), "--volume-error: expected a part above 0");
  has(error_with([](auto& o) { o.volume_error = 1; }), "less than 1, found 1");
  has(error_with([](auto& o) { o.volume_error = std::nan(""); }), "found nan");
  has(error_with([](auto& o) { o.smooth_labels = true; }), "--smooth-labels: expected labels");
  has(test::error_of([] { slice(mesh(), {{0, 0, 9}, {0, 0, 1}}); }), "plane");
  has(test::error_of([] { slice(mesh(), {{0, 0, 0.5}, {0, 0, 1}}, {.field = "rough"}); }), "rough");
}

TEST_F(AdaptiveMeshOfAScene, CanBeCancelled) {
  struct Impatient final : Progress {
    void report(std::string_view, double) override { ++reports; }
    [[nodiscard]] bool cancelled() const override { return reports > 3; }
    int reports = 0;
  } progress;
  EXPECT_THROW(resample(data(), options(), progress), Cancelled);
}

}  // namespace
}  // namespace adamas
