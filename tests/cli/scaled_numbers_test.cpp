// Tests whole numbers of four bytes with a scale: stores keep the numbers and the scale.

#include <cstdint>
#include <cstring>

#include "core/io/nifti_header.h"
#include "core/io/volume_reader.h"
#include "tests/cli/program.h"
#include "tests/support/scratch.h"

namespace adamas {

namespace {

class ScaledNumbers : public test::ProgramTest {
 protected:
  /// Writes numbers that floats do not hold, times 0.25 less 3.
  ScaledNumbers() {
    VolumeGrid grid;
    grid.dimensions = {12, 10, 9};
    grid.type = SampleType::kFloat32;
    grid.slope = 0.25;
    grid.intercept = -3;
    for (std::uint64_t i = 0; i < grid.samples(); ++i)
      numbers_.push_back((std::int32_t{1} << 26) + static_cast<std::int32_t>(3 * i * i % 1001));
    std::string bytes = io::nifti_file_header(grid, StoredType::kInt32);
    bytes.append(reinterpret_cast<const char*>(numbers_.data()), 4 * numbers_.size());
    write("dose.nii", bytes);
  }

  std::vector<std::int32_t> numbers_;
};

TEST_F(ScaledNumbers, ComeBackAsTheyWere) {
  const auto stored = run({"store", "dose.nii", "-o", "dose.adm"});
  EXPECT_EQ(stored.status, 0) << stored.err;
  run_well({"info", "dose.adm", "--json", "dose.json"});
  const auto facts = read_json("dose.json");
  EXPECT_EQ(facts["number_type"], "int32");
  EXPECT_EQ(facts["slope"], 0.25);
  EXPECT_EQ(facts["intercept"], -3);
  run_well({"restore", "dose.adm", "-o", "back.nii", "-q"});
  EXPECT_EQ(read("back.nii").substr(352), read("dose.nii").substr(352));
  EXPECT_EQ(read("back.nii").substr(112, 8), read("dose.nii").substr(112, 8));
}

TEST_F(ScaledNumbers, OtherFormatsHaveTheirValues) {
  run_well({"store", "dose.nii", "-o", "dose.adm", "-q"});
  run_well({"restore", "dose.adm", "-o", "back.nrrd", "-q"});
  const std::string bytes = read("back.nrrd");
  const std::size_t begin = bytes.find("\n\n") + 2;
  ASSERT_EQ(bytes.size() - begin, 4 * numbers_.size());
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    float value = 0;
    std::memcpy(&value, bytes.data() + begin + 4 * i, 4);
    EXPECT_EQ(value, static_cast<float>(0.25 * numbers_[i] - 3));
  }
}

TEST_F(ScaledNumbers, SurfacesAndSlicesShowTheirValues) {
  run_well({"store", "dose.nii", "-o", "dose.adm", "-q"});
  const double value = 0.25 * ((1 << 26) + 500) - 3;
  run_well({"isosurface", "dose.adm", "--isovalue", std::to_string(value), "--error", "0.5voxels", "-o",
            "s.ply", "--json", "s.json", "-q"});
  EXPECT_GT(read_json("s.json")["triangles"], 100);
  run_well({"slice", "dose.adm", "--plane", "z=4", "-o", "s.png", "-q"});
}

}  // namespace
}  // namespace adamas
