// Tests the comparison of the resampled mesh with meshes of other generators.

#include "adamas/compare.h"

#include <gtest/gtest.h>

#include "adamas/comparison_picture.h"
#include "adamas/error.h"
#include "adamas/generate.h"
#include "adamas/verify.h"
#include "tests/support/scratch.h"

namespace adamas {
namespace {

TEST(MeshComparisons, RowsHaveMeshesOfEqualDistance) {
  set_reference_program(ADAMAS_REFERENCE_PROGRAM);
  EXPECT_EQ(find_reference_program("the test"), ADAMAS_REFERENCE_PROGRAM);
  CompareOptions options;
  options.tetgen = false;
  options.interface_errors = {{0.06, ErrorTarget::Unit::kPart}};
  const MeshComparison comparison(Input(generate_scene("sphere", {8, 8, 8}).data), options);
  std::size_t told = 0;
  const std::vector<ComparisonRow> rows = comparison.run([&told](const ComparisonRow&) { ++told; });
  EXPECT_EQ(rows.size(), 2 + options.reference_count(false));
  EXPECT_EQ(told, rows.size());
  EXPECT_EQ(rows.front().kind, MeshKind::kOwn);
  for (const ComparisonRow& row : rows) {
    ASSERT_EQ(row.failure, "") << mesh_name(row.kind);
    EXPECT_GT(row.tetrahedra, 0u);
    EXPECT_EQ(row.materials.size(), 2u);
    EXPECT_EQ(row.matched, std::abs(row.distance() / rows.front().distance() - 1) <= kSizingTolerance);
  }
  const test::Scratch scratch;
  write_comparison_picture(scratch / "c.svg", rows, "sphere");
  EXPECT_GT(std::filesystem::file_size(scratch / "c.svg"), 1000u);
  set_reference_program({});
}

TEST(MeshComparisons, OptionsAreChecked) {
  CompareOptions options;
  options.tetgen_switches = "pq";
  EXPECT_THROW(options.check(), Error);
  options = {};
  options.tetgen = options.mesh3 = false;
  EXPECT_THROW(options.check(), Error);
}

}  // namespace
}  // namespace adamas
