// Tests pictures that are cut off anywhere: there is an error of one line, at once, and the library that
// reads them does not crash.

#include "core/io/grid_file.h"
#include "tests/io/volume_files.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::put_bytes;
using test::says;

TEST(PictureHeader, PnmThatIsCutOff) {
  const test::Scratch scratch;
  const std::pair<const char*, std::string> pictures[] = {{"a.pgm", "P5\n# made by hand\n3 2\n255\nabcdef"},
                                                          {"a.ppm", "P6\n3 2\n#\n255\nabcdefghijklmnopqr"},
                                                          {"a.pnm", "P5 #c\n 3\t2 255\nabcdef"}};
  for (const auto& [name, whole] : pictures) {
    for (std::size_t length = 1; length < whole.size(); length += 3) {
      put_bytes(scratch / name, whole.substr(0, length));
      const std::string message = error_of([&, &file = name] { read_grid_file(scratch / file); });
      EXPECT_TRUE(says(message, std::string(name) + ": expected "));
    }
  }
  put_bytes(scratch / "a.pgm", pictures[0].second);
  EXPECT_EQ(read_grid_file(scratch / "a.pgm").arrays.at(0).size(), 6u);
  put_bytes(scratch / "a.pgm", pictures[0].second + "P5");
  EXPECT_EQ(read_grid_file(scratch / "a.pgm").remark, "2 bytes behind the first picture are not read");
}

std::string tga(std::uint8_t kind, const std::string& pixels) {
  std::string text(18, '\0');
  text[2] = static_cast<char>(kind);
  text[12] = 5;
  text[14] = 4;
  text[16] = 24;
  return text + pixels;
}

TEST(PictureHeader, OthersThatAreCutOff) {
  const test::Scratch scratch;
  std::string bmp = std::string("BM\x4e\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\4\0\0\0\2\0\0\0\1\0\x18\0", 30);
  bmp.resize(54 + 2 * 12);
  // The picture has one grey pixel of 8 bits.
  const std::string png(
      "\211PNG\015\012\032\012\000\000\000\015IHDR\000\000\000\001\000\000\000\001\010\000\000\000\000\072"
      "\176"
      "\233U\000\000\000\012IDATx\234c\140\000\000\000\002\000\001H\257\244q\000\000\000\000IEND\256B\140"
      "\202",
      67);
  const std::pair<const char*, std::string> pictures[] = {
      {"a.tga", tga(2, std::string(60, 'x'))}, {"a.bmp", bmp}, {"a.png", png}};
  for (const auto& [name, whole] : pictures) {
    put_bytes(scratch / name, whole);
    EXPECT_EQ(read_grid_file(scratch / name).arrays.size(), 1u) << name;
    for (std::size_t length = 1; length < whole.size(); length += 3) {
      put_bytes(scratch / name, whole.substr(0, length));
      const std::string message = error_of([&, &file = name] { read_grid_file(scratch / file); });
      EXPECT_EQ(message.find("signal"), std::string::npos) << length << ": " << message;
    }
  }
  // There are runs of 20 and of 10 pixels.
  put_bytes(scratch / "a.tga", tga(10, "\x93xyz"));
  EXPECT_EQ(read_grid_file(scratch / "a.tga").arrays.size(), 1u);
  put_bytes(scratch / "a.tga", tga(10, "\x89xyz"));
  EXPECT_TRUE(says(error_of([&] { read_grid_file(scratch / "a.tga"); }), "expected 20 pixels, found 10"));
  put_bytes(scratch / "a.tga", tga(10, std::string(3, 'x')));
  EXPECT_TRUE(says(error_of([&] { read_grid_file(scratch / "a.tga"); }),
                   "expected 4 or more bytes for 5 x 4 pixels of 3, found 3"));
}

TEST(PictureHeader, PnmThatVtkMistakes) {
  const test::Scratch scratch;
  const auto message = [&](const std::string& text) {
    put_bytes(scratch / "a.pgm", text);
    return error_of([&] { read_grid_file(scratch / "a.pgm"); });
  };
  EXPECT_TRUE(says(message("P5\n3 1\n65535\nabcdef"), "a greatest value from 1 to 255, found '65535'"));
  EXPECT_TRUE(says(message("P5\n-3 2\n255\nabcdef"), "a width from 1 to 2147483648, found '-3'"));
  EXPECT_TRUE(says(message("P5\n3 0\n255\nabcdef"), "a height from 1 to 2147483648, found '0'"));
  EXPECT_TRUE(says(message("P2\n3 2\n255\n1 2 3 4 5 6\n"), "a binary PGM or PPM (P5 or P6), found 'P2'"));
  EXPECT_TRUE(says(message("P5\n9999999 9999999\n255\nabc"), "expected 99999980000001 bytes"));
}

}  // namespace
}  // namespace adamas
