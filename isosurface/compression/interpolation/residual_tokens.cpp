#include "isosurface/compression/interpolation/residual_tokens.h"

#include <algorithm>
#include <array>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "core/base/assert.h"
#include "core/base/simd.h"
#include "isosurface/compression/parity_cells.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

template <class Word>
void ResidualWriter<Word>::put(std::span<const std::uint8_t> tables, const Word* folded,
                               const std::uint8_t* prevailing) {
  using Token = ResidualToken<Word>;
  ADAMAS_ASSERT(tables.size() <= PageGrid::kPoints);
  std::array<std::uint8_t, PageGrid::kPoints> tokens;
  const auto is_prevailing = [&](std::size_t n) { return prevailing != nullptr && prevailing[n] != 0; };
  for (std::size_t n = 0; n < tables.size(); ++n)
    tokens[n] = static_cast<std::uint8_t>(is_prevailing(n) ? Token::kPrevailing : Token::token(folded[n]));
  encoder_.put(tables, std::span(tokens).first(tables.size()));
  for (std::size_t n = 0; n < tables.size(); ++n) {
    if (tokens[n] < Token::kDirect || is_prevailing(n)) continue;
    const int open = Token::extra_bits(tokens[n]);
    encoder_.put_bits(folded[n] & ((std::uint64_t{1} << open) - 1), open);
  }
}

template <class Word>
bool ResidualReader<Word>::take(std::span<const std::uint8_t> tables, Word* folded) {
  if constexpr (sizeof(Word) == 1) {
    if (!decoder_.take(tables, folded)) return false;
    extract_prevailing(folded, tables.size());
    join(folded, tables.size(), folded);
  } else {
    ADAMAS_ASSERT(tables.size() <= PageGrid::kPoints);
    std::array<std::uint8_t, PageGrid::kPoints> tokens;
    if (!decoder_.take(tables, tokens.data())) return false;
    join(tokens.data(), tables.size(), folded);
  }
  return true;
}

template <class Word>
void ResidualReader<Word>::extract_prevailing(Word* tokens, std::size_t count) {
  if constexpr (Token::kHasPrevailing) {
    constexpr int kShift = std::countr_zero(unsigned{Token::kPrevailing});
    constexpr RowBytes kOthers = kEachByte * (Token::kPrevailing - 1);
    RowBytes any = 0;
    std::size_t n = 0;
    for (; n + 8 <= count; n += 8) any |= load_row(tokens + n);
    for (; n < count; ++n) any |= tokens[n];
    any_prevailing_ = (any & ~kOthers) != 0;
    if (!any_prevailing_) return;
    for (n = 0; n + 8 <= count; n += 8) {
      const RowBytes row = load_row(tokens + n);
      store_row(row >> kShift & kEachByte, prevailing_.data() + n);
      store_row(row & kOthers, tokens + n);
    }
    for (; n < count; ++n) {
      prevailing_[n] = static_cast<std::uint8_t>(tokens[n] >> kShift);
      tokens[n] &= static_cast<Word>(Token::kPrevailing - 1);
    }
    any_ = any_ || any_prevailing_;
  }
}

template <class Word>
void ResidualReader<Word>::join(const std::uint8_t* tokens, std::size_t count, Word* folded) {
  std::size_t n = 0;
  with_wide_lanes([&](auto bytes) {
    for (; n + 8 <= count; n += 8) join_eight<bytes == 32>(tokens + n, folded + n);
  });
  for (; n < count; ++n) {
    any_ = any_ || tokens[n] != 0;
    folded[n] = join_one(tokens[n]);
  }
}

template <class Word>
template <bool Wide>
void ResidualReader<Word>::join_eight(const std::uint8_t* tokens, Word* folded) {
  constexpr RowBytes kOpen = kEachByte * 0xf0;
  static_assert(Token::kDirect == 16);
  const RowBytes eight = load_row(tokens);
  any_ = any_ || eight != 0;
  if ((eight & kOpen) == 0) {
    if constexpr (sizeof(Word) > 1) std::copy_n(tokens, 8, folded);
  } else if constexpr (sizeof(Word) < 4 && Wide) {
    join_open_wide(tokens, folded);
  } else {
    for (std::size_t n = 0; n < 8; ++n) folded[n] = join_one(tokens[n]);
  }
}

#if defined(__x86_64__)
namespace {

[[gnu::target("avx2")]] inline __m256i all(int number) { return _mm256_set1_epi32(number); }

}  // namespace

/// Joins eight tokens with their extra bits. The bits of each token begin where those of the one before it
/// end.
template <class Word>
[[gnu::target("avx2")]] void ResidualReader<Word>::join_open_wide(const std::uint8_t* tokens, Word* folded) {
  const __m256i token = _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(tokens)));
  const __m256i exponent = _mm256_srli_epi32(_mm256_sub_epi32(token, all(Token::kDirect)), 2);
  const __m256i is_open = _mm256_cmpgt_epi32(token, all(Token::kDirect - 1));
  const __m256i open = _mm256_and_si256(_mm256_add_epi32(exponent, all(2)), is_open);
  // These are prefix sums of the numbers of bits, first within four tokens, then within eight.
  __m256i sum = _mm256_add_epi32(open, _mm256_slli_si256(open, 4));
  sum = _mm256_add_epi32(sum, _mm256_slli_si256(sum, 8));
  const __m256i lower = _mm256_permutevar8x32_epi32(sum, all(3));
  sum = _mm256_add_epi32(sum, _mm256_blend_epi32(_mm256_setzero_si256(), lower, 0xf0));
  BitCursor& plain = decoder_.bits();
  const __m256i from =
      _mm256_add_epi32(_mm256_sub_epi32(sum, open), all(static_cast<int>(plain.taken() % 8)));
  // Bits beyond the end are zeros.
  const __m256i byte = _mm256_min_epi32(_mm256_srli_epi32(from, 3), all(static_cast<int>(plain.left() + 4)));
  const __m256i word = _mm256_i32gather_epi32(reinterpret_cast<const int*>(plain.next()), byte, 1);
  const __m256i bits = _mm256_srlv_epi32(word, _mm256_and_si256(from, all(7)));
  const __m256i mask = _mm256_sub_epi32(_mm256_sllv_epi32(all(1), open), all(1));
  const __m256i leading = _mm256_or_si256(_mm256_and_si256(token, all(3)), all(4));
  const __m256i base = _mm256_blendv_epi8(token, _mm256_sllv_epi32(leading, open), is_open);
  const __m256i joined = _mm256_or_si256(base, _mm256_and_si256(bits, mask));
  plain.skip(static_cast<unsigned>(_mm256_extract_epi32(sum, 7)));
  const __m128i words = _mm_packus_epi32(_mm256_castsi256_si128(joined), _mm256_extracti128_si256(joined, 1));
  if constexpr (sizeof(Word) == 1) {
    _mm_storel_epi64(reinterpret_cast<__m128i*>(folded), _mm_packus_epi16(words, words));
  } else {
    _mm_storeu_si128(reinterpret_cast<__m128i*>(folded), words);
  }
}
#else
template <class Word>
void ResidualReader<Word>::join_open_wide(const std::uint8_t* tokens, Word* folded) {
  for (std::size_t n = 0; n < 8; ++n) folded[n] = join_one(tokens[n]);
}
#endif

ADAMAS_INSTANTIATE_FOR_WORDS(ResidualWriter);
ADAMAS_INSTANTIATE_FOR_WORDS(ResidualReader);

}  // namespace adamas::isosurface
