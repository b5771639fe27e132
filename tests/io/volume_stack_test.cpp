// Tests stacks of pictures as volumes: TIFF and PNG files, and the patterns of their names.

#include "core/io/volume_stack.h"

#include <png.h>
#include <tiffio.h>

#include "tests/io/volume_files.h"

namespace adamas {

using namespace io;

namespace {

using test::bytes_of_values;
using test::error_of;
using test::put_bytes;
using test::read_numbers;
using test::says;
using test::tiff_of;

/// Writes a TIFF of several pages by libtiff.
void write_pages(const std::filesystem::path& path, const std::vector<std::vector<std::uint16_t>>& pages,
                 std::uint16_t compression) {
  TIFF* file = TIFFOpen(path.c_str(), "w");
  ASSERT_NE(file, nullptr);
  for (const auto& page : pages) {
    TIFFSetField(file, TIFFTAG_IMAGEWIDTH, 3);
    TIFFSetField(file, TIFFTAG_IMAGELENGTH, 2);
    TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, 16);
    TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(file, TIFFTAG_COMPRESSION, compression);
    TIFFSetField(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    for (std::uint32_t y = 0; y < 2; ++y) {
      std::vector<std::uint16_t> row(page.begin() + 3 * y, page.begin() + 3 * y + 3);
      TIFFWriteScanline(file, row.data(), y);
    }
    TIFFWriteDirectory(file);
  }
  TIFFClose(file);
}

/// Returns a PNG of 3 x 2 gray samples, or of another kind; `rows` are the bytes of its rows.
std::string png_of(const std::string& rows, unsigned bits, unsigned color = 0) {
  const auto chunk = [](const std::string& kind, const std::string& data) {
    const std::string body = kind + data;
    const auto sum = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())));
    return bytes_of_values(std::vector<std::uint32_t>{static_cast<std::uint32_t>(data.size())}, true) + body +
           bytes_of_values(std::vector<std::uint32_t>{sum}, true);
  };
  std::string head = bytes_of_values(std::vector<std::uint32_t>{3, 2}, true);
  head += static_cast<char>(bits);
  head += static_cast<char>(color);
  head += std::string(3, '\0');
  const std::size_t half = rows.size() / 2;
  const std::string filtered =
      std::string(1, '\0') + rows.substr(0, half) + std::string(1, '\0') + rows.substr(half);
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", head) +
         chunk("IDAT", test::deflated(filtered, test::Wrapping::kZlib)) + chunk("IEND", "");
}

template <class T>
void expect_tiff_planes() {
  const test::Scratch scratch;
  const auto values = test::typical_values<T>();
  const std::vector<T> first(values.begin(), values.begin() + 6), second(values.begin() + 6, values.end());
  for (const bool big : {false, true}) {
    put_bytes(scratch / "2.tif", tiff_of(first, big));
    put_bytes(scratch / "10.tif", tiff_of(second, big));
    VolumeReader reader = open_volume_stack(match_stack(scratch / "*.tif"), {1, 2, 3}, {4, 5, 6});
    EXPECT_EQ(reader.grid().dimensions, (std::array<std::uint64_t, 3>{3, 2, 2}));
    EXPECT_EQ(reader.grid().spacing, (Vec3{1, 2, 3}));
    EXPECT_EQ(reader.grid().origin, (Vec3{4, 5, 6}));
    EXPECT_EQ(read_numbers(reader), test::as_doubles(values)) << big;
  }
}

TEST(VolumeStack, TiffOfEveryType) {
  expect_tiff_planes<std::uint8_t>();
  expect_tiff_planes<std::int8_t>();
  expect_tiff_planes<std::uint16_t>();
  expect_tiff_planes<std::int16_t>();
  expect_tiff_planes<std::uint32_t>();
  expect_tiff_planes<std::int32_t>();
  expect_tiff_planes<float>();
}

TEST(VolumeStack, PagesOfOneTiffInEveryCompression) {
  const test::Scratch scratch;
  for (const std::uint16_t compression :
       {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_PACKBITS, COMPRESSION_ADOBE_DEFLATE}) {
    write_pages(scratch / "a.tif", {{1, 2, 3, 4, 5, 6}, {7, 8, 9, 10, 11, 65535}}, compression);
    VolumeReader reader = open_volume(scratch / "a.tif");
    EXPECT_EQ(test::read_as<std::uint16_t>(reader),
              (std::vector<std::uint16_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 65535}))
        << compression;
  }
  std::filesystem::copy_file(scratch / "a.tif", scratch / "b");
  EXPECT_EQ(open_volume(scratch / "b").grid().dimensions[2], 2u) << "known by its first bytes";
  EXPECT_TRUE(says(error_of([&] {
                     open_volume_stack({scratch / "a.tif", scratch / "a.tif"});
                   }),
                   "a.tif: expected one page, found 2"));
}

TEST(VolumeStack, Png) {
  const test::Scratch scratch;
  put_bytes(scratch / "a01.png", png_of("abcdef", 8));
  put_bytes(scratch / "a02.png", png_of("ghijkl", 8));
  VolumeReader bytes = open_volume_stack(match_stack(scratch / "a##.png"));
  EXPECT_EQ(test::read_as<char>(bytes),
            (std::vector<char>{'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h', 'i', 'j', 'k', 'l'}));
  put_bytes(scratch / "b.png",
            png_of(bytes_of_values(std::vector<std::uint16_t>{1, 256, 65535, 4, 5, 6}, true), 16));
  VolumeReader words = open_volume(scratch / "b.png");
  EXPECT_EQ(test::read_as<std::uint16_t>(words), (std::vector<std::uint16_t>{1, 256, 65535, 4, 5, 6}));
  put_bytes(scratch / "c.png", png_of(std::string(18, 'x'), 8, 2));
  EXPECT_TRUE(says(error_of([&] { open_volume(scratch / "c.png"); }),
                   "c.png: expected gray samples of 8 or 16 bits, found colours of 8 bits"));
  put_bytes(scratch / "d.png", png_of("ab", 4));
  EXPECT_TRUE(says(error_of([&] { open_volume(scratch / "d.png"); }), "found gray ones of 4 bits"));
}

TEST(VolumeStack, PicturesThatDiffer) {
  const test::Scratch scratch;
  put_bytes(scratch / "1.tif", tiff_of(std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6}, false));
  put_bytes(scratch / "2.tif", tiff_of(std::vector<std::uint16_t>{1, 2, 3, 4, 5, 6}, false));
  put_bytes(scratch / "3.png", png_of("abcdef", 8));
  put_bytes(scratch / "4.txt", "text");
  EXPECT_TRUE(says(error_of([&] {
                     open_volume_stack({scratch / "1.tif", scratch / "2.tif"});
                   }),
                   "2.tif: expected 3 x 2 samples of uint8 as in"));
  EXPECT_EQ(open_volume_stack({scratch / "1.tif", scratch / "3.png"}).grid().dimensions[2], 2u);
  EXPECT_TRUE(says(error_of([&] {
                     open_volume_stack({scratch / "1.tif", scratch / "4.txt"});
                   }),
                   "4.txt: expected"));
  EXPECT_TRUE(says(error_of([&] {
                     open_volume_stack({scratch / "1.tif", scratch / "5.tif"});
                   }),
                   "5.tif: expected a file, found none"));
  EXPECT_TRUE(says(error_of([&] { open_volume_stack({}); }), "expected the pictures of a stack, found none"));
}

TEST(VolumeStack, TruncationIsAnError) {
  const test::Scratch scratch;
  const std::string tiff = tiff_of(std::vector<std::uint16_t>{1, 2, 3, 4, 5, 6}, true);
  put_bytes(scratch / "a.tif", tiff);
  // libtiff can do without the last bytes, which say that there is no further page.
  test::expect_every_truncation_is_an_error(scratch / "a.tif", scratch / "a.tif", tiff.size() - 4, 3);
  const std::string png = png_of("abcdef", 8);
  put_bytes(scratch / "a.png", png);
  test::expect_every_truncation_is_an_error(scratch / "a.png", scratch / "a.png", png.size(), 3);
}

std::vector<std::string> names_of(const std::vector<std::filesystem::path>& paths) {
  std::vector<std::string> names;
  for (const auto& path : paths) names.push_back(path.filename().string());
  return names;
}

TEST(MatchStack, Patterns) {
  const test::Scratch scratch;
  for (const char* name : {"a8.tif", "a9.tif", "a10.tif", "a010.tif", "a.tif", "b9998.tif", "b9999.tif",
                           "b10000.tif", "b010000.tif", "b998.tif", "a9.tiff"}) {
    put_bytes(scratch / name, "x");
  }
  std::filesystem::create_directory(scratch / "a11.tif");
  using Names = std::vector<std::string>;
  const auto match = [&](const std::string& pattern) { return names_of(match_stack(scratch / pattern)); };
  EXPECT_EQ(match("a*.tif"), (Names{"a.tif", "a8.tif", "a9.tif", "a010.tif", "a10.tif"}));
  EXPECT_EQ(match("a?.tif"), (Names{"a8.tif", "a9.tif"}));
  EXPECT_EQ(match("a%d.tif"), (Names{"a8.tif", "a9.tif", "a10.tif"}));
  EXPECT_EQ(match("a#.tif"), (Names{"a8.tif", "a9.tif", "a10.tif"}));
  EXPECT_EQ(match("b%04d.tif"), (Names{"b9998.tif", "b9999.tif", "b10000.tif"}));
  EXPECT_EQ(match("b####.tif"), match("b%04d.tif"));
  EXPECT_EQ(match("*9.tif*"), (Names{"a9.tif", "a9.tiff", "b9999.tif"}));
  EXPECT_EQ(match_stack(scratch / "a?.tif").front(), scratch / "a8.tif");
  EXPECT_TRUE(
      says(error_of([&] { match("c*.tif"); }), "c*.tif: expected files with names such as 'c*.tif' in '"));
  EXPECT_TRUE(
      says(error_of([&] { match("c%03d_#.tif"); }), "expected files with names such as 'c001_1.tif' in '"));
  EXPECT_TRUE(says(error_of([&] { match("a8.tif"); }), "a8.tif: expected a pattern with *, ?, # or %d"));
  EXPECT_TRUE(says(error_of([&] { match("100%.tif"); }), "expected a pattern with"));
  for (const std::string wide :
       {"%21d", "%2147483647d", "%99999999999999999999999d", "#####################"})
    EXPECT_TRUE(says(error_of([&] { match(wide + ".tif"); }), "expected numbers of at most 20 digits"))
        << wide;
  EXPECT_TRUE(says(error_of([&] { match_stack(scratch / "none" / "*.tif"); }),
                   "none: expected a folder that can be read"));
}

TEST(MatchStack, NumbersWithGaps) {
  const test::Scratch scratch;
  const std::string huge(30, '9');
  for (const char* name : {"img_1.tif", "img_2.tif", "img_4.tif", "img_6.tif", "b0099.png", "b0101.png",
                           "c9_1.tif", "c9_3.tif", "d1_1", "d1_3", "8", "9", "11"}) {
    put_bytes(scratch / name, "x");
  }
  put_bytes(scratch / ("e" + huge), "x");
  put_bytes(scratch / ("e1" + std::string(29, '0') + "1"), "x");
  const auto error = [&](const std::string& pattern) {
    return error_of([&] { match_stack(scratch / pattern); });
  };
  const auto missing = [&](const std::string& name) { return (scratch / name).string() + ": expected"; };
  EXPECT_TRUE(says(error("img_%d.tif"),
                   missing("img_3.tif") + " this file between img_2.tif and img_4.tif, found none"));
  EXPECT_TRUE(says(error("img_#.tif"), missing("img_3.tif")));
  EXPECT_TRUE(says(error("b%04d.png"), missing("b0100.png")));
  EXPECT_TRUE(says(error("c9_%d.tif"), missing("c9_2.tif")));
  EXPECT_TRUE(says(error("%d"), missing("10")));
  EXPECT_TRUE(says(error("e%d"), missing("e1" + std::string(30, '0'))));
  // With these patterns the numbers of files are not certain, so gaps are allowed.
  EXPECT_EQ(match_stack(scratch / "img_*.tif").size(), 4u);
  EXPECT_EQ(match_stack(scratch / "img_?.tif").size(), 4u);
  EXPECT_EQ(match_stack(scratch / "d%d_%d").size(), 2u);
  put_bytes(scratch / "img_3.tif", "x");
  EXPECT_TRUE(says(error("img_%d.tif"), missing("img_5.tif")));
  put_bytes(scratch / "img_5.tif", "x");
  EXPECT_EQ(match_stack(scratch / "img_%d.tif").size(), 6u);
}

TEST(MatchStack, NaturalOrder) {
  const std::vector<std::string> ordered{"",
                                         "1",
                                         "01",
                                         "2",
                                         "a",
                                         "a0",
                                         "a1",
                                         "a1b",
                                         "a01b2",
                                         "a1b10",
                                         "a99999999999999999999998",
                                         "a99999999999999999999999",
                                         "b"};
  for (std::size_t i = 0; i < ordered.size(); ++i) {
    for (std::size_t j = 0; j < ordered.size(); ++j) {
      if (i == 1 || j == 1) continue;
      EXPECT_EQ(natural_less(ordered[i], ordered[j]), i < j) << ordered[i] << " " << ordered[j];
    }
  }
  EXPECT_NE(natural_less("1", "01"), natural_less("01", "1"));
}

TEST(VolumeStack, NamesOfNumbers) {
  EXPECT_EQ(numbered_name("s_%04d.png", 7), "s_0007.png");
  EXPECT_EQ(numbered_name("s_##.png", 123), "s_123.png");
  EXPECT_EQ(numbered_name("%d", 0), "0");
  for (const char* none : {"s.png", "s_%04d_%d.png", "s_*_%d.png", "s_?#.png", "100%.png", ""})
    EXPECT_EQ(numbered_name(none, 1), "") << none;
  EXPECT_EQ(numbered_name("%020d", 7), "00000000000000000007");
  for (const std::string none : {"%21d", "%300d", "%2147483647d", "%99999999999999999999999d"})
    EXPECT_EQ(numbered_name("s_" + none + ".png", 1), "") << none;
}

}  // namespace
}  // namespace adamas
