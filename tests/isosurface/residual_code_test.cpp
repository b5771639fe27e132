#include "isosurface/compression/split_edge/residual_code.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/base/error.h"

namespace adamas {

using namespace isosurface;

namespace {

using Bytes = std::vector<std::byte>;
using Page = std::vector<std::uint32_t>;

constexpr int kBits[] = {8, 16, 32};

ResidualCode code_of(const std::vector<Page>& pages, int bits) {
  ResidualStatistics statistics(bits);
  for (const Page& page : pages) statistics.add(page);
  return ResidualCode(statistics);
}

Bytes encoded(const ResidualCode& code, const Page& page) {
  Bytes bytes;
  code.encode(page, bytes);
  return bytes;
}

/// Expects that the page comes back with the code and with the code parsed from its tables, and that the
/// tables have one form only.
void expect_there_and_back(const ResidualCode& code, const Page& page) {
  const Bytes bytes = encoded(code, page);
  Page found(page.size(), 0xdeadbeef);
  ASSERT_TRUE(code.decode(bytes, found));
  ASSERT_EQ(found, page);
  const Bytes tables = code.serialise();
  ASSERT_LE(tables.size(), ResidualCode::kMaxTableBytes);
  const ResidualCode parsed = ResidualCode::parse(tables, code.bits(), "here");
  ASSERT_EQ(parsed.serialise(), tables);
  ASSERT_EQ(encoded(parsed, page), bytes);
  std::fill(found.begin(), found.end(), 0xdeadbeef);
  ASSERT_TRUE(parsed.decode(bytes, found));
  ASSERT_EQ(found, page);
}

void expect_there_and_back(const Page& page, int bits) { expect_there_and_back(code_of({page}, bits), page); }

/// Returns residuals with a two-sided geometric distribution, which is that of real ones.
Page random_page(std::mt19937_64& random, std::size_t size, int bits, double scale) {
  Page page(size);
  for (std::uint32_t& residual : page) {
    const double uniform = static_cast<double>(random() >> 11) * 0x1p-53;
    const auto magnitude = static_cast<std::int64_t>(-scale * std::log(1 - uniform));
    const std::int64_t value = (random() & 1) != 0 ? -magnitude : magnitude;
    residual = static_cast<std::uint32_t>(value) & LeadOne(bits).mask();
  }
  return page;
}

Page any_page(std::mt19937_64& random, std::size_t size, int bits) {
  Page page(size);
  // All bit lengths of magnitudes are equally likely, so that all symbols occur.
  for (std::uint32_t& residual : page) {
    residual = static_cast<std::uint32_t>(random() >> 32) >> (random() % 32);
    if ((random() & 1) != 0) residual = 0 - residual;
    residual &= LeadOne(bits).mask();
  }
  return page;
}

/// Expects that corrupt bytes are refused or decoded to a page that is coded as the same bytes. The
/// sanitizers report any access beyond their end.
void expect_an_answer(const ResidualCode& code, const Bytes& bytes, std::size_t count) {
  Page found(count);
  if (code.decode(bytes, found)) {
    ASSERT_EQ(encoded(code, found), bytes);
  }
}

TEST(ResidualCode, DecodesPagesOfAllSizes) {
  std::mt19937_64 random(1);
  for (const int bits : kBits) {
    for (const std::size_t size : {0u, 1u, 2u, 3u, 7u, 8u, 9u, 63u, 64u, 65u, 4095u, 4096u}) {
      expect_there_and_back(any_page(random, size, bits), bits);
      for (const double scale : {0.5, 3.0, 40.0, 5000.0}) {
        expect_there_and_back(random_page(random, size, bits, scale), bits);
      }
    }
  }
}

TEST(ResidualCode, DecodesExtremes) {
  for (const int bits : kBits) {
    const std::uint32_t least = 1u << (bits - 1), greatest = least - 1, minus_one = LeadOne(bits).mask();
    const Page extremes{0, 1, minus_one, greatest, least, least + 1};
    for (const std::uint32_t a : extremes) {
      for (const std::uint32_t b : extremes) {
        Page alternating(4096, a);
        for (std::size_t n = 1; n < alternating.size(); n += 2) alternating[n] = b;
        expect_there_and_back(alternating, bits);
        expect_there_and_back({a, b}, bits);
      }
    }
  }
}

TEST(ResidualCode, SpendsABitOnASymbolThatIsSure) {
  for (const int bits : kBits) {
    const Page zeros(4096, 0);
    expect_there_and_back(zeros, bits);
    EXPECT_EQ(encoded(code_of({zeros}, bits), zeros).size(), 4096u / 8);
  }
}

TEST(ResidualCode, LimitsTheWordsOfFibonacciCounts) {
  std::mt19937_64 random(2);
  std::vector<Page> pages;
  std::uint64_t count = 1, next = 1;
  // Each symbol comes, after a zero, as often as its Fibonacci number. Without a limit such counts lead to
  // words of 25 bits.
  for (int symbol = 1; symbol <= 25; ++symbol) {
    for (std::uint64_t n = 0; n < count; ++n) {
      if (pages.empty() || pages.back().size() > 4090) pages.emplace_back();
      const std::uint32_t lead = 1u << (symbol - 1);
      pages.back().push_back(lead | (static_cast<std::uint32_t>(random()) & (lead - 1)));
      pages.back().push_back(0);
    }
    next += count;
    count = next - count;
  }
  const ResidualCode code = code_of(pages, 32);
  expect_there_and_back(code, pages.front());
  for (const Page& page : pages) {
    Page found(page.size());
    ASSERT_TRUE(code.decode(encoded(code, page), found));
    ASSERT_EQ(found, page);
  }
}

TEST(ResidualCode, DecodesEveryPageItsStatisticsCount) {
  std::mt19937_64 random(3);
  for (const int bits : kBits) {
    std::vector<Page> pages;
    for (int n = 0; n < 20; ++n)
      pages.push_back(random_page(random, 1 + random() % 300, bits, std::exp2(n % 9)));
    const ResidualCode code = code_of(pages, bits);
    for (const Page& page : pages) expect_there_and_back(code, page);
  }
}

TEST(ResidualCode, IsTheSameForStatisticsInAnyOrder) {
  std::mt19937_64 random(4);
  ResidualStatistics forth(16), back(16), parts(16);
  std::vector<Page> pages;
  for (int n = 0; n < 12; ++n) pages.push_back(random_page(random, 1 + random() % 500, 16, 60));
  for (std::size_t n = 0; n < pages.size(); ++n) {
    forth.add(pages[n]);
    back.add(pages[pages.size() - 1 - n]);
    ResidualStatistics one(16);
    one.add(pages[n]);
    parts.merge(one);
  }
  const Bytes tables = ResidualCode(forth).serialise();
  EXPECT_EQ(ResidualCode(back).serialise(), tables);
  EXPECT_EQ(ResidualCode(parts).serialise(), tables);
}

TEST(ResidualCode, IgnoresBitsBeyondTheModulus) {
  const Page wide{0xffffffff, 0x00000100, 0xffffff80}, narrow{0xff, 0x00, 0x80};
  const ResidualCode code = code_of({wide}, 8);
  EXPECT_EQ(code.serialise(), code_of({narrow}, 8).serialise());
  EXPECT_EQ(encoded(code, wide), encoded(code, narrow));
}

TEST(ResidualCode, HasTheseBytes) {
  const Page page{0, 0, 1, 0xff, 0, 3, 0xfc, 0, 0, 0x7f, 0x80, 0, 5, 0};
  const ResidualCode code = code_of({page}, 8);
  const auto bytes = [](std::initializer_list<int> values) {
    Bytes result;
    for (const int value : values) result.push_back(static_cast<std::byte>(value));
    return result;
  };
  EXPECT_EQ(code.serialise(), bytes({0x18, 0x33, 0x03, 0x00, 0x23, 0x11, 0x04, 0x00, 0x11, 0x01, 0x00, 0x09,
                                     0x00, 0x00, 0x00, 0x10, 0x11}));
  EXPECT_EQ(encoded(code, page), bytes({0xc4, 0xaa, 0x70, 0x3f, 0x13}));
}

TEST(ResidualCode, CodesNothingButWhatWasCounted) {
  const ResidualCode code = code_of({{0, 1, 0}}, 8);
  Bytes bytes;
  EXPECT_THROW(code.encode(Page{2}, bytes), Error);
  EXPECT_THROW(code.encode(Page{0, 1, 1}, bytes), Error);
  EXPECT_NO_THROW(code.encode(Page{1, 0, 0xff, 0, 0, 0}, bytes));
}

TEST(ResidualCode, RefusesPagesThatAreCutOrTooLong) {
  std::mt19937_64 random(5);
  for (const int bits : kBits) {
    for (const double scale : {0.7, 20.0, 1e4}) {
      const Page page = random_page(random, 400, bits, scale);
      const ResidualCode code = code_of({page}, bits);
      const Bytes bytes = encoded(code, page);
      Page found(page.size());
      for (std::size_t length = 0; length < bytes.size(); ++length) {
        ASSERT_FALSE(
            code.decode(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)), found));
      }
      for (const int more : {0, 1, 255}) {
        Bytes longer = bytes;
        longer.push_back(static_cast<std::byte>(more));
        ASSERT_FALSE(code.decode(longer, found));
      }
      Page fewer(page.size() - 40), none;
      EXPECT_FALSE(code.decode(bytes, fewer));
      EXPECT_FALSE(code.decode(bytes, none));
      EXPECT_TRUE(code.decode({}, none));
    }
  }
}

TEST(ResidualCode, AnswersToFlippedBitsAndNoise) {
  std::mt19937_64 random(6);
  for (const int bits : kBits) {
    const Page page = any_page(random, 300, bits);
    const ResidualCode code = code_of({page}, bits);
    const Bytes bytes = encoded(code, page);
    for (int trial = 0; trial < 1500; ++trial) {
      Bytes corrupt = bytes;
      for (std::uint64_t n = random() % 4; n-- > 0;) {
        corrupt[random() % corrupt.size()] ^= static_cast<std::byte>(1u << (random() % 8));
      }
      expect_an_answer(code, corrupt, random() % 500);
      for (std::byte& byte : corrupt) byte = static_cast<std::byte>(random() & 0xff);
      expect_an_answer(code, corrupt, random() % 5000);
    }
  }
}

TEST(ResidualCode, RefusesTablesThatAreCutOrTooLong) {
  std::mt19937_64 random(7);
  for (const int bits : kBits) {
    const Bytes tables = code_of({any_page(random, 4096, bits)}, bits).serialise();
    for (std::size_t length = 0; length < tables.size(); ++length) {
      const Bytes cut(tables.begin(), tables.begin() + static_cast<std::ptrdiff_t>(length));
      ASSERT_THROW(static_cast<void>(ResidualCode::parse(cut, bits, "here")), Error) << length;
    }
    Bytes longer = tables;
    longer.push_back(std::byte{0});
    ASSERT_THROW(static_cast<void>(ResidualCode::parse(longer, bits, "here")), Error);
  }
}

TEST(ResidualCode, AnswersToFlippedBitsOfTables) {
  std::mt19937_64 random(8);
  const Page page = any_page(random, 300, 8);
  const ResidualCode code = code_of({page}, 8);
  const Bytes tables = code.serialise(), bytes = encoded(code, page);
  int codes = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    Bytes corrupt = tables;
    for (std::uint64_t n = 1 + random() % 3; n-- > 0;) {
      corrupt[random() % corrupt.size()] ^= static_cast<std::byte>(1u << (random() % 8));
    }
    try {
      const ResidualCode other = ResidualCode::parse(corrupt, 8, "here");
      ASSERT_EQ(other.serialise(), corrupt);
      expect_an_answer(other, bytes, page.size());
      ++codes;
    } catch (const Error& error) {
      ASSERT_EQ(std::string(error.what()).rfind("here: ", 0), 0u) << error.what();
    }
  }
  EXPECT_GT(codes, 0);
}

TEST(ResidualCode, NamesWhatIsWrongWithTables) {
  const auto refusal = [](const Bytes& tables) {
    try {
      static_cast<void>(ResidualCode::parse(tables, 8, "gradient"));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal({}),
            "gradient: prefix code after symbol 0: expected 0 lengths, found the end of the data");
  EXPECT_EQ(refusal(Bytes(6, std::byte{0})),
            "gradient: expected the end after 9 prefix codes, found more data");
  EXPECT_EQ(refusal(Bytes(5, std::byte{0})), "");
}

}  // namespace
}  // namespace adamas
