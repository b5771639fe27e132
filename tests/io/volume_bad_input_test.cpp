// Tests volumes that cannot be read: one line says what was expected and what was found.

#include <cmath>

#include "core/io/volume_reader.h"
#include "tests/io/volume_samples.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::put_bytes;
using test::says;

/// Opens the file and reads every plane.
std::string message_of(const std::filesystem::path& path, const std::string& array = {}) {
  return error_of([&] {
    VolumeReader reader = open_volume(path, {array, {}});
    std::vector<std::byte> plane(reader.grid().plane_bytes());
    for (std::uint64_t k = 0; k < reader.grid().dimensions[2]; ++k) reader.read_plane(k, plane);
  });
}

TEST(VolumeBadInput, EveryTruncationIsAnError) {
  const VolumeGrid grid{{3, 2, 2}, SampleType::kUint16, {1, 1, 1}, {}};
  const auto samples = test::random_samples(grid);
  for (const std::string name : {"a.vti", "b.nrrd", "c.nhdr", "d.mha", "e.mhd"}) {
    const test::Scratch scratch;
    test::write_volume(scratch / name, grid, samples);
    const std::string file = name == "c.nhdr" ? "c.raw" : name == "e.mhd" ? "e.raw" : name;
    const std::string whole = test::bytes_of(scratch / file);
    // The closing tags of a .vti say nothing about its samples.
    const std::size_t end = name == "a.vti" ? whole.find("\n  </AppendedData>") : whole.size();
    for (std::size_t length = 0; length < end; ++length) {
      put_bytes(scratch / file, whole.substr(0, length));
      const std::string message = message_of(scratch / name);
      EXPECT_TRUE(says(message, "expected")) << name << " " << length;
      EXPECT_TRUE(says(message, scratch.folder().string())) << name << " " << length;
    }
  }
}

TEST(VolumeBadInput, SizesOfRawFiles) {
  const test::Scratch scratch;
  put_bytes(scratch / "a.raw", std::string(24, 'x'));
  RawVolume raw;
  const auto message = [&] { return error_of([&] { open_raw_volume(scratch / "a.raw", raw); }); };
  raw.dimensions = {2, 3, 5};
  EXPECT_TRUE(says(message(), "a.raw: expected 30 bytes for 2 x 3 x 5 samples of uint8, found 24"));
  raw.dimensions = {2, 3, 3};
  EXPECT_TRUE(says(message(), "a.raw: expected 18 bytes for 2 x 3 x 3 samples of uint8, found 24"));
  raw.header_bytes = 7;
  EXPECT_TRUE(says(message(), "18 bytes for 2 x 3 x 3 samples of uint8 after 7 others, found 17"));
  for (const std::uint64_t skip : {std::uint64_t{25}, std::uint64_t{1} << 63, ~std::uint64_t{0}}) {
    raw.header_bytes = skip;
    EXPECT_TRUE(says(message(), "expected 18 bytes")) << skip;
  }
  raw.header_bytes = 0;
  for (const std::uint64_t n : {std::uint64_t{0}, std::uint64_t{1} << 62, ~std::uint64_t{0}}) {
    raw.dimensions = {2, n, 3};
    EXPECT_TRUE(says(message(), "a.raw: expected at least one sample along each axis")) << n;
  }
  raw.dimensions = {1 << 20, 1 << 20, 1 << 19};
  raw.type = StoredType::kFloat64;
  EXPECT_TRUE(says(message(), "expected 4611686018427387904 bytes"));
  raw.dimensions = {1, 1, 3};
  for (const double step : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    raw.spacing = {1, 1, step};
    EXPECT_TRUE(says(message(), "a.raw: expected a positive spacing along z")) << step;
  }
  raw.spacing = {1, 1, 1};
  raw.origin.x = std::nan("");
  EXPECT_TRUE(says(message(), "a.raw: expected a finite origin along x"));
}

TEST(VolumeBadInput, FilesThatAreMissingOrUnknown) {
  const test::Scratch scratch;
  put_bytes(scratch / "a.raw", "x");
  put_bytes(scratch / "a.nhdr", "NRRD0004\ntype: uchar\nencoding: raw\nsizes: 1 1 1\ndata file: none.raw\n");
  EXPECT_TRUE(says(message_of(scratch / "a.raw"), "expected a volume (.vti, "));
  EXPECT_TRUE(says(message_of(scratch / "b.vti"), "expected a file, found none"));
  EXPECT_TRUE(says(message_of(scratch / "a.nhdr"), "none.raw: expected a file, found none"));
}

TEST(VolumeBadInput, NrrdOfOtherKinds) {
  const test::Scratch scratch;
  const auto message = [&](const std::string& fields) {
    put_bytes(scratch / "a.nrrd", "NRRD0004\ntype: uchar\n" + fields + "\n\n12345678");
    return message_of(scratch / "a.nrrd");
  };
  EXPECT_TRUE(says(message("sizes: 2 2 2\nencoding: gzip"), "expected whole compressed data"));
  EXPECT_TRUE(says(message("sizes: 2 2 2\nencoding: text"), "expected 8 numbers, found 0"));
  EXPECT_TRUE(says(message("sizes: 2 2 2\nencoding: hex"), "raw, gzip, bzip2 or text, found 'hex'"));
  EXPECT_TRUE(says(message("sizes: 2 2 2 1\nkinds: vector domain domain domain\nencoding: raw"),
                   "expected one value per sample, found 2"));
  EXPECT_TRUE(
      says(message("sizes: 2 2 3\nencoding: raw"), "expected 12 bytes for 2 x 2 x 3 samples of uint8"));
  EXPECT_TRUE(
      says(message("sizes: 2 2 2\nencoding: raw\nline skip: 3"), "expected 3 lines to skip, found 0"));
  EXPECT_TRUE(says(message("sizes: 4611686018427387904 1 1\nencoding: raw"), "expected positive sizes"));
}

TEST(VolumeBadInput, MetaImagesOfOtherKinds) {
  const test::Scratch scratch;
  const auto message = [&](const std::string& fields) {
    const std::string start = "DimSize = 2 2 2\nElementType = MET_UCHAR\n";
    put_bytes(scratch / "a.mha", start + fields + "\nElementDataFile = LOCAL\n12345678");
    return message_of(scratch / "a.mha");
  };
  EXPECT_TRUE(says(message("CompressedData = True"), "expected whole compressed data"));
  EXPECT_TRUE(says(message("BinaryData = False"), "expected 8 numbers, found 0"));
  EXPECT_TRUE(says(message("CompressedData = True\nBinaryData = False"), "where they are compressed"));
  EXPECT_TRUE(says(message("BinaryData = False\nHeaderSize = -1"), "HeaderSize: expected a number"));
  EXPECT_TRUE(says(message("ElementNumberOfChannels = 3"), "expected one value per sample, found 3"));
  EXPECT_TRUE(says(message("ElementType = MET_LONG"), "ElementType: expected a type of numbers"));
  EXPECT_TRUE(says(message("NDims = 2"), "NDims: expected 3 as there are sizes in DimSize, found '2'"));
  for (const char* sizes : {"2 2 2 2", "2 -1 2", "a b c", ""}) {
    EXPECT_TRUE(says(message(std::string("DimSize = ") + sizes), "DimSize: expected one to three sizes"))
        << sizes;
  }
  for (const char* sizes : {"2 0 2", "4611686018427387904 4 4"}) {
    EXPECT_TRUE(says(message(std::string("DimSize = ") + sizes), "expected at least one sample")) << sizes;
  }
  for (const char* spacing : {"nan 1 1", "-1 1 1", "0 1 1", "inf 1 1"}) {
    EXPECT_TRUE(
        says(message(std::string("ElementSpacing = ") + spacing), "expected a positive spacing along x"));
  }
  EXPECT_TRUE(says(message("ElementSpacing = 1 1"), "ElementSpacing: expected 3 numbers, found '1 1'"));
  EXPECT_TRUE(says(message("Offset = 0 inf 0"), "expected a finite origin along y"));
  EXPECT_TRUE(says(message("HeaderSize = -2"), "HeaderSize: expected a number of bytes"));
  EXPECT_TRUE(
      says(message("TransformMatrix = 0 1 0 0 1 0 0 0 1"), "expected axes that are not in one plane"));
  put_bytes(scratch / "b.mhd", "DimSize = 2 2\nElementType = MET_UCHAR\nElementDataFile = s%d.raw 0 1 1\n");
  EXPECT_TRUE(says(message_of(scratch / "b.mhd"), "s0.raw: expected a file, found none"));
}

std::string vti_text(const std::string& from = {}, const std::string& to = {}) {
  std::string text =
      "<VTKFile type=\"ImageData\" byte_order=\"LittleEndian\" header_type=\"UInt64\">"
      "<ImageData WholeExtent=\"0 1 0 1 0 0\" Origin=\"0 0 0\" Spacing=\"1 1 1\"><Piece Extent=\"0 1 0 1 0 "
      "0\">"
      "<PointData><DataArray type=\"UInt8\" Name=\"v\" format=\"appended\" offset=\"0\"/></PointData>"
      "</Piece></ImageData><AppendedData encoding=\"raw\">_";
  for (std::size_t at = 0; !from.empty() && (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text + std::string("\4\0\0\0\0\0\0\0wxyz", 12) + "</AppendedData></VTKFile>";
}

TEST(VolumeBadInput, VtiOfOtherKinds) {
  const test::Scratch scratch;
  const auto message = [&](const std::string& from, const std::string& to, const std::string& array = {}) {
    put_bytes(scratch / "a.vti", vti_text(from, to));
    return message_of(scratch / "a.vti", array);
  };
  put_bytes(scratch / "good.vti", vti_text());
  EXPECT_EQ(open_volume(scratch / "good.vti", {"v", {}}).grid().samples(), 4u);
  EXPECT_TRUE(says(message("type=\"ImageData\"", "type=\"PolyData\""), "VTKFile type: expected ImageData"));
  for (const char* name : {"vtkLZ4DataCompressor", "vtkLZMADataCompressor"}) {
    EXPECT_TRUE(says(message("LittleEndian\"", fmt::format("LittleEndian\" compressor=\"{}\"", name)),
                     fmt::format("compressor: expected vtkZLibDataCompressor or none, found '{}'", name)));
  }
  EXPECT_TRUE(says(message("LittleEndian", "Middle"), "byte_order: expected LittleEndian or BigEndian"));
  EXPECT_TRUE(says(message("UInt64", "UInt128"), "header_type: expected UInt32 or UInt64"));
  EXPECT_TRUE(
      says(message("Extent=\"0 1 0 1 0 0\"", "Extent=\"0 1 0 1\""), "WholeExtent: expected 6 numbers"));
  EXPECT_TRUE(says(message("Extent=\"0 1 0 1 0 0\"", "Extent=\"0 -1 0 1 0 0\""), "with x0 <= x1"));
  EXPECT_TRUE(
      says(message("Extent=\"0 1 0 1 0 0\"", "Extent=\"0 4611686018427387904 0 1 0 0\""), "WholeExtent"));
  EXPECT_TRUE(says(message("Extent=\"0 1 0 1 0 0\"", "Extent=\"0 1000000000000 0 1000000000000 0 0\""),
                   "at most 2^59 in all"));
  EXPECT_TRUE(says(message("Piece Extent=\"0 1", "Piece Extent=\"0 0"), "one piece of the whole extent"));
  for (const char* step : {"nan", "-1", "0"}) {
    EXPECT_TRUE(says(message("Spacing=\"1", std::string("Spacing=\"") + step), "positive spacing along x"));
  }
  EXPECT_TRUE(
      says(message("PointData>", "CellData>"), "expected an array on points, found values on cells alone"));
  EXPECT_TRUE(says(message("\"v\"", "\"w\"", "v"), "expected an array 'v' on points, found 'w'"));
  EXPECT_TRUE(says(message("<DataArray ", "<DataArray Name='u'/><DataArray "),
                   "expected one array on points or the name of one, found 'u', 'v'"));
  EXPECT_TRUE(says(message("UInt8", "Bit"), "DataArray type: expected a type of numbers, found 'Bit'"));
  EXPECT_TRUE(says(message("Name=", "NumberOfComponents=\"3\" Name="), "expected one value per sample"));
  EXPECT_TRUE(says(message("\"appended\"", "\"bits\""), "expected appended, binary or ascii, found 'bits'"));
  EXPECT_TRUE(says(message("\"appended\"", "\"ascii\""), "expected values of the array 'v', found none"));
  EXPECT_TRUE(says(message("offset=\"0\"", "offset=\"-1\""), "offset: expected 1 numbers"));
  EXPECT_TRUE(says(message("offset=\"0\"", "offset=\"18446744073709551615\""), "expected 4 bytes"));
  EXPECT_TRUE(says(message("offset=\"0\"", "offset=\"1\""), "expected an array of 4 bytes, found one of"));
  EXPECT_TRUE(says(message("\"raw\"", "\"hex\""), "encoding: expected raw or base64, found 'hex'"));
  EXPECT_TRUE(says(message("\"raw\"", "\"base64\""), "expected base64 text, found a character of code 4"));
  EXPECT_TRUE(says(message(">_", ">"), "expected '_' before the appended data"));
  EXPECT_TRUE(says(message("<ImageData", "<Other"), "line 1: expected well-formed XML, found an error"));
  EXPECT_TRUE(says(message("Name=\"v\"", "Name"), "line 1: expected well-formed XML, found an error"));
}

}  // namespace
}  // namespace adamas
