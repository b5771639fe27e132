#include "adamas/text.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <random>

namespace adamas {
namespace {

TEST(VisibleText, LeavesWhatCanBeRead) {
  for (const std::string text :
       {"", "plain ~ text", "C:\\path", "Grüße, 世界, ünïcödé 🌍", "a\u00a0b", "\u2027\u2065"})
    EXPECT_EQ(visible_text(text), text);
}

TEST(VisibleText, ShowsWhatActsOnATerminal) {
  EXPECT_EQ(visible_text("\x1b[31mred\x07\n\t\x7f"), "\\x1b[31mred\\x07\\x0a\\x09\\x7f");
  EXPECT_EQ(visible_text(std::string("a\0b", 3)), "a\\x00b");
  // These are C1 control characters. U+009B begins a sequence as escape and a bracket do; the byte 9b alone
  // is not UTF-8.
  EXPECT_EQ(visible_text("\u009b2J \u0080"), "\\u009b2J \\u0080");
  EXPECT_EQ(visible_text("\x9b\x32J \xff\xc3"), "\\x9b2J \\xff\\xc3");
  EXPECT_EQ(visible_text("gnp\u202e.txt \u2066\u200f\u061c\u2029"),
            "gnp\\u202e.txt \\u2066\\u200f\\u061c\\u2029");
}

/// The shell takes each argument for one word, and gives it back as it was.
TEST(AsArgument, IsOneWordOfTheShell) {
  EXPECT_EQ(as_argument("ct/head-2.nrrd"), "ct/head-2.nrrd");
  for (const std::string text :
       {"", "a b", "it's", "$HOME", "a;b", "--x=*", "'", "back\\slash", "a\"b", "Ä"}) {
    const std::string command = "printf %s " + as_argument(text);
    std::FILE* const pipe = ::popen(command.c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    std::array<char, 64> bytes{};
    const std::size_t count = std::fread(bytes.data(), 1, bytes.size(), pipe);
    ::pclose(pipe);
    EXPECT_EQ(std::string(bytes.data(), count), text) << command;
  }
}

/// Whatever the bytes, the result is UTF-8 without control characters, and applying the function to it
/// changes nothing.
TEST(VisibleText, IsAlwaysHarmless) {
  std::mt19937 random(3);
  for (int n = 0; n < 20000; ++n) {
    std::string text;
    for (unsigned i = random() % 12; i > 0; --i) {
      const unsigned kind = random() % 4;
      text += static_cast<char>(kind == 0   ? random() % 256
                                : kind == 1 ? 0xc0 + random() % 64
                                            : 0x80 + random() % 64);
    }
    const std::string shown = visible_text(text);
    for (std::string_view rest = shown; !rest.empty();) {
      const std::size_t length = utf8_length(rest);
      ASSERT_GT(length, 0u) << shown;
      const auto first = static_cast<unsigned char>(rest[0]);
      ASSERT_TRUE(first >= 0x20 && first != 0x7f) << shown;
      ASSERT_FALSE(first == 0xc2 && static_cast<unsigned char>(rest[1]) < 0xa0) << shown;
      rest.remove_prefix(length);
    }
    ASSERT_EQ(visible_text(shown), shown);
  }
}

}  // namespace
}  // namespace adamas
