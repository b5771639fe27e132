// Tests arrays whose number of values differs from the number of their grid's places: none is cut to it.

#include <fmt/format.h>

#include <limits>

#include "core/io/grid_file.h"
#include "core/io/input_file.h"
#include "core/io/unstructured_mesh_io.h"
#include "tests/io/volume_files.h"
#include "tests/io/vtk_xml_text.h"

namespace adamas {

using namespace io;

namespace {

using test::bytes_of_values;
using test::error_of;
using test::message_of_volume;
using test::put_bytes;
using test::says;
using test::xml_array;
using test::XmlForm;

constexpr XmlForm kForms[] = {XmlForm::kText, XmlForm::kBase64, XmlForm::kZlib};

std::vector<float> ascending(std::size_t count) {
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<float>(i % 97));
  return values;
}

/// Expects both counts in the message, as values or as the bytes that they take.
void expect_counts(const std::string& message, std::size_t expected, std::size_t found) {
  const auto has = [&](std::size_t count) {
    return message.find(fmt::format("{}", count)) != std::string::npos ||
           message.find(fmt::format("{}", 4 * count)) != std::string::npos;
  };
  EXPECT_TRUE(has(expected) && has(found)) << expected << " " << found << ": " << message;
}

TEST(ValueCounts, OfGridsOfVtk) {
  const test::Scratch scratch;
  for (const char* name : {"a.vti", "a.vtr"}) {
    for (const XmlForm form : kForms) {
      for (const Centering centering : {Centering::kCells, Centering::kPoints}) {
        const std::size_t good = centering == Centering::kCells ? 5 * 4 * 3 : 6 * 5 * 4;
        const auto write = [&](std::size_t count) {
          put_bytes(scratch / name, test::xml_grid(name, {6, 5, 4}, centering, ascending(count), form));
        };
        write(good);
        GridFile grid = read_grid_file(scratch / name);
        EXPECT_EQ(grid.arrays.at(0).take_floats(), ascending(good)) << name;
        for (const std::size_t count : {good + 1, good + 61, good - 1}) {
          write(count);
          expect_counts(error_of([&] { read_grid_file(scratch / name); }), good, count);
          if (centering == Centering::kPoints) expect_counts(message_of_volume(scratch / name), good, count);
        }
      }
    }
  }
}

/// VTK reads arrays with other compressions; their size precedes them.
TEST(ValueCounts, OfWhatVtkReads) {
  const test::Scratch scratch;
  for (const char* name : {"a.vti", "a.vtr"}) {
    std::string text = test::xml_grid(name, {6, 5, 4}, Centering::kPoints, ascending(121), XmlForm::kZlib);
    text.replace(text.find("vtkZLib"), 7, "vtkLZ4");
    put_bytes(scratch / name, text);
    EXPECT_TRUE(says(error_of([&] { read_grid_file(scratch / name); }),
                     fmt::format("{}: array 'v': expected 120 values, found 121", name)));
  }
}

TEST(ValueCounts, OfMeshes) {
  const test::Scratch scratch;
  const auto message = [&](std::size_t of_points, std::size_t of_cells, std::size_t coordinates,
                           XmlForm form) {
    const std::string content = "<PointData>" + xml_array("p", ascending(of_points), form) +
                                "</PointData><CellData>" + xml_array("c", ascending(of_cells), form) +
                                "</CellData><Points>" + xml_array("x", ascending(coordinates), form, 3) +
                                "</Points><Cells>" +
                                xml_array("connectivity", std::vector<std::int32_t>{0, 1, 2, 3}, form) +
                                xml_array("offsets", std::vector<std::int32_t>{4}, form) +
                                xml_array("types", std::vector<std::uint8_t>{10}, form) + "</Cells>";
    put_bytes(scratch / "a.vtu", test::xml_file("UnstructuredGrid", "",
                                                "NumberOfPoints=\"4\" NumberOfCells=\"1\"", content, form));
    return error_of([&] { read_unstructured_mesh(scratch / "a.vtu"); });
  };
  for (const XmlForm form : kForms) {
    EXPECT_TRUE(says(message(9, 1, 12, form), "array 'p': expected 4 values, found 9"));
    EXPECT_TRUE(says(message(3, 1, 12, form), "array 'p': expected 4 values, found 3"));
    EXPECT_TRUE(says(message(4, 2, 12, form), "array 'c': expected 1 values, found 2"));
    EXPECT_TRUE(says(message(4, 1, 15, form), "array 'x': expected 4 x 3 values, found 15"));
  }
  // Tags within an array, and between arrays, do not count as sections.
  std::string text;
  for (const char* part : {"<DataArray ", "<PointData>"}) {
    message(9, 1, 12, XmlForm::kText);
    text = read_file(scratch / "a.vtu");
    const std::size_t at = text.find('>', text.find(part)) + 1;
    text.insert(at, std::string(part) == "<PointData>"
                        ? "<Array type=\"String\" Name=\"s\" format=\"ascii\" NumberOfTuples=\"0\"></Array>"
                        : "<InformationKey name=\"k\" location=\"l\"></InformationKey>");
    put_bytes(scratch / "a.vtu", text);
    EXPECT_TRUE(says(error_of([&] { read_unstructured_mesh(scratch / "a.vtu"); }),
                     "array 'p': expected 4 values, found 9"))
        << part;
  }
}

TEST(ValueCounts, OfLegacyFiles) {
  const test::Scratch scratch;
  for (const char* form : {"BINARY", "ASCII"}) {
    for (const auto& [keyword, good] : {std::pair{"POINT_DATA", 120}, std::pair{"CELL_DATA", 60}}) {
      for (const int count : {good, good + 5, good - 5}) {
        std::string values;
        for (int i = 0; i < count; ++i)
          values += *form == 'A' ? fmt::format("{}\n", i) : bytes_of_values(std::vector<float>{1}, true);
        put_bytes(
            scratch / "a.vtk",
            fmt::format("# vtk DataFile Version 3.0\nt\n{}\nDATASET STRUCTURED_POINTS\nDIMENSIONS 6 5 4\n"
                        "SPACING 1 1 1\nORIGIN 0 0 0\n{} {}\nSCALARS s float\nLOOKUP_TABLE default\n{}\n",
                        form, keyword, count, values));
        if (count == good) {
          EXPECT_EQ(read_grid_file(scratch / "a.vtk").arrays.at(0).size(), static_cast<std::size_t>(good));
        } else {
          EXPECT_TRUE(says(
              error_of([&] { read_grid_file(scratch / "a.vtk"); }),
              fmt::format("{}: expected {} values for 6 x 5 x 4 points, found {}", keyword, good, count)));
        }
      }
    }
  }
}

TEST(ValueCounts, OfNrrdAndMetaImage) {
  const test::Scratch scratch;
  const std::string samples(12, 'x'), more(5, 'y'), text = "1 2 3 4 5 6 7 8 9 10 11 12 ";
  const auto nrrd = [&](const std::string& encoding, const std::string& data) {
    put_bytes(scratch / "a.nrrd",
              "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 2\nencoding: " + encoding + "\n\n" + data);
    return message_of_volume(scratch / "a.nrrd");
  };
  const std::string bytes = "expected 12 bytes for 3 x 2 x 2 samples of uint8, found 17";
  EXPECT_TRUE(says(nrrd("raw", samples + more), "samples of uint8 after 62 others, found 17"));
  EXPECT_TRUE(says(nrrd("gzip", test::deflated(samples + more, test::Wrapping::kGzip)), bytes + " or more"));
  EXPECT_TRUE(says(nrrd("bzip2", test::bzipped(samples + more)), bytes + " or more"));
  for (const char* end : {"13 14\n", "13 14"})
    EXPECT_TRUE(says(nrrd("text", text + end), "expected 12 numbers, found 14"));
  const auto meta = [&](const std::string& fields, const std::string& data) {
    put_bytes(scratch / "a.mha", "NDims = 3\nDimSize = 3 2 2\nElementType = MET_UCHAR\n" + fields +
                                     "ElementDataFile = LOCAL\n" + data);
    return message_of_volume(scratch / "a.mha");
  };
  EXPECT_TRUE(says(meta("", samples + more), "samples of uint8 after 74 others, found 17"));
  EXPECT_TRUE(says(meta("CompressedData = True\n", test::deflated(samples + more, test::Wrapping::kZlib)),
                   bytes + " or more"));
  EXPECT_TRUE(says(meta("BinaryData = False\n", text + "13 14\n"), "expected 12 numbers, found 14"));
  // Where there are several files each has its part; surplus bytes of one do not belong to the next.
  put_bytes(scratch / "b.mhd", "DimSize = 3 2 2\nElementType = MET_UCHAR\nElementDataFile = s%d.raw 0 1 1\n");
  put_bytes(scratch / "s0.raw", std::string(7, 'x'));
  put_bytes(scratch / "s1.raw", std::string(5, 'x'));
  EXPECT_TRUE(says(message_of_volume(scratch / "b.mhd"), "expected 6 bytes, as in each of 2 files, found 7"));
}

/// In a text array any value may be NaN or infinite, or may be missing.
TEST(TextArrays, AreReadAlikeInBothGrids) {
  const test::Scratch scratch;
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (const std::size_t place : {0u, 7u, 119u}) {
    for (const float special : {nan, inf, -inf}) {
      std::vector<float> values = ascending(120);
      values[place] = special;
      std::vector<std::vector<float>> read;
      for (const char* name : {"a.vti", "a.vtr"}) {
        put_bytes(scratch / name,
                  test::xml_grid(name, {6, 5, 4}, Centering::kPoints, values, XmlForm::kText));
        read.push_back(read_grid_file(scratch / name).arrays.at(0).take_floats());
      }
      EXPECT_EQ(bytes_of_values(read[0]), bytes_of_values(values));
      EXPECT_EQ(bytes_of_values(read[1]), bytes_of_values(values));
    }
  }
  const std::string whole =
      test::xml_grid("a.vtr", {6, 5, 4}, Centering::kPoints, ascending(120), XmlForm::kText);
  for (std::size_t length = whole.find("<Piece"); length < whole.find("</Piece"); length += 11) {
    put_bytes(scratch / "a.vtr", whole.substr(0, length));
    EXPECT_TRUE(says(error_of([&] { read_grid_file(scratch / "a.vtr"); }), "a.vtr: ")) << length;
  }
}

}  // namespace
}  // namespace adamas
