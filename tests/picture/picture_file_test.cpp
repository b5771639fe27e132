#include "core/picture/picture_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "core/base/error.h"
#include "core/picture/markup.h"
#include "decode_png.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace picture;

namespace {

TEST(PictureFile, FormatByExtension) {
  EXPECT_EQ(picture_format("a/b.c.PNG"), PictureFormat::kPng);
  EXPECT_EQ(picture_format("b.svg"), PictureFormat::kSvg);
  EXPECT_EQ(picture_format("b.pdf"), PictureFormat::kPdf);
  for (const char* name : {"b.jpeg", "png", "b.", ""}) EXPECT_THROW(picture_format(name), Error) << name;
}

TEST(PictureFile, NothingIsLeftWhenTheBytesDoNotFit) {
  const test::Scratch folder;
  // A limit on file sizes stands for a full disk.
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 1000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string message;
  try {
    write_bytes(folder / "full.png", std::string(100000, 'x'));
  } catch (const Error& error) {
    message = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(message.find("full.png"), std::string::npos) << message;
  EXPECT_EQ(folder.entries(), 0);
}

TEST(PictureFile, WritesAndReplaces) {
  const test::Scratch folder;
  const std::string first(10000, 'a'), second = "b";
  write_bytes(folder / "x.bin", first);
  EXPECT_EQ(test::bytes_of(folder / "x.bin"), first);
  write_bytes(folder / "x.bin", second);
  EXPECT_EQ(test::bytes_of(folder / "x.bin"), second);
  EXPECT_EQ(folder.entries(), 1);
  EXPECT_THROW(write_bytes(folder / "no" / "x.bin", first), Error);
  EXPECT_THROW(write_bytes(folder.folder(), first), Error);
}

TEST(Text, OneLineIsValidUtf8) {
  EXPECT_EQ(one_line("a\nb\tc\x7f"), "a b c ");
  EXPECT_EQ(one_line("é³→𝄞"), "é³→𝄞");
  EXPECT_EQ(one_line("a\xff"
                     "b"),
            "a\xEF\xBF\xBD"
            "b");
  EXPECT_EQ(one_line("\xc3"), "\xEF\xBF\xBD");
  EXPECT_EQ(one_line("\xc0\x80"), "\xEF\xBF\xBD\xEF\xBF\xBD") << "overlong";
  EXPECT_EQ(one_line("\xed\xa0\x80").find('\xed'), std::string::npos) << "surrogate";
  EXPECT_EQ(one_line(std::string("a\0b", 3)), "a b");
}

TEST(Text, Base64TestVectors) {  // RFC 4648, section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(Png, OtherBytesAreAnError) {
  EXPECT_THROW(test::decode_png(""), Error);
  EXPECT_THROW(test::decode_png("no picture"), Error);
}

}  // namespace
}  // namespace adamas
