#include "isosurface/compression/entropy/rans_coder.h"

#include <algorithm>
#include <bit>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "core/base/simd.h"

namespace adamas::isosurface {
namespace {

constexpr int kScaleBits = ContextTables::kScaleBits;
constexpr std::uint32_t kSlots = ContextTables::kScale;
constexpr int kBiasAt = 8, kSizeAt = 20;
constexpr int kLengthBits = 4;

/// Takes a symbol from the state and moves `next`, the end of the remaining words.
[[gnu::always_inline]] inline std::uint32_t take_one(const std::uint32_t* entries, std::size_t table,
                                                     std::uint32_t& x, const std::byte*& next) {
  const std::uint32_t entry = entries[table << kScaleBits | (x & (kSlots - 1))];
  x = (entry >> kSizeAt) * (x >> kScaleBits) + (entry >> kBiasAt & (kSlots - 1));
  std::uint16_t word = 0;
  std::memcpy(&word, next - sizeof word, sizeof word);
  if constexpr (std::endian::native == std::endian::big) word = __builtin_bswap16(word);
  // There is no branch here, since it would be unpredictable.
  const bool low = x < RansTables::kLeast;
  const std::uint32_t refilled = x << RansTables::kWordBits | word;
  x = low ? refilled : x;
  next -= low ? sizeof word : 0;
  return entry & 0xff;
}

/// The input and output of a loop that takes rows of symbols, one from each state.
struct Rows {
  const std::uint32_t* entries;
  const std::uint8_t* tables;
  std::size_t count;
  std::uint32_t* states;
  const std::byte *begin, *next;  ///< the words, which are taken from their end
  std::uint8_t* symbols;
};

enum class Found : std::uint8_t { kSymbols, kEscapes, kTooFewWords };

#if defined(__x86_64__)
/// The place of each state's word among the eight words before `next`, indexed by the set of those of eight
/// states that take a word.
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

/// Takes symbols from eight states, as take_one(). The symbols are the lowest bytes of the result.
[[gnu::target("avx2,popcnt")]] inline __m256i take_eight(const std::uint32_t* entries,
                                                         const std::uint8_t* tables, __m256i& states,
                                                         const std::byte*& next) {
  const __m256i slots = _mm256_set1_epi32(kSlots - 1);
  const __m256i index = _mm256_or_si256(_mm256_slli_epi32(load_bytes_of_eight(tables), kScaleBits),
                                        _mm256_and_si256(states, slots));
  const __m256i entry = _mm256_i32gather_epi32(reinterpret_cast<const int*>(entries), index, sizeof(int));
  const __m256i scaled =
      _mm256_mullo_epi32(_mm256_srli_epi32(entry, kSizeAt), _mm256_srli_epi32(states, kScaleBits));
  const __m256i x = _mm256_add_epi32(scaled, _mm256_and_si256(_mm256_srli_epi32(entry, kBiasAt), slots));
  const __m256i low = _mm256_cmpgt_epi32(_mm256_set1_epi32(RansTables::kLeast), x);
  const auto mask = static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(low)));
  const __m256i eight_words =
      _mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(next - sizeof(__m128i))));
  const __m256i words =
      _mm256_permutevar8x32_epi32(eight_words, load_bytes_of_eight(kWordPlaces[mask].data()));
  const __m256i refilled = _mm256_or_si256(_mm256_slli_epi32(x, RansTables::kWordBits), words);
  states = _mm256_blendv_epi8(x, refilled, low);
  next -= sizeof(std::uint16_t) * static_cast<unsigned>(__builtin_popcount(mask));
  return entry;
}

/// Takes rows of `Eights` times eight symbols.
template <int Eights>
[[gnu::target("avx2,popcnt")]] Found take_rows_wide(Rows& rows) {
  // These copies, which no pointer refers to, stay in registers.
  const std::uint32_t* const entries = rows.entries;
  const std::uint8_t* tables = rows.tables;
  std::uint8_t* symbols = rows.symbols;
  const std::byte *const begin = rows.begin, *at = rows.next;
  auto* const eights = reinterpret_cast<__m256i*>(rows.states);
  __m256i first = _mm256_loadu_si256(eights), second = Eights == 2 ? _mm256_loadu_si256(eights + 1) : first;
  const __m256i lowest = _mm256_set1_epi32(255);
  __m256i any = _mm256_setzero_si256();
  for (std::size_t row = 0; row < rows.count; ++row) {
    if (at < begin) return Found::kTooFewWords;
    const __m256i a = take_eight(entries, tables, first, at);
    const __m256i b = Eights == 2 ? take_eight(entries, tables + 8, second, at) : a;
    any = _mm256_or_si256(any, _mm256_or_si256(a, b));
    const __m256i pairs = _mm256_packus_epi32(_mm256_and_si256(a, lowest), _mm256_and_si256(b, lowest));
    const __m256i in_order = _mm256_permute4x64_epi64(pairs, 0b11011000);
    const __m128i bytes =
        _mm_packus_epi16(_mm256_castsi256_si128(in_order), _mm256_extracti128_si256(in_order, 1));
    auto* const to = reinterpret_cast<__m128i*>(symbols);
    if constexpr (Eights == 2) {
      _mm_storeu_si128(to, bytes);
    } else {
      _mm_storel_epi64(to, bytes);
    }
    tables += 8 * Eights;
    symbols += 8 * Eights;
  }
  _mm256_storeu_si256(eights, first);
  if (Eights == 2) _mm256_storeu_si256(eights + 1, second);
  rows.next = at;
  return _mm256_testz_si256(any, _mm256_set1_epi32(128)) != 0 ? Found::kSymbols : Found::kEscapes;
}
#endif

template <std::size_t kStates>
Found take_rows(Rows& rows) {
#if defined(__x86_64__)
  if constexpr (kStates == 8 || kStates == 16) {
    if (has_wide_lanes()) return take_rows_wide<kStates / 8>(rows);
  }
#endif
  const std::uint32_t* const entries = rows.entries;
  const std::uint8_t* tables = rows.tables;
  std::uint8_t* symbols = rows.symbols;
  const std::byte* next = rows.next;
  std::array<std::uint32_t, kStates> states;
  std::copy_n(rows.states, kStates, states.begin());
  std::uint32_t any = 0;
  for (std::size_t row = 0; row < rows.count; ++row) {
    if (next < rows.begin) return Found::kTooFewWords;
#pragma GCC unroll 16
    for (std::size_t n = 0; n < kStates; ++n) {
      const std::uint32_t symbol = take_one(entries, tables[n], states[n], next);
      any |= symbol;
      symbols[n] = static_cast<std::uint8_t>(symbol);
    }
    tables += kStates;
    symbols += kStates;
  }
  std::ranges::copy(states, rows.states);
  rows.next = next;
  return (any & 128) == 0 ? Found::kSymbols : Found::kEscapes;
}

}  // namespace

RansTables::RansTables(const ContextTables& tables) : symbols_(tables.symbols()) {
  for (const ContextTables::Frequencies& frequencies : tables.tables()) {
    std::uint32_t start = 0;
    for (std::size_t s = 0; s <= symbols_; ++s) {
      const std::uint32_t size = frequencies[s];
      Slots& slots = slots_.emplace_back();
      if (size > 0) {
        slots = {static_cast<std::uint16_t>(start), static_cast<std::uint16_t>(size),
                 ((std::uint64_t{1} << kReciprocalBits) + size - 1) / size};
      }
      const std::uint32_t name = s == symbols_ ? kEscape : static_cast<std::uint32_t>(s);
      for (std::uint32_t bias = 0; bias < size; ++bias)
        entries_.push_back(name | bias << kBiasAt | size << kSizeAt);
      start += size;
    }
    ADAMAS_ASSERT(start == kSlots);
  }
}

template <std::size_t kStates>
RansEncoder<kStates>::RansEncoder(const RansTables& tables, std::size_t expected) : tables_(tables) {
  places_.reserve(expected);
  bits_.reserve(expected / 4);
}

template <std::size_t kStates>
void RansEncoder<kStates>::put(std::span<const std::uint8_t> tables, std::span<const std::uint8_t> symbols) {
  ADAMAS_ASSERT(tables.size() == symbols.size());
  const int escaped_bits = tables_.escaped_bits();
  const std::size_t before = places_.size();
  places_.resize(before + symbols.size());
  std::uint16_t* place = places_.data() + before;
  for (std::size_t n = 0; n < symbols.size(); ++n) {
    const bool has = tables_.has(tables[n], symbols[n]);
    if (!has) put_bits(symbols[n], escaped_bits);
    *place++ = static_cast<std::uint16_t>(tables_.place(tables[n], has ? symbols[n] : tables_.symbols()));
  }
}

template <std::size_t kStates>
void RansEncoder<kStates>::finish(std::vector<std::byte>& out, std::span<const std::byte> along) const {
  ADAMAS_ASSERT(along.size() <= kAlong);
  std::array<std::uint32_t, kStates> states;
  states.fill(RansTables::kLeast);
  for (std::size_t bit = 0; bit < 8 * along.size(); ++bit) {
    // The first bit is in the state that would take the next symbol.
    std::uint32_t& state = states[(places_.size() + bit / kScaleBits) % kStates];
    state |= (std::to_integer<std::uint32_t>(along[bit / 8]) >> bit % 8 & 1) << bit % kScaleBits;
  }
  const auto words = std::make_unique_for_overwrite<std::uint16_t[]>(places_.size() + 1);
  std::uint16_t* end = words.get();
  const RansTables::Slots* const all_slots = tables_.slots();
  for (std::size_t n = places_.size(); n-- > 0;) {
    const RansTables::Slots slots = all_slots[places_[n]];
    std::uint32_t x = states[n % kStates];
    // There is no branch here, since it would be unpredictable.
    const bool high = x >= std::uint32_t{slots.size} << RansTables::kWordBits;
    *end = static_cast<std::uint16_t>(x);
    end += high ? 1 : 0;
    x >>= high ? RansTables::kWordBits : 0;
    const auto quotient = static_cast<std::uint32_t>(x * slots.reciprocal >> RansTables::kReciprocalBits);
    states[n % kStates] = (quotient << kScaleBits) + slots.start + (x - quotient * slots.size);
  }
  BitWriter bits(out);
  for (const std::uint32_t x : states) {
    const int length = static_cast<int>(std::bit_width(x)) - 1;
    bits.put(static_cast<std::uint64_t>(length - kScaleBits), kLengthBits);
    bits.put(x ^ 1u << length, length);
  }
  for (const Bits& plain : bits_) bits.put(plain.bits, plain.count);
  bits.finish();
  out.reserve(out.size() + 2 * static_cast<std::size_t>(end - words.get()));
  for (const std::uint16_t* word = words.get(); word != end; ++word) {
    out.push_back(static_cast<std::byte>(*word & 0xff));
    out.push_back(static_cast<std::byte>(*word >> 8));
  }
}

template <std::size_t kStates>
RansDecoder<kStates>::RansDecoder(const RansTables& tables, std::span<const std::byte> bytes)
    : tables_(tables),
      memory_(std::make_unique_for_overwrite<std::byte[]>(kSlack + bytes.size() + BitCursor::kSlack)),
      begin_(memory_.get() + kSlack),
      next_(begin_ + bytes.size()),
      bits_(begin_, bytes.size()) {
  std::memset(memory_.get(), 0, kSlack);
  if (!bytes.empty()) std::memcpy(memory_.get() + kSlack, bytes.data(), bytes.size());
  std::memset(memory_.get() + kSlack + bytes.size(), 0, BitCursor::kSlack);
  for (std::uint32_t& x : states_) {
    const int length = kScaleBits + static_cast<int>(bits_.take(kLengthBits));
    x = 1u << length | static_cast<std::uint32_t>(bits_.take(length));
  }
}

template <std::size_t kStates>
bool RansDecoder<kStates>::take(std::span<const std::uint8_t> tables, std::uint8_t* symbols) {
  const std::size_t count = tables.size() / kStates, whole = count * kStates, rest = tables.size() - whole;
  Rows rows{tables_.entries(), tables.data(), count, states_.data(), begin_, next_, symbols};
  const Found found = take_rows<kStates>(rows);
  if (found == Found::kTooFewWords || rows.next < begin_) return false;
  bool any_escape = found == Found::kEscapes;
  for (std::size_t n = 0; n < rest; ++n) {
    symbols[whole + n] =
        static_cast<std::uint8_t>(take_one(tables_.entries(), tables[whole + n], states_[n], rows.next));
    any_escape = any_escape || symbols[whole + n] == RansTables::kEscape;
  }
  next_ = rows.next;
  // The next symbol belongs to the first state again.
  std::rotate(states_.begin(), states_.begin() + static_cast<std::ptrdiff_t>(rest), states_.end());
  return !any_escape || take_escaped(tables, symbols);
}

/// Replaces escapes by their symbols.
template <std::size_t kStates>
bool RansDecoder<kStates>::take_escaped(std::span<const std::uint8_t> tables, std::uint8_t* symbols) {
  for (std::size_t n = 0; n < tables.size(); ++n) {
    if (symbols[n] != RansTables::kEscape) continue;
    symbols[n] = static_cast<std::uint8_t>(bits_.take(tables_.escaped_bits()));
    if (symbols[n] >= tables_.symbols() || tables_.has(tables[n], symbols[n])) return false;
  }
  return true;
}

template <std::size_t kStates>
bool RansDecoder<kStates>::at_end() const {
  return next_ == bits_.end() &&
         std::ranges::all_of(states_, [](std::uint32_t x) { return x == RansTables::kLeast; });
}

template <std::size_t kStates>
bool RansDecoder<kStates>::take_along(std::span<std::byte, RansEncoder<kStates>::kAlong> along) const {
  std::uint64_t bits = 0;
  int count = 0;
  std::size_t at = 0;
  for (const std::uint32_t x : states_) {
    if (x >> kScaleBits != 1) return false;
    bits |= std::uint64_t{x ^ RansTables::kLeast} << count;
    for (count += kScaleBits; count >= 8; count -= 8) {
      along[at++] = static_cast<std::byte>(bits);
      bits >>= 8;
    }
  }
  return next_ == bits_.end();
}

template class RansEncoder<4>;
template class RansEncoder<8>;
template class RansEncoder<16>;
template class RansDecoder<4>;
template class RansDecoder<8>;
template class RansDecoder<16>;

}  // namespace adamas::isosurface
