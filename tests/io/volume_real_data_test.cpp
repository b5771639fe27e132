// Tests published volumes, where they are present: checksums of their samples are compared with those of an
// independent reading.

#include "core/io/volume_stack.h"
#include "tests/io/volume_files.h"

namespace adamas {

using namespace io;

namespace {

struct Known {
  std::array<std::uint64_t, 3> dimensions;
  SampleType type;
  Vec3 spacing, origin;
  std::uint32_t sum;  ///< CRC-32 of all samples
};

void expect_known(VolumeReader& reader, const Known& known, const std::string& name) {
  const VolumeGrid& grid = reader.grid();
  EXPECT_EQ(grid.dimensions, known.dimensions) << name;
  EXPECT_EQ(grid.type, known.type) << name;
  EXPECT_EQ(grid.spacing, known.spacing) << name;
  EXPECT_EQ(grid.origin, known.origin) << name;
  uLong sum = 0;
  std::vector<std::byte> plane(grid.plane_bytes());
  for (std::uint64_t k = 0; k < grid.dimensions[2]; ++k) {
    reader.read_plane(k, plane);
    sum = crc32(sum, reinterpret_cast<const Bytef*>(plane.data()), static_cast<uInt>(plane.size()));
  }
  EXPECT_EQ(sum, known.sum) << name;
}

void expect_file(const std::string& name, const Known& known) {
  const auto path = test::shared_data("volume/" + name);
  ADAMAS_SKIP_WITHOUT(path);
  VolumeReader reader = open_volume(path);
  expect_known(reader, known, name);
}

constexpr Vec3 kUnit{1, 1, 1};
constexpr SampleType kByte = SampleType::kUint8;

TEST(RealVolumes, Bonsai) {
  expect_file("vtkjs/bonsai.vti", {{256, 256, 256}, kByte, kUnit, {}, 0x8c4f65d7});
}
TEST(RealVolumes, Aneurism) {
  expect_file("vtkjs/aneurism.vti", {{256, 256, 256}, kByte, kUnit, {}, 0x7c251b13});
}
TEST(RealVolumes, Engine) {
  expect_file("vtkjs/engine.vti", {{256, 256, 128}, kByte, kUnit, {}, 0x9e845983});
}
TEST(RealVolumes, Lidc) {
  expect_file("vtkjs/LIDC2.vti", {{256, 256, 133}, kByte, {1.40625, 1.40625, 2.5}, {}, 0xfdf4efd0});
}
TEST(RealVolumes, Heptane) {
  expect_file("openscivis/heptane.nii.gz", {{302, 302, 302}, kByte, kUnit, {-150, -150, -151}, 0x5ed65d4b});
}
TEST(RealVolumes, Stent) {
  expect_file("stent/stent.nrrd", {{128, 128, 256}, SampleType::kFloat32, kUnit, {}, 0x2b7e5698});
}
TEST(RealVolumes, Tooth) { expect_file("vtkjs/tooth.nrrd", {{103, 94, 161}, kByte, kUnit, {}, 0x41a8e84c}); }
TEST(RealVolumes, Carotid) {
  expect_file("pyvista_misc/carotid.vtk",
              {{76, 49, 45}, SampleType::kFloat32, kUnit, {100, 80, 1}, 0x84fdc3c1});
}
TEST(RealVolumes, IronProtein) {
  expect_file("pyvista_misc/ironProt.vtk", {{68, 68, 68}, kByte, kUnit, {}, 0x88562b6e});
}

TEST(RealVolumes, StanfordHead) {
  const auto folder = test::shared_data("volume/thewildnath/StanfordHead");
  ADAMAS_SKIP_WITHOUT(folder);
  VolumeReader reader = open_volume_stack(match_stack(folder / "cthead-16bit%03d.tif"), {1, 1, 2});
  expect_known(reader, {{256, 256, 99}, SampleType::kUint16, {1, 1, 2}, {}, 0x764b60c0}, "head");
}

void expect_raw(const std::string& name, RawVolume raw, std::uint32_t sum) {
  const auto path = test::shared_data("volume/" + name);
  ADAMAS_SKIP_WITHOUT(path);
  VolumeReader reader = open_raw_volume(path, raw);
  expect_known(reader, {raw.dimensions, reader.grid().type, raw.spacing, {}, sum}, name);
}

TEST(RealVolumes, BareSamples) {
  RawVolume raw;
  raw.dimensions = {256, 256, 108};
  raw.type = StoredType::kInt16;
  raw.spacing = {0.957, 0.957, 1.5};
  expect_raw("invesalius_cranium/matrix.dat", raw, 0xab70a884);
}
TEST(RealVolumes, BareSamplesBehindAHeader) {
  RawVolume raw;
  raw.type = StoredType::kUint16;
  raw.header_bytes = 6;
  raw.dimensions = {138, 138, 82};
  expect_raw("tuwien_dat/beetle_138x138x82.dat", raw, 0xbb956bc8);
  raw.dimensions = {120, 120, 34};
  expect_raw("tuwien_dat/lobster_120x120x34.dat", raw, 0x628ced2b);
}

}  // namespace
}  // namespace adamas
