// Tests volume fractions of several materials in one array, and those in files of bare samples.

#include "core/io/multi_material_reader.h"
#include "core/io/volume_reader.h"
#include "tests/io/volume_files.h"
#include "tests/support/hdf5_file.h"

namespace adamas {

using namespace io;

namespace {

using test::bytes_of_values;
using test::error_of;
using test::NiftiHeader;
using test::put_bytes;
using test::says;

/// Returns the fraction of material `m` of three at one of 3 x 2 x 2 sites, x fastest.
float part(std::size_t site, std::size_t m) {
  const auto first = static_cast<float>(site) / 16;
  return m == 0 ? first : m == 1 ? 0.25f : 0.75f - first;
}

/// Returns all fractions, either material by material or site by site.
std::vector<float> parts(bool planar) {
  std::vector<float> values;
  for (std::size_t a = 0; a < (planar ? 3 : 12); ++a) {
    for (std::size_t b = 0; b < (planar ? 12 : 3); ++b) values.push_back(planar ? part(b, a) : part(a, b));
  }
  return values;
}

using Names = std::vector<std::string>;

void expect_parts(const MultiMaterialData& data, const Names& names) {
  EXPECT_EQ(Names(data.materials.begin(), data.materials.end()), names) << data.source;
  ASSERT_EQ(data.fractions.size(), 3u) << data.source;
  for (std::size_t m = 0; m < 3; ++m) {
    for (std::size_t site = 0; site < 12; ++site)
      EXPECT_EQ(data.fraction(MaterialId(m), site), part(site, m)) << data.source << m << " " << site;
  }
}

MultiMaterialData read(const std::filesystem::path& path, const std::string& array, const Names& names = {}) {
  MaterialDataOptions options;
  options.fraction_array = array;
  options.fraction_names = names;
  return read_multi_material_data(path, options);
}

std::string nrrd(const std::string& sizes, const std::string& kinds, bool planar) {
  return "NRRD0004\ntype: float\ndimension: 4\nsizes: " + sizes + kinds +
         "\nendian: little\nencoding: raw\n\n" + bytes_of_values(parts(planar));
}

TEST(FractionArray, OfNiftiIsAMaterialForEachOfItsTimes) {
  const test::Scratch scratch;
  for (const bool packed : {false, true}) {
    NiftiHeader header;
    header.put<std::int16_t>(40, {4, 3, 2, 2, 3, 1, 1, 1}).type(16, 4);
    const std::string bytes = header.text() + bytes_of_values(parts(true)),
                      name = packed ? "t.nii.gz" : "t.nii";
    put_bytes(scratch / name, packed ? test::deflated(bytes, test::Wrapping::kGzip) : bytes);
    const std::string path = (scratch / name).string();
    expect_parts(read(path, path), {"t_1", "t_2", "t_3"});
    expect_parts(read(path, path, {"csf", "grey", "white"}), {"csf", "grey", "white"});
    EXPECT_TRUE(says(error_of([&] {
                       read(path, path, {"csf", "grey"});
                     }),
                     "--fractions: expected names of 3 materials, found 2"));
  }
}

TEST(FractionArray, OfNrrdMayHaveItsComponentsFirstOrLast) {
  const test::Scratch scratch;
  const auto expect = [&](const std::string& text) {
    put_bytes(scratch / "t.nrrd", text);
    expect_parts(read(scratch / "t.nrrd", "t"), {"t_1", "t_2", "t_3"});
  };
  expect(nrrd("3 3 2 2", "\nkinds: vector domain domain domain", false));
  expect(nrrd("3 3 2 2", "", false));
  expect(nrrd("3 2 2 3", "\nkinds: domain domain domain list", true));
  expect(nrrd("3 2 2 3", "\nspace: RAS\nspace directions: (1,0,0) (0,1,0) (0,0,1) none", true));
}

std::string vti(const std::string& name, const std::string& component_names) {
  std::string text;
  for (const float value : parts(false)) text += std::to_string(value) + " ";
  return "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\"><ImageData "
         "WholeExtent=\"0 3 0 2 0 2\" Origin=\"0 0 0\" Spacing=\"1 1 1\"><Piece Extent=\"0 3 0 2 0 "
         "2\"><CellData>"
         "<DataArray type=\"Float32\" Name=\"" +
         name + "\" NumberOfComponents=\"3\" " + component_names + " format=\"ascii\">" + text +
         "</DataArray></CellData></Piece></ImageData></VTKFile>";
}

TEST(FractionArray, OfVtkHasTheNamesOfItsComponents) {
  const test::Scratch scratch;
  put_bytes(scratch / "t.vti", vti("parts", ""));
  expect_parts(read(scratch / "t.vti", "parts"), {"parts_1", "parts_2", "parts_3"});
  put_bytes(scratch / "t.vti", vti("parts", R"(ComponentName0="a" ComponentName1="b" ComponentName2="c")"));
  expect_parts(read(scratch / "t.vti", "parts"), {"a", "b", "c"});
  put_bytes(scratch / "t.vti", vti("Volume Fraction of it", ""));
  expect_parts(read_multi_material_data(scratch / "t.vti"), {"it_1", "it_2", "it_3"});
  put_bytes(scratch / "t.vti", vti("parts", ""));
  EXPECT_TRUE(says(error_of([&] { read_multi_material_data(scratch / "t.vti"); }),
                   "pass --fractions parts if the 3 components of 'parts' are the fractions of materials"));
}

/// The step between stored numbers is known for arrays that were found by their names and for those found by
/// components. It is unknown where the arrays are of several kinds.
TEST(FractionArray, TellsTheStepOfWhatIsStored) {
  const test::Scratch scratch;
  const auto write = [&](const char* second) {
    std::string text =
        "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 2 0 1 0 1\"><Piece Extent=\"0 2 0 1 0 1\">"
        "<CellData>";
    text += "<DataArray type=\"UInt8\" Name=\"Volume Fraction for a\" format=\"ascii\">255 254</DataArray>";
    text += std::string("<DataArray type=\"") + second +
            "\" Name=\"Volume Fraction for b\" format=\"ascii\">0 1</DataArray>";
    put_bytes(scratch / "s.vti", text + "</CellData></Piece></ImageData></VTKFile>");
    MaterialDataOptions options;
    options.fraction_scale = 255;
    return read_multi_material_data(scratch / "s.vti", options).report.step;
  };
  EXPECT_EQ(write("UInt8"), 1 / 255.0);
  EXPECT_EQ(write("Float32"), 0);
}

TEST(FractionArray, OfHdf5HasItsComponentsAlongTheShorterEnd) {
  const test::Scratch scratch;
  const std::vector<float> first = parts(true), last = parts(false), field(12, 7);
  {
    test::Hdf5File file(scratch / "t.h5");
    // The grid has 3 x 2 x 2 samples, as many along x as there are materials.
    file.add("first", {3, 2, 2, 3}, StoredType::kFloat32, first.data());
    file.add("field", {2, 2, 3}, StoredType::kFloat32, field.data());
  }
  const MultiMaterialData data = read(scratch / "t.h5", "first");
  expect_parts(data, {"first_1", "first_2", "first_3"});
  EXPECT_EQ(data.fields.at(0).name, "field");
  // Materials are along the last axis; there are 1 x 2 x 6 samples, z slowest.
  test::Hdf5File(scratch / "l.h5").add("last", {6, 2, 1, 3}, StoredType::kFloat32, last.data());
  expect_parts(read(scratch / "l.h5", "last"), {"last_1", "last_2", "last_3"});
  {
    test::Hdf5File file(scratch / "u.h5");
    file.add("a", {2, 2, 3}, StoredType::kFloat32, field.data());
    file.add("b", {3, 2, 2}, StoredType::kFloat32, field.data());
  }
  EXPECT_TRUE(says(error_of([&] { read(scratch / "u.h5", "a"); }),
                   "expected data sets on one grid, found 'a' of 3 x 2 x 2 and 'b' of 2 x 2 x 3"));
}

TEST(RawFractions, AreThoseOfAGridOfTheirSize) {
  const test::Scratch scratch;
  for (std::size_t m = 0; m < 3; ++m) {
    std::vector<float> values;
    for (std::size_t site = 0; site < 12; ++site) values.push_back(part(site, m));
    put_bytes(scratch / (std::to_string(m) + ".raw"), "head" + bytes_of_values(values, true));
  }
  MaterialDataOptions options;
  options.fractions = {{"a", "0.raw"}, {"b", "1.raw"}};
  options.rest = "c";
  RawVolume raw;
  raw.dimensions = {3, 2, 2};
  raw.type = StoredType::kFloat32;
  raw.big_endian = true;
  raw.header_bytes = 4;
  raw.spacing = {0.5, 2, 3};
  raw.origin = {1, 1, 1};
  const auto read_raw = [&](const std::string& name) {
    return read_multi_material_data(scratch / name, options, SilentProgress::instance(), raw);
  };
  const MultiMaterialData data = read_raw("0.raw");
  expect_parts(data, {"a", "b", "c"});
  EXPECT_EQ(data.grid.nodes[0], (std::vector<double>{0.75, 1.25, 1.75, 2.25}));
  EXPECT_EQ(data.grid.nodes[2], (std::vector<double>{-0.5, 2.5, 5.5}));
  raw.header_bytes = 0;
  EXPECT_TRUE(says(error_of([&] { read_raw("0.raw"); }), "0.raw: expected 48 bytes for 3 x 2 x 2 samples"));
  EXPECT_TRUE(says(error_of([&] { read_multi_material_data(scratch / "0.raw", options); }),
                   "or bare samples (--dimensions, --type)"));
  put_bytes(scratch / "t.nrrd", nrrd("3 3 2 2", "", false));
  options = {};
  options.fraction_array = "t";
  EXPECT_TRUE(says(error_of([&] { read_raw("t.nrrd"); }), "--dimensions: expected a raw file, found none"));
}

}  // namespace
}  // namespace adamas
