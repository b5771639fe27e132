#include "isosurface/compression/range_coder.h"

#include <algorithm>

#include "core/base/assert.h"

namespace adamas {
namespace {

constexpr int kScaleBits = SymbolFrequencies::kScaleBits;
constexpr std::uint32_t kSlots = SymbolFrequencies::kScale;
constexpr int kBiasAt = 8, kSizeAt = 20;

inline std::uint8_t take_one(const std::uint32_t* entries, std::size_t group, std::uint32_t& x,
                             const std::byte*& next) {
  const std::uint32_t entry = entries[group << kScaleBits | (x & (kSlots - 1))];
  x = (entry >> kSizeAt) * (x >> kScaleBits) + (entry >> kBiasAt & (kSlots - 1));
  std::uint16_t word = 0;
  std::memcpy(&word, next - sizeof word, sizeof word);
  if constexpr (std::endian::native == std::endian::big) word = __builtin_bswap16(word);
  // Without branches, for which there is no telling: whether the word belongs to the state.
  const bool low = x < RangeTables::kLeast;
  const std::uint32_t refilled = x << RangeTables::kWordBits | word;
  x = low ? refilled : x;
  next -= low ? sizeof word : 0;
  return static_cast<std::uint8_t>(entry & 0xff);
}

}  // namespace

RangeTables::RangeTables(std::span<const SymbolFrequencies> groups)
    : ranges_(groups.size() * kMaxSymbols), entries_(groups.size() * kSlots) {
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::span<const std::uint16_t> sizes = groups[g].values();
    std::uint32_t* entry = entries_.data() + g * kSlots;
    std::uint32_t start = 0;
    for (std::size_t s = 0; s < sizes.size(); ++s) {
      ranges_[g * kMaxSymbols + s] = {static_cast<std::uint16_t>(start), sizes[s]};
      for (std::uint32_t bias = 0; bias < sizes[s]; ++bias) {
        *entry++ = static_cast<std::uint32_t>(s) | bias << kBiasAt | std::uint32_t{sizes[s]} << kSizeAt;
      }
      start += sizes[s];
    }
    ADAMAS_ASSERT(start == kSlots);
  }
}

bool RangeDecoder::take(std::span<const std::uint8_t> groups, std::uint8_t* symbols) {
  static_assert(RangeTables::kStates == 4 && kBlock % RangeTables::kStates == 0);
  // Copies that nothing points to stay in registers.
  const std::uint32_t* const entries = entries_;
  const std::byte* next = next_;
  auto [a, b, c, d] = states_;
  const std::uint8_t* group = groups.data();
  const std::size_t whole = groups.size() / 4 * 4;
  for (std::size_t n = 0; n < whole;) {
    if (next < begin_) return false;
    for (const std::size_t end = n + kBlock < whole ? n + kBlock : whole; n < end; n += 4) {
      symbols[n] = take_one(entries, group[n], a, next);
      symbols[n + 1] = take_one(entries, group[n + 1], b, next);
      symbols[n + 2] = take_one(entries, group[n + 2], c, next);
      symbols[n + 3] = take_one(entries, group[n + 3], d, next);
    }
  }
  if (next < begin_) return false;
  states_ = {a, b, c, d};
  for (std::size_t n = whole; n < groups.size(); ++n) {
    symbols[n] = take_one(entries, group[n], states_[n % 4], next);
  }
  // The next symbol is that of the first state again.
  std::rotate(states_.begin(), states_.begin() + static_cast<std::ptrdiff_t>(groups.size() % 4),
              states_.end());
  next_ = next;
  return true;
}

}  // namespace adamas
