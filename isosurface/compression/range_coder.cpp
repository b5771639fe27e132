#include "isosurface/compression/range_coder.h"

#include <algorithm>
#include <array>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "core/base/assert.h"
#include "core/base/simd.h"

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

#if defined(__x86_64__)
/// By which of eight states take a word: the place of the word of each among the eight before `next`.
constexpr auto kWordPlaces = [] {
  std::array<std::array<std::uint8_t, 8>, 256> places{};
  for (std::size_t mask = 0; mask < places.size(); ++mask) {
    std::uint8_t place = 8;
    for (std::size_t lane = 0; lane < 8; ++lane) {
      if ((mask >> lane & 1) != 0) places[mask][lane] = --place;
    }
  }
  return places;
}();

[[gnu::target("avx2,popcnt")]] inline __m256i load_bytes_of_eight(const std::uint8_t* from) {
  return _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from)));
}

/// take_one for eight states; symbols are the lowest bytes of what is returned, below others.
[[gnu::target("avx2,popcnt")]] inline __m256i take_eight(const std::uint32_t* entries,
                                                         const std::uint8_t* groups, __m256i& states,
                                                         const std::byte*& next) {
  const __m256i slots = _mm256_set1_epi32(kSlots - 1);
  const __m256i index = _mm256_or_si256(_mm256_slli_epi32(load_bytes_of_eight(groups), kScaleBits),
                                        _mm256_and_si256(states, slots));
  const __m256i entry = _mm256_i32gather_epi32(reinterpret_cast<const int*>(entries), index, sizeof(int));
  const __m256i scaled =
      _mm256_mullo_epi32(_mm256_srli_epi32(entry, kSizeAt), _mm256_srli_epi32(states, kScaleBits));
  const __m256i x = _mm256_add_epi32(scaled, _mm256_and_si256(_mm256_srli_epi32(entry, kBiasAt), slots));
  const __m256i low = _mm256_cmpgt_epi32(_mm256_set1_epi32(RangeTables::kLeast), x);
  const auto mask = static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(low)));
  const __m256i eight_words =
      _mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(next - sizeof(__m128i))));
  const __m256i words =
      _mm256_permutevar8x32_epi32(eight_words, load_bytes_of_eight(kWordPlaces[mask].data()));
  const __m256i refilled = _mm256_or_si256(_mm256_slli_epi32(x, RangeTables::kWordBits), words);
  states = _mm256_blendv_epi8(x, refilled, low);
  next -= sizeof(std::uint16_t) * static_cast<unsigned>(__builtin_popcount(mask));
  return entry;
}

/// `count` rows of a symbol from each state; false where the words are used up.
[[gnu::target("avx2,popcnt")]] bool take_wide_rows(const std::uint32_t* entries, const std::uint8_t* groups,
                                                   std::size_t count, RangeTables::States& states,
                                                   const std::byte* begin, const std::byte*& next,
                                                   std::uint8_t* symbols) {
  static_assert(RangeTables::kStates == 16);
  // Copies that nothing points to stay in registers.
  const std::byte* at = next;
  auto* const halves = reinterpret_cast<__m256i*>(states.data());
  __m256i first = _mm256_loadu_si256(halves), second = _mm256_loadu_si256(halves + 1);
  const __m256i lowest = _mm256_set1_epi32(255);
  for (std::size_t row = 0; row < count; ++row) {
    if (at < begin) return false;
    const __m256i a = take_eight(entries, groups, first, at);
    const __m256i b = take_eight(entries, groups + 8, second, at);
    const __m256i pairs = _mm256_packus_epi32(_mm256_and_si256(a, lowest), _mm256_and_si256(b, lowest));
    const __m256i in_order = _mm256_permute4x64_epi64(pairs, 0b11011000);
    const __m128i sixteen =
        _mm_packus_epi16(_mm256_castsi256_si128(in_order), _mm256_extracti128_si256(in_order, 1));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(symbols), sixteen);
    groups += RangeTables::kStates;
    symbols += RangeTables::kStates;
  }
  _mm256_storeu_si256(halves, first);
  _mm256_storeu_si256(halves + 1, second);
  next = at;
  return true;
}
#endif

bool take_rows(const std::uint32_t* entries, const std::uint8_t* groups, std::size_t count,
               RangeTables::States& states, const std::byte* begin, const std::byte*& next,
               std::uint8_t* symbols) {
#if defined(__x86_64__)
  if (has_wide_lanes()) return take_wide_rows(entries, groups, count, states, begin, next, symbols);
#endif
  for (std::size_t row = 0; row < count; ++row) {
    if (next < begin) return false;
    for (std::uint32_t& state : states) *symbols++ = take_one(entries, *groups++, state, next);
  }
  return true;
}

}  // namespace

RangeTables::RangeTables(std::span<const SymbolFrequencies> groups)
    : ranges_(groups.size() * kMaxSymbols), entries_(groups.size() * kSlots) {
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::span<const std::uint16_t> sizes = groups[g].values();
    std::uint32_t* entry = entries_.data() + g * kSlots;
    std::uint32_t start = 0;
    for (std::size_t s = 0; s < sizes.size(); ++s) {
      if (sizes[s] > 0) {
        ranges_[g * kMaxSymbols + s] = {static_cast<std::uint16_t>(start), sizes[s],
                                        ((std::uint64_t{1} << kReciprocalBits) + sizes[s] - 1) / sizes[s]};
      }
      for (std::uint32_t bias = 0; bias < sizes[s]; ++bias) {
        *entry++ = static_cast<std::uint32_t>(s) | bias << kBiasAt | std::uint32_t{sizes[s]} << kSizeAt;
      }
      start += sizes[s];
    }
    ADAMAS_ASSERT(start == kSlots);
  }
}

std::uint16_t* RangeTables::encode(std::span<const std::uint8_t> groups, const std::uint8_t* symbols,
                                   States& states, std::uint16_t* words) const {
  States now;
  now.fill(kLeast);
  for (std::size_t n = groups.size(); n-- > 0;) {
    const Range range = ranges_[groups[n] * kMaxSymbols + symbols[n]];
    ADAMAS_ASSERT(range.size > 0);
    std::uint32_t x = now[n % now.size()];
    // Without a branch, for which there is no telling: whether a word leaves the state.
    const bool high = x >= std::uint32_t{range.size} << kWordBits;
    *words = static_cast<std::uint16_t>(x);
    words += high ? 1 : 0;
    x >>= high ? kWordBits : 0;
    const auto quotient = static_cast<std::uint32_t>(x * range.reciprocal >> kReciprocalBits);
    now[n % now.size()] =
        (quotient << SymbolFrequencies::kScaleBits) + range.start + (x - quotient * range.size);
  }
  states = now;
  return words;
}

bool RangeDecoder::take(std::span<const std::uint8_t> groups, std::uint8_t* symbols) {
  static_assert(kSlack >= 2 * RangeTables::kStates);
  const std::size_t rows = groups.size() / RangeTables::kStates, whole = rows * RangeTables::kStates;
  if (!take_rows(entries_, groups.data(), rows, states_, begin_, next_, symbols)) return false;
  if (next_ < begin_) return false;
  const std::size_t rest = groups.size() - whole;
  for (std::size_t n = 0; n < rest; ++n) {
    symbols[whole + n] = take_one(entries_, groups[whole + n], states_[n], next_);
  }
  // The next symbol is that of the first state again.
  std::rotate(states_.begin(), states_.begin() + static_cast<std::ptrdiff_t>(rest), states_.end());
  return true;
}

}  // namespace adamas
