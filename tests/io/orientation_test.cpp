#include <cstring>

#include "core/io/grid_axes.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::put_bytes;
using test::says;

template <class T>
std::string raw(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

constexpr std::array<std::size_t, 3> kSizes{2, 3, 4};

/// Returns the array of all files here: bytes 0 to 23 on 2 x 3 x 4 points.
std::string voxels() {
  std::string bytes;
  for (char v = 0; v < 24; ++v) bytes += v;
  return bytes;
}

/// Expects the voxel (i, j, k) of the array at origin + i a + j b + k c, whatever its present order in
/// memory.
void expect_places(const GridFile& file, const std::array<Vec3, 3>& steps, const Vec3& origin) {
  ASSERT_EQ(file.arrays.size(), 1u);
  const auto& values = std::get<std::vector<std::int32_t>>(file.arrays[0].values);
  ASSERT_EQ(values.size(), 24u);
  const std::size_t nx = file.nodes[0].size(), ny = file.nodes[1].size();
  ASSERT_EQ(nx * ny * file.nodes[2].size(), 24u);
  for (const auto& nodes : file.nodes) EXPECT_TRUE(std::is_sorted(nodes.begin(), nodes.end()));
  for (std::size_t site = 0; site < 24; ++site) {
    const Vec3 found{file.nodes[0][site % nx], file.nodes[1][site / nx % ny],
                     file.nodes[2][site / (nx * ny)]};
    const auto v = static_cast<std::size_t>(values[site]);
    const Vec3 expected = origin + static_cast<double>(v % kSizes[0]) * steps[0] +
                          static_cast<double>(v / kSizes[0] % kSizes[1]) * steps[1] +
                          static_cast<double>(v / (kSizes[0] * kSizes[1])) * steps[2];
    EXPECT_LT(distance(found, expected), 1e-6) << "voxel " << v;
  }
}

struct Case {
  std::array<Vec3, 3> steps;
  bool parallel = true;
};

/// The axes are straight, mirrored, turned by a quarter, or all three exchanged; the last cases are to be
/// refused.
const std::vector<Case> kCases{
    {{{{1, 0, 0}, {0, 0.5, 0}, {0, 0, 2}}}},         {{{{-1, 0, 0}, {0, 0.5, 0}, {0, 0, 2}}}},
    {{{{-1, 0, 0}, {0, -0.5, 0}, {0, 0, 2}}}},       {{{{0, 1, 0}, {-0.5, 0, 0}, {0, 0, 2}}}},
    {{{{0, 0, -1}, {0.5, 0, 0}, {0, 2, 0}}}},        {{{{0.8, 0.6, 0}, {-0.3, 0.4, 0}, {0, 0, 2}}}, false},
    {{{{1, 0, 0}, {0.1, 0.5, 0}, {0, 0, 2}}}, false}};
const Vec3 kOrigin{10, -20, 30};

void expect_read(const std::filesystem::path& path, const Case& c) {
  const GridFile file = read_grid_file(path);
  if (c.parallel) {
    require_laid_out(path.string(), file);
    return expect_places(file, c.steps, kOrigin);
  }
  EXPECT_TRUE(says(error_of([&] { require_laid_out(path.string(), file); }),
                   path.filename().string() + ": expected axes parallel to x, y and z, one to each, found"));
  ASSERT_TRUE(file.aslant);
  const std::array<double, 3> last{file.nodes[0].back(), file.nodes[1].back(), file.nodes[2].back()};
  Vec3 found = file.aslant->origin, expected = kOrigin;
  for (std::size_t a = 0; a < 3; ++a) {
    found += last[a] * file.aslant->directions[a];
    expected += static_cast<double>(kSizes[a] - 1) * c.steps[a];
  }
  EXPECT_LT(distance(found, expected), 1e-5) << "the last voxel";
}

std::string join(const Vec3& v, const char* separator) {
  return fmt::format("{}{}{}{}{}", v.x, separator, v.y, separator, v.z);
}

TEST(Orientation, Nrrd) {
  const test::Scratch scratch;
  for (const Case& c : kCases) {
    std::string header =
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 3 4\nencoding: raw\nspace dimension: 3\n";
    header += "space directions:";
    for (const Vec3& step : c.steps) header += " (" + join(step, ",") + ")";
    put_bytes(scratch / "a.nrrd", header + "\nspace origin: (" + join(kOrigin, ",") + ")\n\n" + voxels());
    expect_read(scratch / "a.nrrd", c);
  }
}

TEST(Orientation, NiftiMatrix) {
  const test::Scratch scratch;
  for (const Case& c : kCases) {
    std::string header(352, '\0');
    const auto set = [&header](std::size_t at, const std::string& value) {
      header.replace(at, value.size(), value);
    };
    set(0, raw(std::int32_t{348}));
    const std::array<std::int16_t, 8> size{3, 2, 3, 4, 1, 1, 1, 1};
    for (std::size_t i = 0; i < 8; ++i) set(40 + 2 * i, raw(size[i]));
    set(70, raw(std::int16_t{2}) + raw(std::int16_t{8}));
    set(76, raw(1.0f));
    for (std::size_t a = 0; a < 3; ++a) set(80 + 4 * a, raw(static_cast<float>(norm(c.steps[a]))));
    set(108, raw(352.0f));
    set(254, raw(std::int16_t{1}));
    for (int row = 0; row < 3; ++row) {
      std::string text;
      for (std::size_t a = 0; a < 3; ++a) text += raw(static_cast<float>(c.steps[a][row]));
      set(280 + 16 * static_cast<std::size_t>(row), text + raw(static_cast<float>(kOrigin[row])));
    }
    set(344, std::string("n+1\0", 4));
    put_bytes(scratch / "a.nii", header + voxels());
    expect_read(scratch / "a.nii", c);
  }
}

TEST(Orientation, MetaImage) {
  const test::Scratch scratch;
  for (const Case& c : kCases) {
    std::string header =
        "ObjectType = Image\nNDims = 3\nBinaryData = True\nDimSize = 2 3 4\nTransformMatrix =";
    std::string spacing;
    for (const Vec3& step : c.steps) {
      header += " " + join((1 / norm(step)) * step, " ");
      spacing += fmt::format(" {}", norm(step));
    }
    header += "\nOffset = " + join(kOrigin, " ") + "\nElementSpacing =" + spacing;
    put_bytes(scratch / "a.mha", header + "\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n" + voxels());
    expect_read(scratch / "a.mha", c);
  }
}

TEST(Orientation, VtkImage) {
  const test::Scratch scratch;
  for (const Case& c : kCases) {
    std::string direction, spacing, values;
    for (int row = 0; row < 3; ++row) {
      for (const Vec3& step : c.steps) direction += fmt::format("{} ", step[row] / norm(step));
      spacing += fmt::format("{} ", norm(c.steps[static_cast<std::size_t>(row)]));
    }
    for (int v = 0; v < 24; ++v) values += fmt::format("{} ", v);
    put_bytes(
        scratch / "a.vti",
        fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\">\n"
                    "<ImageData WholeExtent=\"0 1 0 2 0 3\" Origin=\"{}\" Spacing=\"{}\" Direction=\"{}\">\n"
                    "<Piece Extent=\"0 1 0 2 0 3\"><PointData>\n"
                    "<DataArray type=\"Int32\" Name=\"v\" format=\"ascii\">{}</DataArray>\n"
                    "</PointData></Piece></ImageData></VTKFile>\n",
                    join(kOrigin, " "), spacing, direction, values));
    expect_read(scratch / "a.vti", c);
  }
}

TEST(Orientation, CellsAndVectorsMoveWithTheirAxes) {
  const test::Scratch scratch;
  put_bytes(
      scratch / "a.vti",
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\">\n"
      "<ImageData WholeExtent=\"0 2 0 1 0 1\" Origin=\"5 0 0\" Spacing=\"1 1 1\" "
      "Direction=\"0 -1 0 1 0 0 0 0 1\">\n<Piece Extent=\"0 2 0 1 0 1\"><CellData>\n"
      "<DataArray type=\"Int32\" Name=\"v\" NumberOfComponents=\"2\" format=\"ascii\">1 2 3 4</DataArray>\n"
      "</CellData></Piece></ImageData></VTKFile>\n");
  const GridFile file = read_grid_file(scratch / "a.vti");
  EXPECT_EQ(file.nodes[0], (std::vector<double>{4, 5}));
  EXPECT_EQ(file.nodes[1], (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(file.arrays.at(0).values),
            (std::vector<std::int32_t>{1, 2, 3, 4}));
}

TEST(Orientation, NegativeSpacingsCountBackwards) {
  const test::Scratch scratch;
  put_bytes(
      scratch / "a.nrrd",
      "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 3 4\nencoding: raw\nspacings: 1 -1 1\naxis mins: 0 7 "
      "0\n\n" +
          voxels());
  expect_places(read_grid_file(scratch / "a.nrrd"), {{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}}, {0, 7, 0});
}

TEST(Orientation, APlaneImageMayStandUpright) {
  const test::Scratch scratch;
  put_bytes(scratch / "a.nrrd",
            "NRRD0004\ntype: uint8\ndimension: 2\nsizes: 2 2\nencoding: raw\nspace dimension: 3\n"
            "space directions: (0,0,1) (0,2,0)\nspace origin: (1,2,3)\n\nabcd");
  const GridFile file = read_grid_file(scratch / "a.nrrd");
  EXPECT_EQ(file.nodes, (std::array<std::vector<double>, 3>{{{1}, {2, 4}, {3, 4}}}));
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(file.arrays.at(0).values),
            (std::vector<std::int32_t>{'a', 'c', 'b', 'd'}));
}

}  // namespace
}  // namespace adamas
