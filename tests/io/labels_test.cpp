// Tests that labels of every integer type and format are the numbers of the file, to the last of 64 bits.

#include <limits>
#include <map>

#include "core/io/multi_material_reader.h"
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

constexpr StoredType kWholeTypes[] = {StoredType::kInt8,   StoredType::kUint8, StoredType::kInt16,
                                      StoredType::kUint16, StoredType::kInt32, StoredType::kUint32,
                                      StoredType::kInt64,  StoredType::kUint64};

/// Returns six ascending labels, some of which no floating-point type distinguishes.
template <class T>
std::vector<T> labels_of() {
  using Limits = std::numeric_limits<T>;
  return {Limits::min(), 1, 2, Limits::max() / 2 + 1, Limits::max() - 1, Limits::max()};
}

std::string numbers_text(const auto& values) {
  std::string text;
  for (const auto value : values) text += std::to_string(value) + "\n";
  return text;
}

/// Writes the labels of 3 x 2 x 1 samples in every format that has such types. Returns the names of the
/// files.
template <class T>
std::vector<std::string> write_files(const test::Scratch& scratch, StoredType type,
                                     const std::vector<T>& labels) {
  const std::string raw = bytes_of_values(labels), text = numbers_text(labels);
  const auto name = [type](TypeNames names) { return std::string(stored_name(type, names)); };
  const auto nrrd = [&](const char* encoding) {
    return "NRRD0004\ntype: " + name(TypeNames::kOwn) +
           "\ndimension: 3\nsizes: 3 2 1\nendian: little\nencoding: " + encoding + "\n\n";
  };
  put_bytes(scratch / "raw.nrrd", nrrd("raw") + raw);
  put_bytes(scratch / "text.nrrd", nrrd("text") + text);
  put_bytes(scratch / "a.mha", "ObjectType = Image\nNDims = 3\nDimSize = 3 2 1\nElementType = " +
                                   name(TypeNames::kMetaImage) + "\nElementDataFile = LOCAL\n" + raw);
  const std::map<StoredType, std::int16_t> codes{{StoredType::kInt8, 256},   {StoredType::kUint8, 2},
                                                 {StoredType::kInt16, 4},    {StoredType::kUint16, 512},
                                                 {StoredType::kInt32, 8},    {StoredType::kUint32, 768},
                                                 {StoredType::kInt64, 1024}, {StoredType::kUint64, 1280}};
  NiftiHeader header;
  header.put<std::int16_t>(40, {3, 3, 2, 1, 1, 1, 1, 1}).type(codes.at(type), sizeof(T));
  put_bytes(scratch / "a.nii", header.text() + raw);
  const std::string array = "<DataArray type=\"" + name(TypeNames::kVtk) + "\" Name=\"a\" format=\"ascii\">" +
                            text + "</DataArray>";
  const std::string begin =
      "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\"><ImageData WholeExtent=\"0 3 0 2 0 1\" Origin=\"0 0 0\" "
      "Spacing=\"1 1 1\"><Piece Extent=\"0 3 0 2 0 1\"><CellData>";
  put_bytes(scratch / "a.vti", begin + array + "</CellData></Piece></ImageData></VTKFile>");
  const auto axis = [](int last) {
    std::string values;
    for (int i = 0; i <= last; ++i) values += std::to_string(i) + " ";
    return "<DataArray type=\"Float64\" format=\"ascii\">" + values + "</DataArray>";
  };
  put_bytes(scratch / "a.vtr",
            "<VTKFile type=\"RectilinearGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><RectilinearGrid "
            "WholeExtent=\"0 3 0 2 0 1\"><Piece Extent=\"0 3 0 2 0 1\"><CellData>" +
                array + "</CellData><Coordinates>" + axis(3) + axis(2) + axis(1) +
                "</Coordinates></Piece></RectilinearGrid></VTKFile>");
  test::Hdf5File(scratch / "a.h5").add("a", {1, 2, 3}, type, labels.data());
  put_bytes(scratch / "a.tif", test::tiff_of(labels, false));
  put_bytes(scratch / "big.tif", test::tiff_of(labels, true));
  return {"raw.nrrd", "text.nrrd", "a.mha", "a.nii", "a.vti", "a.vtr", "a.h5", "a.tif", "big.tif"};
}

TEST(Labels, AreExactInEveryTypeAndFormat) {
  for (const StoredType type : kWholeTypes) {
    visit_stored_type(type, [type]<class T>(T) {
      if constexpr (std::is_integral_v<T>) {
        const std::vector<T> labels = labels_of<T>();
        std::vector<std::string> names;
        for (const T label : labels) names.push_back(std::to_string(label));
        const test::Scratch scratch;
        for (const std::string& file : write_files(scratch, type, labels)) {
          MaterialDataOptions options;
          options.labels = file;
          const MultiMaterialData data = read_multi_material_data(scratch / file, options);
          EXPECT_EQ(std::vector<std::string>(data.materials.begin(), data.materials.end()), names)
              << file << " " << stored_name(type);
          EXPECT_TRUE(data.labels == SiteArray<std::uint16_t>({0, 1, 2, 3, 4, 5})) << file;
        }
      }
    });
  }
}

TEST(Labels, OfSegmentationsOfSlicerHaveTheirNames) {
  const test::Scratch scratch;
  put_bytes(scratch / "brain.seg.nrrd",
            "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 1 2\nencoding: raw\nSegment0_ID:=Segment_1\n"
            "Segment0_LabelValue:=4\nSegment0_Name:=grey matter\nSegment0_Layer:=0\nSegment1_Name:=vessel\n"
            "Segment1_LabelValue:=1\n\n" +
                std::string("\0\1\4\4\7\0", 6));
  MaterialDataOptions options;
  const MultiMaterialData data = read_multi_material_data(scratch / "brain.seg.nrrd", options);
  EXPECT_EQ(std::vector<std::string>(data.materials.begin(), data.materials.end()),
            (std::vector<std::string>{"background", "vessel", "grey matter", "7"}));
  EXPECT_TRUE(data.labels == SiteArray<std::uint16_t>({0, 1, 2, 2, 3, 0}));
  // Names that are given come before those of the file.
  options.labels = "labels";
  options.label_names = {{7, "stem"}, {1, "artery"}};
  const MultiMaterialData named = read_multi_material_data(scratch / "brain.seg.nrrd", options);
  EXPECT_EQ(std::vector<std::string>(named.materials.begin(), named.materials.end()),
            (std::vector<std::string>{"background", "artery", "grey matter", "stem"}));
}

TEST(Labels, OfAStackOfPicturesAreExact) {
  const test::Scratch scratch;
  // tiff_of() makes pictures of 3 x 2 pixels.
  for (const int plane : {2, 10}) {
    const auto base = static_cast<std::uint32_t>(1000 * plane);
    put_bytes(scratch / fmt::format("l{}.tif", plane),
              test::tiff_of(std::vector<std::uint32_t>{base, base + 1, 7, 7, 4000000000u, base}, false));
  }
  MaterialDataOptions options;
  options.labels = "l";
  options.stack_spacing = Vec3{0.5, 1, 2};
  options.stack_origin = Vec3{10, 20, 30};
  const MultiMaterialData data = read_multi_material_data(scratch / "l*.tif", options);
  EXPECT_EQ(std::vector<std::string>(data.materials.begin(), data.materials.end()),
            (std::vector<std::string>{"7", "2000", "2001", "10000", "10001", "4000000000"}));
  EXPECT_TRUE(data.labels == SiteArray<std::uint16_t>({1, 2, 0, 0, 5, 1, 3, 4, 0, 0, 5, 3}));
  EXPECT_EQ(data.grid.nodes[2], (std::vector<double>{29, 31, 33}));
  EXPECT_EQ(data.grid.nodes[0], (std::vector<double>{9.75, 10.25, 10.75, 11.25}));
  put_bytes(scratch / "l3.tif", test::tiff_of(std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6}, false));
  EXPECT_TRUE(test::says(test::error_of([&] { read_multi_material_data(scratch / "l*.tif", options); }),
                         "expected 3 x 2 samples of uint32"));
  EXPECT_TRUE(test::says(test::error_of([&] { read_multi_material_data(scratch / "none*.tif", options); }),
                         "none*.tif"));
}

/// The materials of a file and the notes about it.
struct Told {
  std::vector<std::string> names, notes;
};

Told read_labels(const std::filesystem::path& path) {
  Told told;
  MaterialDataOptions options;
  options.labels = path.string();
  options.centering = Centering::kCells;
  options.note = [&told](const std::string& text) { told.notes.push_back(text); };
  const MultiMaterialData data = read_multi_material_data(path, options);
  told.names.assign(data.materials.begin(), data.materials.end());
  return told;
}

TEST(Labels, OfDoubleAreExactToo) {
  const test::Scratch scratch;
  const auto write = [&scratch](const std::vector<double>& values) {
    put_bytes(scratch / "a.nrrd",
              "NRRD0004\ntype: double\ndimension: 3\nsizes: 3 1 1\nendian: little\nencoding: raw\n\n" +
                  bytes_of_values(values));
  };
  write({-16777217, 16777217, 9007199254740991});
  EXPECT_EQ(read_labels(scratch / "a.nrrd").names,
            (std::vector<std::string>{"-16777217", "16777217", "9007199254740991"}));
  write({16777217, 0.5, 1});
  EXPECT_TRUE(says(error_of([&] { read_labels(scratch / "a.nrrd"); }),
                   "labels 'a': expected whole numbers, found 0.5 at index 1"));
}

/// Writes three labels of int16 with a scale.
void write_scaled(const std::filesystem::path& path, std::vector<std::int16_t> stored, float slope,
                  float intercept) {
  NiftiHeader header;
  header.put<std::int16_t>(40, {3, 3, 1, 1, 1, 1, 1, 1}).type(4, 2).put<float>(112, {slope, intercept});
  put_bytes(path, header.text() + bytes_of_values(stored));
}

TEST(Labels, WithAScaleAreValuesWhereTheseAreWhole) {
  const test::Scratch scratch;
  write_scaled(scratch / "a.nii", {-1, 0, 4}, 2, 1);
  const Told whole = read_labels(scratch / "a.nii");
  EXPECT_EQ(whole.names, (std::vector<std::string>{"-1", "1", "9"}));
  EXPECT_TRUE(whole.notes.empty());
  write_scaled(scratch / "a.nii", {10, 20, 40}, 0.1f, 0);
  EXPECT_EQ(read_labels(scratch / "a.nii").names, (std::vector<std::string>{"1", "2", "4"}));
}

TEST(Labels, WithAScaleAreTheStoredNumbersElsewhere) {
  const test::Scratch scratch;
  write_scaled(scratch / "a.nii", {1, 2, 10}, 0.1f, 0);
  const Told told = read_labels(scratch / "a.nii");
  EXPECT_EQ(told.names, (std::vector<std::string>{"1", "2", "10"}));
  ASSERT_EQ(told.notes.size(), 1u);
  EXPECT_TRUE(says(told.notes[0], "labels 'a' are taken as they are stored"));
}

/// Labels with more digits than a float has are neither rounded nor merged.
TEST(Labels, WithAScaleAreNotMerged) {
  const test::Scratch scratch;
  const auto names = [&](std::int32_t first, float slope, float intercept) {
    NiftiHeader header;
    header.put<std::int16_t>(40, {3, 4, 1, 1, 1, 1, 1, 1}).type(8, 4).put<float>(112, {slope, intercept});
    std::vector<std::int32_t> stored;
    for (std::int32_t i = 0; i < 4; ++i) stored.push_back(first + i);
    put_bytes(scratch / "a.nii", header.text() + bytes_of_values(stored));
    return read_labels(scratch / "a.nii").names;
  };
  EXPECT_EQ(names(33554432, 0.5f, 0),
            (std::vector<std::string>{"33554432", "33554433", "33554434", "33554435"}));
  EXPECT_EQ(names(1 << 30, 2, 1),
            (std::vector<std::string>{"2147483649", "2147483651", "2147483653", "2147483655"}));
}

TEST(Fields, WithAScaleHaveItsValues) {
  const test::Scratch scratch;
  write_scaled(scratch / "a.nii", {1, 2, 10}, 0.5f, 3);
  MaterialDataOptions options;
  options.plain = true;
  options.centering = Centering::kCells;
  const MultiMaterialData data = read_multi_material_data(scratch / "a.nii", options);
  EXPECT_EQ(data.fields.at(0).values, (std::vector<float>{3.5f, 4, 8}));
  NiftiHeader header;
  header.put<std::int16_t>(40, {3, 3, 1, 1, 1, 1, 1, 1}).type(64, 8).put<float>(112, {1, -16777216});
  put_bytes(scratch / "d.nii", header.text() + bytes_of_values(std::vector<double>{16777217, 0.5, 0}));
  EXPECT_EQ(read_multi_material_data(scratch / "d.nii", options).fields.at(0).values,
            (std::vector<double>{1, -16777215.5, -16777216}));
}

}  // namespace
}  // namespace adamas
