#include "core/io/xml_text.h"

#include <gtest/gtest.h>

#include "core/base/text.h"

namespace adamas {
namespace {

TEST(XmlText, AttributesAreAlwaysWellFormed) {
  EXPECT_EQ(xml_attribute("Armor Plate, 2"), "Armor Plate, 2");
  EXPECT_EQ(xml_attribute("a<b>&\"c\""), "a&lt;b&gt;&amp;&quot;c&quot;");
  EXPECT_EQ(xml_attribute("a\tb\nc"), "a&#9;b&#10;c");
  EXPECT_EQ(xml_attribute("a\x01z"), "a?z");
  EXPECT_EQ(xml_attribute("\xc3\xa4\xe2\x82\xac"), "\xc3\xa4\xe2\x82\xac") << "UTF-8 stays";
  EXPECT_EQ(xml_attribute("\xe4"), "\xc3\xa4") << "Latin-1";
  EXPECT_EQ(xml_attribute("\xed\xa0\x80"), "\xc3\xad\xc2\xa0\xc2\x80") << "a surrogate is no character";
}

TEST(Utf8, LengthOfTheFirstCharacter) {
  EXPECT_EQ(utf8_length(""), 0u);
  EXPECT_EQ(utf8_length("az"), 1u);
  EXPECT_EQ(utf8_length("\xc3\xa4z"), 2u);
  EXPECT_EQ(utf8_length("\xe2\x82\xac"), 3u);
  EXPECT_EQ(utf8_length("\xf0\x9d\x84\x9e"), 4u);
  for (const char* bad : {"\x80", "\xc0\x80", "\xc3", "\xe2\x82", "\xe0\x80\x80", "\xed\xa0\x80",
                          "\xf0\x80\x80\x80", "\xf4\x90\x80\x80", "\xff"}) {
    EXPECT_EQ(utf8_length(bad), 0u) << bad;
  }
}

}  // namespace
}  // namespace adamas
