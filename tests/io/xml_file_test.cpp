#include "core/io/xml_file.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "adamas/text.h"
#include "tests/support/scratch.h"
#include "tests/support/text_supply.h"

namespace adamas {

using namespace io;

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

std::vector<XmlTag> tags_of(const std::string& text) {
  return read_xml_tags(test::supply_text(text), "x.vti");
}

TEST(XmlTags, PlacesAndTexts) {
  const std::string text =
      "<?xml version='1.0'?><!-- <no> & \" > -->\n<a b='1 &lt; 2' c=\"&#228;\">\n  <k>7</k>\n  text <e/> "
      "more</a>";
  const std::vector<XmlTag> tags = tags_of(text);
  ASSERT_EQ(tags.size(), 6u);
  EXPECT_EQ(tags[0].name, "a");
  EXPECT_EQ(tags[0].value("b"), "1 < 2");
  EXPECT_EQ(tags[0].value("c"), "\xc3\xa4");
  EXPECT_FALSE(tags[0].has("d"));
  EXPECT_EQ(text.substr(tags[0].end, 3), "\n  ");
  ASSERT_TRUE(tags[0].text && tags[1].text);
  EXPECT_EQ(text.substr(*tags[0].text, 4), "text") << "the texts of elements within are theirs";
  EXPECT_EQ(text.substr(*tags[1].text, 1), "7");
  EXPECT_TRUE(tags[2].closing);
  EXPECT_EQ(tags[3].name, "e");
  EXPECT_TRUE(tags[4].closing);
  EXPECT_FALSE(tags[3].text);
}

TEST(XmlTags, WhatFollowsAppendedDataIsNotLookedAt) {
  const std::string bytes = std::string("<f><AppendedData encoding='raw'>\n  _\0<&<", 41);
  for (const std::size_t step : {1, 3, 100}) {
    const auto tags = read_xml_tags(
        [&, at = std::size_t{0}]() mutable {
          const std::string_view piece = std::string_view(bytes).substr(std::min(at, bytes.size()), step);
          at += step;
          return piece;
        },
        "x.vti");
    ASSERT_EQ(tags.size(), 2u);
    EXPECT_EQ(tags[1].text, bytes.find('_') + 1) << step;
  }
  EXPECT_FALSE(tags_of("<f><AppendedData>x_").back().text);
}

TEST(XmlTags, WhatCouldGrowOrIsOtherIsRefused) {
  const auto message = [](const std::string& text) { return test::error_of([&] { tags_of(text); }); };
  EXPECT_EQ(message("<!DOCTYPE f [<!ENTITY a 'ha'><!ENTITY b '&a;&a;'>]><f>&b;</f>"),
            "x.vti: expected XML without a document type, found one");
  EXPECT_TRUE(
      test::says(message("<f>&b;</f>"), "line 1: expected well-formed XML, found an error: undefined"));
  EXPECT_TRUE(test::says(message("\xff\xfe<\0f\0"), "one byte per character or in UTF-8"));
  EXPECT_TRUE(test::says(message("<f>\n<g></f>"), "line 2: expected well-formed XML, found an error"));
  EXPECT_TRUE(test::says(message("<f>\n"), "expected well-formed XML, found an error"));
  EXPECT_TRUE(test::says(message(""), "expected well-formed XML"));
  const std::string limit = "expected tags of less than 1048576 bytes, found more";
  EXPECT_TRUE(test::says(message("<f a='" + std::string(2'000'000, 'x')), limit)) << "one that does not end";
  EXPECT_TRUE(test::says(message("<f a='" + std::string(2'000'000, 'x') + "'/>"), limit));
  std::string many = "<f>";
  for (int i = 0; i < 300'000; ++i) many += "<g/>";
  EXPECT_TRUE(test::says(message(many + "</f>"), limit));
  EXPECT_EQ(tags_of("<f>" + std::string(3'000'000, 'x') + "</f>").size(), 2u) << "texts may be long";
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
