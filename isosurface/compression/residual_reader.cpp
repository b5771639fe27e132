#include "isosurface/compression/residual_reader.h"

#include <algorithm>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "core/base/assert.h"
#include "core/base/simd.h"
#include "isosurface/compression/parity_cells.h"

namespace adamas {

template <class Word>
ResidualReader<Word>::ResidualReader(const RangeTables& tables, std::span<const std::byte> bytes)
    : tables_(tables), size_(bytes.size()) {
  ADAMAS_ASSERT(size_ <= kMostBytes);
  std::byte* const page = buffer_.data() + RangeDecoder::kSlack;
  std::memset(buffer_.data(), 0, RangeDecoder::kSlack);
  std::memcpy(page, bytes.data(), size_);
  std::memset(page + size_, 0, sizeof(std::uint64_t));
  RangeTables::States states;
  for (std::uint32_t& x : states) {
    const int length = kLeastBits + static_cast<int>(take(kLengthBits));
    x = 1u << length | static_cast<std::uint32_t>(take(length));
  }
  decoder_.emplace(tables_, states, page, page + size_);
}

template <class Word>
bool ResidualReader<Word>::take(std::span<const std::uint8_t> groups, Word* folded) {
  if constexpr (sizeof(Word) == 1) {
    return decoder_->take(groups, folded) && join(groups, folded, folded);
  } else {
    std::array<std::uint8_t, PageGrid::kPoints> symbols;
    return decoder_->take(groups, symbols.data()) && join(groups, symbols.data(), folded);
  }
}

template <class Word>
bool ResidualReader<Word>::at_end() const {
  const std::size_t bytes = (taken_ + 7) / 8;
  if (!decoder_->at_start() || !any_ || decoder_->words() != begin() + bytes) return false;
  return taken_ % 8 == 0 || std::to_integer<unsigned>(begin()[bytes - 1]) >> taken_ % 8 == 0;
}

template <class Word>
bool ResidualReader<Word>::join(Symbols groups, const std::uint8_t* symbols, Word* folded) {
  std::size_t n = 0;
  bool good = true;
  with_wide_lanes([&](auto bytes) {
    for (; good && n + 8 <= groups.size(); n += 8)
      good = join_eight<bytes == 32>(groups.data() + n, symbols + n, folded + n);
  });
  if (!good) return false;
  for (; n < groups.size(); ++n) {
    any_ = any_ || symbols[n] != 0;
    if (!join_one(groups[n], symbols[n], folded[n])) return false;
  }
  return true;
}

template <class Word>
template <bool Wide>
bool ResidualReader<Word>::join_eight(const std::uint8_t* groups, const std::uint8_t* symbols, Word* folded) {
  constexpr RowBytes kOpen = kEachByte * 0xf0, kEscapes = kEachByte * Token::kEscape;
  static_assert(Token::kDirect == 16);
  const RowBytes eight = load_row(symbols);
  any_ = any_ || eight != 0;
  if ((eight & kOpen) == 0) {
    if constexpr (sizeof(Word) > 1) std::copy_n(symbols, 8, folded);
    return true;
  }
  if (~bytes_not_zero(eight ^ kEscapes) == 0) {
    if constexpr (sizeof(Word) < 4 && Wide) {
      join_tokens_wide(symbols, folded);
    } else {
      join_tokens(symbols, folded);
    }
    return true;
  }
  for (std::size_t n = 0; n < 8; ++n) {
    if (!join_one(groups[n], symbols[n], folded[n])) return false;
  }
  return true;
}

template <class Word>
bool ResidualReader<Word>::join_one(std::size_t group, int symbol, Word& folded) {
  if (symbol == Token::kEscape) {
    symbol = static_cast<int>(take(Token::kTokenBits));
    if (tables_.has(group, static_cast<std::size_t>(symbol))) return false;
  }
  folded = Token::join(symbol, static_cast<Word>(take(Token::extra_bits(symbol))));
  return true;
}

template <class Word>
void ResidualReader<Word>::join_tokens(const std::uint8_t* symbols, Word* folded) {
  for (std::size_t n = 0; n < 8; ++n) {
    const int token = symbols[n];
    folded[n] = Token::join(token, static_cast<Word>(take(Token::extra_bits(token))));
  }
}

#if defined(__x86_64__)
namespace {

[[gnu::target("avx2")]] inline __m256i all(int number) { return _mm256_set1_epi32(number); }

}  // namespace

/// The bits of each begin where those of all before it end, and are gathered from there.
template <class Word>
[[gnu::target("avx2")]] void ResidualReader<Word>::join_tokens_wide(const std::uint8_t* symbols,
                                                                    Word* folded) {
  const __m256i token = _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(symbols)));
  const __m256i exponent = _mm256_srli_epi32(_mm256_sub_epi32(token, all(Token::kDirect)), 2);
  const __m256i is_open = _mm256_cmpgt_epi32(token, all(Token::kDirect - 1));
  const __m256i open = _mm256_and_si256(_mm256_add_epi32(exponent, all(2)), is_open);
  // How many bits all up to each have, within four and then beyond.
  __m256i sum = _mm256_add_epi32(open, _mm256_slli_si256(open, 4));
  sum = _mm256_add_epi32(sum, _mm256_slli_si256(sum, 8));
  const __m256i lower = _mm256_permutevar8x32_epi32(sum, all(3));
  sum = _mm256_add_epi32(sum, _mm256_blend_epi32(_mm256_setzero_si256(), lower, 0xf0));
  const std::size_t first = next_byte();
  const __m256i from = _mm256_add_epi32(_mm256_sub_epi32(sum, open), all(static_cast<int>(taken_ % 8)));
  // Not beyond the zeros after the page.
  const __m256i byte = _mm256_min_epi32(_mm256_srli_epi32(from, 3), all(static_cast<int>(size_ + 4 - first)));
  const __m256i word = _mm256_i32gather_epi32(reinterpret_cast<const int*>(begin() + first), byte, 1);
  const __m256i bits = _mm256_srlv_epi32(word, _mm256_and_si256(from, all(7)));
  const __m256i mask = _mm256_sub_epi32(_mm256_sllv_epi32(all(1), open), all(1));
  const __m256i leading = _mm256_or_si256(_mm256_and_si256(token, all(3)), all(4));
  const __m256i base = _mm256_blendv_epi8(token, _mm256_sllv_epi32(leading, open), is_open);
  const __m256i joined = _mm256_or_si256(base, _mm256_and_si256(bits, mask));
  taken_ += static_cast<unsigned>(_mm256_extract_epi32(sum, 7));
  const __m128i words = _mm_packus_epi32(_mm256_castsi256_si128(joined), _mm256_extracti128_si256(joined, 1));
  if constexpr (sizeof(Word) == 1) {
    _mm_storel_epi64(reinterpret_cast<__m128i*>(folded), _mm_packus_epi16(words, words));
  } else {
    _mm_storeu_si128(reinterpret_cast<__m128i*>(folded), words);
  }
}
#else
template <class Word>
void ResidualReader<Word>::join_tokens_wide(const std::uint8_t* symbols, Word* folded) {
  join_tokens(symbols, folded);
}
#endif

template class ResidualReader<std::uint8_t>;
template class ResidualReader<std::uint16_t>;
template class ResidualReader<std::uint32_t>;

}  // namespace adamas
