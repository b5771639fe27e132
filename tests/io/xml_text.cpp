#include "core/io/xml_text.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace adamas
