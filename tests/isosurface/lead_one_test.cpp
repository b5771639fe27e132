#include <gtest/gtest.h>

#include "isosurface/compression/split_edge/residual_code.h"

namespace adamas {

using namespace isosurface;

namespace {

void expect_there_and_back(LeadOne lead_one, std::uint32_t residual) {
  const LeadOne::Parts parts = lead_one.split(residual);
  const int unused = LeadOne::kMaxBits - lead_one.bits();
  const std::int64_t value = static_cast<std::int32_t>(residual << unused) >> unused;
  const std::int64_t magnitude = value < 0 ? -value : value;
  // The leading 1 is at the place that the symbol states.
  ASSERT_EQ(magnitude >> parts.symbol, 0) << residual;
  if (magnitude > 0) {
    ASSERT_EQ(magnitude >> (parts.symbol - 1), 1) << residual;
  }
  ASSERT_LT(parts.symbol, lead_one.symbols());
  ASSERT_EQ(std::uint64_t{parts.extra} >> lead_one.extra_bits(parts.symbol), 0u) << residual;
  if (lead_one.extra_bits(parts.symbol) > 0) {
    ASSERT_EQ((parts.extra & 1) != 0, value < 0) << residual;
  }
  ASSERT_EQ(lead_one.join(parts), residual);
}

TEST(LeadOne, SplitsAndJoinsAllSmallResiduals) {
  for (const int bits : {8, 16}) {
    const LeadOne lead_one(bits);
    for (std::uint32_t residual = 0; residual < 1u << bits; ++residual)
      expect_there_and_back(lead_one, residual);
  }
}

TEST(LeadOne, SplitsAndJoinsResidualsOf32BitsRoundPowersOf2) {
  for (int b = 0; b < 32; ++b) {
    for (std::uint32_t offset = 0; offset < 5; ++offset) {
      expect_there_and_back(LeadOne(32), (1u << b) + offset - 2);
      expect_there_and_back(LeadOne(32), 0 - ((1u << b) + offset - 2));
    }
  }
}

TEST(LeadOne, SpendsNothingOnZeroAndTheLeastNumber) {
  for (const int bits : {8, 16, 32}) {
    const LeadOne lead_one(bits);
    EXPECT_EQ(lead_one.split(0).symbol, 0);
    EXPECT_EQ(lead_one.split(1u << (bits - 1)).symbol, bits);
    EXPECT_EQ(lead_one.extra_bits(0), 0);
    EXPECT_EQ(lead_one.extra_bits(1), 1);
    EXPECT_EQ(lead_one.extra_bits(bits - 1), bits - 1);
    EXPECT_EQ(lead_one.extra_bits(bits), 0);
  }
}

TEST(LeadOne, IgnoresBitsBeyondTheModulus) {
  EXPECT_EQ(LeadOne(8).split(0xffffff00).symbol, 0);
  EXPECT_EQ(LeadOne(8).join(LeadOne(8).split(0xfffffffe)), 0xfeu);
  EXPECT_EQ(LeadOne(16).join(LeadOne(16).split(0x12345678)), 0x5678u);
}

}  // namespace
}  // namespace adamas
