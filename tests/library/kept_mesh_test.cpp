#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "adamas/cut_mesh.h"
#include "adamas/error.h"
#include "adamas/files.h"
#include "adamas/generate.h"
#include "adamas/mesh_files.h"
#include "adamas/probe.h"
#include "adamas/reconstruct.h"
#include "adamas/resample.h"
#include "adamas/select.h"
#include "adamas/simplify.h"
#include "tests/support/scratch.h"

namespace adamas {

namespace {

/// A mesh of a scene that keeps its input.
class KeptMeshes : public testing::Test {
 protected:
  static constexpr double kError = 0.04;

  static const GridData& data() {
    static const GeneratedScene kScene = generate_scene("voronoi10", {9, 9, 9}, 3);
    static const GridData kData = kScene.data.view();
    return kData;
  }
  static ResampleOptions options() {
    ResampleOptions options;
    options.interface_error = kError;
    options.field_errors = {{"smooth", 2}};
    return options;
  }
  static const AdaptiveMesh& mesh() {
    static const AdaptiveMesh kMesh = resample(Input(data()), options());
    return kMesh;
  }
};

TEST_F(KeptMeshes, AreThoseThatKeepNothing) {
  const AdaptiveMesh released = resample(data(), options());
  EXPECT_TRUE(mesh().has_input());
  EXPECT_FALSE(released.has_input());
  EXPECT_TRUE(std::ranges::equal(mesh().points(), released.points()));
  EXPECT_TRUE(std::ranges::equal(mesh().tetrahedra(), released.tetrahedra()));
  EXPECT_EQ(mesh().interfaces().triangles.size(), *mesh().report().interface_triangles);
  EXPECT_EQ(mesh().report().interface_error->certified, released.report().interface_error->certified);
  EXPECT_EQ(mesh().input_interfaces().materials.size(), 10u);
  EXPECT_NE(test::error_of([&] { static_cast<void>(released.input_interfaces()); }), "");
  const std::vector<MaterialTotals> input = input_totals(mesh()), wanted = material_totals(data());
  ASSERT_EQ(input.size(), wanted.size());
  for (std::size_t m = 0; m < input.size(); ++m) EXPECT_EQ(input[m].volume, wanted[m].volume);
  EXPECT_TRUE(input_totals(released).empty());
}

TEST_F(KeptMeshes, AreWhereTheNextStepBegins) {
  AdaptiveMesh coarse = resample(Input(data()), {.interface_error = 0.1});
  const AdaptiveMesh next = resample(Input(data()), std::move(coarse), options());
  EXPECT_TRUE(std::ranges::equal(mesh().tetrahedra(), next.tetrahedra()));
  ASSERT_TRUE(next.report().adaptation.has_value());
  EXPECT_GT(next.report().adaptation->kept, 0u);
  EXPECT_NE(test::error_of([&] { resample(Input(data()), resample(data())); }), "");
}

TEST_F(KeptMeshes, HaveAHierarchyToSelectFrom) {
  const test::Scratch scratch;
  const MultiresolutionMesh kept = multiresolution_mesh(mesh());
  write_hierarchy(scratch / "mesh.h5", kept);
  const MultiresolutionMesh all = read_hierarchy(scratch / "mesh.h5");
  EXPECT_EQ(all.tetrahedra(), mesh().tetrahedra().size());
  EXPECT_EQ(all.interface_error(), kError);
  const SelectedMesh whole = all.select();
  EXPECT_TRUE(whole.report.whole_hierarchy);
  EXPECT_EQ(whole.report.tetrahedra, mesh().tetrahedra().size());
  EXPECT_EQ(input_totals(whole.mesh).size(), 10u);
  const SelectedMesh coarse = all.select({.interface_error = ErrorTarget(0.1)});
  EXPECT_LT(coarse.report.tetrahedra, whole.report.tetrahedra);
  EXPECT_EQ(coarse.mesh.tetrahedra().size(), coarse.report.tetrahedra);
  ASSERT_TRUE(coarse.report.certificate.has_value());
  EXPECT_LE(coarse.report.certificate->interfaces.certified, 0.1);
  EXPECT_TRUE(coarse.report.unreached.empty());
  const SelectedMesh limited = all.select({.max_tetrahedra = 200});
  EXPECT_LE(limited.report.tetrahedra, 200u);
  for (const bool from_file : {false, true}) {
    const SelectedMesh missed =
        (from_file ? all : kept)
            .select({.interface_error = ErrorTarget(1e-6), .field_errors = {{"smooth", ErrorTarget(1e-9)}}});
    ASSERT_GE(missed.report.unreached.size(), 2u);
    const auto& distance = missed.report.unreached.front();
    ASSERT_TRUE(distance.place.has_value());
    ASSERT_TRUE(missed.report.unreached.back().place.has_value());
    EXPECT_TRUE(mesh().domain().contains(*missed.report.unreached.back().place));
    ASSERT_TRUE(missed.report.certificate.has_value());
    // The place of the distance is only in memory.
    EXPECT_EQ(std::isfinite(missed.report.certificate->interfaces.place.x), !from_file);
    if (!from_file) {
      EXPECT_EQ(*distance.place, missed.report.certificate->interfaces.place);
    }
  }
  EXPECT_NE(test::error_of([&] { static_cast<void>(all.select({.field_errors = {{"none", 1}}})); }), "");
  const AdaptiveMesh released = resample(data(), {.interface_error = 0.4});
  EXPECT_NE(test::error_of([&] { static_cast<void>(multiresolution_mesh(released)); }), "");
}

TEST_F(KeptMeshes, AreCutAndMeasured) {
  const CutMesh cut = cut_mesh(mesh());
  const CutMeshReport& report = cut.report();
  EXPECT_EQ(report.tetrahedra, cut.tetrahedra().tetrahedra.size());
  EXPECT_EQ(report.tetrahedra, mesh().cut_mesh().tetrahedra.size());
  ASSERT_TRUE(report.to_input.has_value());
  EXPECT_LE(report.to_input->interfaces.found, report.to_input->interfaces.certified);
  EXPECT_GT(report.dihedral_min, 0);
  const std::vector<MaterialTotals> totals = material_totals(cut);
  for (std::size_t m = 0; m < totals.size(); ++m)
    EXPECT_NEAR(totals[m].volume, mesh().report().materials[m].volume_mesh, 1e-6);
  const CutMesh split = cut_mesh(mesh(), {.error = kError, .split_bodies = true});
  EXPECT_GT(split.tetrahedra().points.size(), split.report().vertices);
  EXPECT_NE(test::error_of([] { static_cast<void>(cut_mesh(mesh(), {.error = -1})); }), "");
  const test::Scratch scratch;
  write_mesh(scratch / "cut.vtu", cut);
  write_faces(scratch / "cut-faces.vtp", cut);
  write_mesh(scratch / "mesh.vtu", mesh());
  write_mesh(scratch / "view.vtu", mesh().view());
  EXPECT_EQ(test::bytes_of(scratch / "mesh.vtu"), test::bytes_of(scratch / "view.vtu"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "cut-faces.vtp"));
}

TEST_F(KeptMeshes, ShowInterfacesThatAreSimplified) {
  const SimplifiedInterfaces found = simplify(mesh(), {.error = 0.02});
  EXPECT_EQ(found.report.triangles, found.mesh.triangles.size());
  EXPECT_EQ(found.report.triangles_before, mesh().interfaces().triangles.size());
  EXPECT_LT(found.report.triangles, found.report.triangles_before);
  EXPECT_LE(found.report.distances.interfaces.certified, 0.02);
  EXPECT_NE(test::error_of([] { static_cast<void>(simplify(mesh(), {})); }), "");
  EXPECT_NE(test::error_of([] { check(SimplifyOptions{.smooth = true}, Input(data())); }), "");
}

TEST_F(KeptMeshes, GivenInterfacesAreMeasured) {
  const ReconstructedInterfaces found = reconstruct(data());
  const ReconstructedInterfaces given = reconstruct(Input(found.mesh, found.domain));
  EXPECT_EQ(given.bodies, found.bodies);
  ASSERT_EQ(given.interfaces.size(), found.interfaces.size());
  for (std::size_t i = 0; i < given.interfaces.size(); ++i) {
    EXPECT_EQ(given.interfaces[i].materials, found.interfaces[i].materials);
    EXPECT_NEAR(given.interfaces[i].area, found.interfaces[i].area, 1e-6);
  }
  for (std::size_t m = 0; m < found.materials.size(); ++m) {
    EXPECT_FALSE(given.materials[m].volume_input.has_value());
    EXPECT_NEAR(*given.materials[m].volume_reconstructed, *found.materials[m].volume_reconstructed, 1e-6);
  }
  EXPECT_TRUE(found.agreement.has_value());
  EXPECT_FALSE(given.agreement.has_value());
}

}  // namespace

}  // namespace adamas
