#include "core/io/grid_file.h"
#include "core/io/nrrd_header.h"
#include "tests/io/volume_files.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::put_bytes;
using test::says;

const std::string kStart = "NRRD0004\ntype: uchar\nencoding: raw\n";

TEST(NrrdHeader, AxesOfSpaceAndComponents) {
  const NrrdHeader plain =
      parse_nrrd_header(kStart + "sizes: 2 3 4\nspacings: 1 nan 0.5\naxis mins: 7 8 9\n\nx", "n");
  EXPECT_EQ(plain.components, 1u) << "a short first axis is one of space";
  EXPECT_EQ(plain.sizes, (std::array<std::size_t, 3>{2, 3, 4}));
  EXPECT_EQ(plain.axes.directions, (std::array<Vec3, 3>{{{1, 0, 0}, {0, 1, 0}, {0, 0, 0.5}}}));
  EXPECT_EQ(plain.axes.origin, (Vec3{7, 8, 9}));

  const NrrdHeader vectors = parse_nrrd_header(kStart +
                                                   "dimension: 4\nsizes: 3 5 6 7\nspace directions: none "
                                                   "(2,0,0) (0,3,0) (0,0,4)\nspace origin: (1,2,-3)\n\nx",
                                               "n");
  EXPECT_EQ(vectors.components, 3u);
  EXPECT_EQ(vectors.sizes, (std::array<std::size_t, 3>{5, 6, 7}));
  EXPECT_EQ(vectors.axes.directions, (std::array<Vec3, 3>{{{2, 0, 0}, {0, 3, 0}, {0, 0, 4}}}));
  EXPECT_EQ(vectors.axes.origin, (Vec3{1, 2, -3}));

  const NrrdHeader turned = parse_nrrd_header(
      kStart + "sizes: 5 6 7\nspace directions: (-2,0,0) (0,3,4) (0,-4,3)\nspace origin: (1,2,-3)\n\nx", "n");
  EXPECT_EQ(turned.axes.directions, (std::array<Vec3, 3>{{{-2, 0, 0}, {0, 3, 4}, {0, -4, 3}}}));
  EXPECT_EQ(turned.axes.origin, (Vec3{1, 2, -3}));
}

TEST(NrrdHeader, AllSpellingsOfTypes) {
  const std::vector<std::pair<std::string_view, std::vector<const char*>>> spellings{
      {"int8", {"signed char", "int8", "int8_t"}},
      {"uint8", {"uchar", "unsigned char", "uint8", "uint8_t"}},
      {"int16", {"short", "short int", "signed short", "signed short int", "int16", "int16_t"}},
      {"uint16", {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}},
      {"int32", {"int", "signed int", "int32", "int32_t"}},
      {"uint32", {"uint", "unsigned int", "uint32", "uint32_t"}},
      {"int64",
       {"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64",
        "int64_t"}},
      {"uint64", {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"}},
      {"float32", {"float"}},
      {"float64", {"double"}}};
  for (const auto& [type, names] : spellings) {
    for (const char* name : names) {
      const std::string text = "NRRD0004\ntype: " + std::string(name) + "\nencoding: raw\nsizes: 1 1 1\n\nx";
      EXPECT_EQ(stored_name(*parse_nrrd_header(text, "n").type), type) << name;
    }
  }
}

TEST(NrrdHeader, BadHeadersAreNamedWithTheirLine) {
  const auto message = [](const std::string& text) {
    return error_of([&] { parse_nrrd_header(text, "n.nrrd"); });
  };
  EXPECT_EQ(message("BMP"), "n.nrrd: expected NRRD, found something else");
  EXPECT_TRUE(
      says(message("NRRD0004\ntype: block\n"), "n.nrrd: line 2: expected a type of numbers, found 'block'"));
  EXPECT_TRUE(says(message(kStart + "sizes: 3 0 2\n\nx"), "line 4: expected positive sizes"));
  EXPECT_TRUE(says(message(kStart + "sizes: 3 -1 2\n\nx"), "line 4: expected positive sizes"));
  EXPECT_TRUE(says(message(kStart + "sizes: 99999999 99999999 99\n\nx"), "line 4: expected positive sizes"));
  EXPECT_TRUE(says(message(kStart + "dimension: 3\nsizes: 4 4\n\nx"), "expected 3 sizes, found 2"));
  EXPECT_TRUE(says(message(kStart + "sizes: 4 4 4\n"), "found the file's end"));
  EXPECT_TRUE(says(message(kStart + "\nx"), "expected a header with sizes"));
  EXPECT_TRUE(says(message(kStart + "data file: LIST\n"), "expected one data file"));
  EXPECT_TRUE(says(message("NRRD0004\ntype: float\nencoding: hex\n"),
                   "encoding raw, gzip, bzip2 or text, found 'hex'"));
}

TEST(NrrdReader, EncodingsByteOrdersAndDetachedData) {
  const test::Scratch scratch;
  const std::string head = "NRRD0004\ndimension: 3\nsizes: 2 1 2\n";
  put_bytes(scratch / "t.nrrd", head + "type: float\nencoding: text\n\n1 2.5\n-3 1e3\n");
  EXPECT_EQ(read_grid_file(scratch / "t.nrrd").arrays.at(0).take_floats(),
            (std::vector<float>{1, 2.5f, -3, 1000}));
  put_bytes(scratch / "cut.nrrd", head + "type: float\nencoding: text\n\n1 2.5\n-3 1e3");
  EXPECT_TRUE(says(error_of([&] { read_grid_file(scratch / "cut.nrrd"); }), "expected 4 numbers, found 3"));
  const auto bzip = [&](const std::string& more) {
    put_bytes(scratch / "z.nrrd", head + "type: uchar\nencoding: bzip2\n\n" + test::bzipped("abcd") + more);
    return std::get<1>(read_grid_file(scratch / "z.nrrd").arrays.at(0).values);
  };
  EXPECT_EQ(bzip(""), (std::vector<std::int32_t>{'a', 'b', 'c', 'd'}));
  EXPECT_EQ(bzip("more"), (std::vector<std::int32_t>{'a', 'b', 'c', 'd'}));
  EXPECT_TRUE(says(error_of([&] { bzip("BZh9broken"); }), "z.nrrd: expected whole data compressed by bzip2"));
  put_bytes(scratch / "b.nhdr",
            head + "type: uint16\nencoding: raw\nendian: big\nbyte skip: -1\ndata file: b.raw\n");
  EXPECT_TRUE(
      says(error_of([&] { read_grid_file(scratch / "b.nhdr"); }), "b.raw: expected a file, found none"));
  put_bytes(scratch / "b.raw", std::string("....\0\1\1\0\0\2\2\0", 12));
  EXPECT_EQ(std::get<1>(read_grid_file(scratch / "b.nhdr").arrays.at(0).values),
            (std::vector<std::int32_t>{1, 256, 2, 512}));
}

}  // namespace
}  // namespace adamas
