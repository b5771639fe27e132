// Tests headers that promise more than a file can hold, or contradict themselves. Each leads to an error of
// one line before any of it is believed, whatever libraries make of it meanwhile.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <string>

#include "core/io/grid_file.h"
#include "core/io/multi_material_reader.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::put_bytes;
using test::says;

struct Header {
  std::string whole = "0 4 0 3 0 2", piece = whole, more_pieces = "", offset = "0", spacing = "1 1 1";
  std::string compressor = "";
};

std::string numbers(std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += std::to_string(i % 2) + " ";
  return text;
}

/// Returns a file of 4 x 3 x 2 cells with labels as appended data.
std::string image(const Header& h) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt32\"" +
      h.compressor + ">\n<ImageData WholeExtent=\"" + h.whole + "\" Origin=\"0 0 0\" Spacing=\"" + h.spacing +
      "\">\n<Piece Extent=\"" + h.piece +
      "\">\n<CellData><DataArray type=\"UInt8\" Name=\"m\" format=\"appended\" offset=\"" + h.offset +
      "\"/></CellData>\n</Piece>" + h.more_pieces + "</ImageData>\n<AppendedData encoding=\"raw\">\n_";
  text += std::string("\x18\0\0\0", 4);
  for (int i = 0; i < 24; ++i) text += static_cast<char>(i % 2);
  return text + "\n</AppendedData>\n</VTKFile>\n";
}

/// Returns a file of a rectilinear grid with the same labels as text.
std::string rectilinear(const std::string& whole, const std::string& piece,
                        const std::string& x = "0 1 2 3 4") {
  const auto axis = [](const std::string& name, const std::string& values) {
    return "<DataArray type=\"Float64\" Name=\"" + name + "\" format=\"ascii\">" + values + "</DataArray>";
  };
  return "<VTKFile type=\"RectilinearGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n<RectilinearGrid "
         "WholeExtent=\"" +
         whole + "\">\n<Piece Extent=\"" + piece +
         "\">\n<CellData><DataArray type=\"Int32\" Name=\"m\" format=\"ascii\">" + numbers(24) +
         "</DataArray></CellData>\n<Coordinates>" + axis("x", x) + axis("y", "0 1 2 3") + axis("z", "0 1 2") +
         "</Coordinates></Piece></RectilinearGrid></VTKFile>\n";
}

/// Returns the peak memory of the child process that needed most.
long children_kibibytes() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return usage.ru_maxrss;
}

class HeaderLimits : public testing::Test {
 protected:
  [[nodiscard]] std::string message(const std::string& name, const std::string& bytes) const {
    put_bytes(scratch / name, bytes);
    MaterialDataOptions options;
    options.labels = "m";
    std::string text = error_of([&] { read_multi_material_data(scratch / name, options); });
    EXPECT_TRUE(says(text, name)) << text;
    return text;
  }
  void expect_read(const std::string& name, const std::string& bytes) const {
    put_bytes(scratch / name, bytes);
    MaterialDataOptions options;
    options.labels = "m";
    EXPECT_EQ(read_multi_material_data(scratch / name, options).labels.size(), 24u);
  }
  test::Scratch scratch;
};

TEST_F(HeaderLimits, WholeOnesAreRead) {
  expect_read("a.vti", image({}));
  expect_read("a.vtr", rectilinear("0 4 0 3 0 2", "0 4 0 3 0 2"));
  expect_read("a.vti", image({.whole = "-2 2 5 8 0 2", .piece = "-2 2 5 8 0 2"}));
}

TEST_F(HeaderLimits, PiecesMakeUpTheWhole) {
  for (const std::string piece : {"0 3 0 3 0 2", "1 4 0 3 0 2", "0 4 0 2 0 2", "0 4 0 3 0 0"}) {
    EXPECT_TRUE(says(message("a.vti", image({.piece = piece})), "pieces that make up the WholeExtent"));
    EXPECT_TRUE(says(message("a.vtr", rectilinear("0 4 0 3 0 2", piece)), "make up the WholeExtent"));
  }
  for (const std::string piece : {"0 5 0 3 0 2", "-1 4 0 3 0 2", "0 4 0 3 0 2000000000"}) {
    EXPECT_TRUE(says(message("a.vti", image({.piece = piece})), "within the WholeExtent"));
    EXPECT_TRUE(says(message("a.vtr", rectilinear("0 4 0 3 0 2", piece)), "within the WholeExtent"));
  }
  for (const std::string extent : {"0 4 0 3 0", "4 0 0 3 0 2", "0 4 0 3 0 x", "", "0 4 0 3 0 2147483648"}) {
    EXPECT_TRUE(says(message("a.vti", image({.whole = extent, .piece = "0 4 0 3 0 2"})), "WholeExtent"));
    EXPECT_TRUE(says(message("a.vti", image({.piece = extent})), "Extent"));
  }
  const std::string twice = "<Piece Extent=\"0 4 0 3 0 2\"></Piece>";
  EXPECT_TRUE(says(message("a.vti", image({.more_pieces = twice})), "make up the WholeExtent of 24 cells"));
}

TEST_F(HeaderLimits, OffsetsLieInTheFile) {
  for (const std::string offset : {"-1", "x", "", "1 2", "99999999", "18446744073709551615", "1e3"})
    EXPECT_TRUE(
        says(message("a.vti", image({.offset = offset})), "array 'm': expected an offset into the file"));
}

/// The files are refused with little memory; a reader that believed them would need gigabytes.
TEST_F(HeaderLimits, ExtentsAreOfWhatAFileCanHold) {
  const long before = children_kibibytes();
  const std::string zlib = " compressor=\"vtkZLibDataCompressor\"";
  for (const std::string extent : {"0 2147483647 0 0 0 0", "-2147483647 2147483647 0 3 0 2",
                                   "0 2000 0 2000 0 2000", "0 50000 0 50000 0 1"}) {
    EXPECT_TRUE(says(message("a.vti", image({.whole = extent, .piece = extent})), "values of each array"));
    EXPECT_TRUE(says(message("a.vti", image({.whole = extent, .piece = extent, .compressor = zlib})),
                     "values of each array"));
    EXPECT_TRUE(says(message("a.vtr", rectilinear(extent, extent)), "values of each array"));
  }
  const std::string legacy = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS ";
  for (const std::string size : {"2147483647 1 1", "5 4 0", "5 4", "-5 4 3", "x 4 3", "99999999999 4 3"}) {
    EXPECT_TRUE(says(message("a.vtk", legacy + size +
                                          "\nORIGIN 0 0 0\nSPACING 1 1 1\nCELL_DATA 24\nSCALARS m int\n"
                                          "LOOKUP_TABLE default\n" +
                                          numbers(24) + "\n"),
                     "DIMENSIONS"));
  }
  for (const std::string size : {"inf 3 2", "4 3", "4 3 2 1", "4 3 x"}) {
    EXPECT_TRUE(says(message("a.mha", "ObjectType = Image\nNDims = 3\nDimSize = " + size +
                                          "\nElementType = MET_UCHAR\nElementDataFile = LOCAL\nabcd"),
                     "DimSize"));
  }
  for (const std::string axes : {"1e100", "0", "-1", "11", "3 3", "x"}) {
    EXPECT_TRUE(says(message("a.mha", "ObjectType = Image\nNDims = " + axes +
                                          "\nDimSize = 4 3 2\nElementType = MET_UCHAR\n"
                                          "ElementDataFile = LOCAL\nabcd"),
                     "NDims"));
  }
  EXPECT_LE(children_kibibytes(), std::max(before, 1l << 20));
}

/// Nothing can be computed with such lengths.
TEST_F(HeaderLimits, CoordinatesAreOfSizesThatCanBe) {
  for (const std::string spacing : {"1e100 1 1", "1 1e51 1", "1 1 1e308", "1e-150 1 1", "1 4e-320 1"})
    EXPECT_TRUE(says(message("a.vti", image({.spacing = spacing})), "expected coordinates below 1e+50"));
  for (const std::string x : {"0 1 2 3 1e100", "-1e60 1 2 3 4", "0 1e-150 2e-150 3e-150 1", "0 1e-310 1 2 3"})
    EXPECT_TRUE(says(message("a.vtr", rectilinear("0 4 0 3 0 2", "0 4 0 3 0 2", x)), "coordinates below"));
  expect_read("a.vti", image({.spacing = "1e40 1e-40 1"}));
}

}  // namespace
}  // namespace adamas
