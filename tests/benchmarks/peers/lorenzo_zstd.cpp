#include <zstd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "tests/benchmarks/peers/block_coder.h"

namespace adamas::bench {
namespace {

/// Calls f with a number of the samples' type.
template <class F>
void with_word(std::size_t bytes, F&& f) {
  if (bytes == 1) return f(std::uint8_t{});
  if (bytes == 2) return f(std::uint16_t{});
  return f(std::uint32_t{});
}

/// Maps numbers near zero, of either sign, to small unsigned ones.
template <class Word>
Word folded(Word residual) {
  const bool negative = residual >> (8 * sizeof(Word) - 1) != 0;
  return static_cast<Word>(residual << 1 ^ (negative ? ~0u : 0u));
}

template <class Word>
Word unfolded(Word number) {
  return static_cast<Word>(number >> 1 ^ (0u - (number & 1u)));
}

/// Replaces samples by differences along one axis. After all three axes these are the residuals of the
/// Lorenzo predictor, from which sums restore the samples.
template <class Word>
void difference(Word* samples, std::size_t count, std::size_t stride, std::size_t side) {
  for (std::size_t n = count; n-- > 0;)
    if (n / stride % side != 0) samples[n] = static_cast<Word>(samples[n] - samples[n - stride]);
}

template <class Word>
void sum(Word* samples, std::size_t count, std::size_t stride, std::size_t side) {
  for (std::size_t begin = 0; begin < count; begin += stride * side) {
    Word* row = samples + begin;
    for (std::size_t n = stride; n < stride * side; ++n) row[n] = static_cast<Word>(row[n] + row[n - stride]);
  }
}

template <class Word>
void encode_words(const BlockShape& shape, Word* words) {
  const auto [nx, ny, nz] = shape.sides;
  const std::size_t count = shape.samples();
  difference(words, count, 1, nx);
  difference(words, count, nx, ny);
  difference(words, count, nx * ny, nz);
  std::for_each(words, words + count, [](Word& word) { word = folded(word); });
}

template <class Word>
void decode_words(const BlockShape& shape, Word* words) {
  const auto [nx, ny, nz] = shape.sides;
  const std::size_t count = shape.samples();
  std::for_each(words, words + count, [](Word& word) { word = unfolded(word); });
  sum(words, count, nx * ny, nz);
  sum(words, count, nx, ny);
  sum(words, count, 1, nx);
}

class LorenzoZstd final : public BlockCoder {
 public:
  LorenzoZstd() : encoder_(ZSTD_createCCtx()), decoder_(ZSTD_createDCtx()) {
    ZSTD_CCtx_setParameter(encoder_, ZSTD_c_compressionLevel, 19);
    ZSTD_CCtx_setParameter(encoder_, ZSTD_c_contentSizeFlag, 0);
  }
  ~LorenzoZstd() override {
    ZSTD_freeCCtx(encoder_);
    ZSTD_freeDCtx(decoder_);
  }
  LorenzoZstd(const LorenzoZstd&) = delete;
  LorenzoZstd& operator=(const LorenzoZstd&) = delete;

  [[nodiscard]] std::string name() const override { return "Lorenzo + zstd -19"; }

  [[nodiscard]] std::array<std::size_t, 3> sides(const std::array<std::size_t, 3>&) const override {
    return {16, 16, 16};
  }

  void encode(const BlockShape& shape, std::span<const std::byte> samples,
              std::vector<std::byte>& code) override {
    words_.resize(shape.samples());
    planes_.resize(shape.size());
    std::memcpy(words_.data(), samples.data(), shape.size());
    with_word(shape.bytes,
              [&](auto word) { encode_words(shape, reinterpret_cast<decltype(word)*>(words_.data())); });
    const auto* bytes = reinterpret_cast<const std::byte*>(words_.data());
    for (std::size_t n = 0; n < shape.size(); ++n)
      planes_[n % shape.bytes * shape.samples() + n / shape.bytes] = bytes[n];
    const std::size_t begin = code.size();
    code.resize(begin + ZSTD_compressBound(planes_.size()));
    code.resize(begin + checked(ZSTD_compress2(encoder_, code.data() + begin, code.size() - begin,
                                               planes_.data(), planes_.size())));
  }

  void decode(const BlockShape& shape, std::span<const std::byte> code,
              std::span<std::byte> samples) override {
    planes_.resize(shape.size());
    std::byte* const first = shape.bytes == 1 ? samples.data() : planes_.data();
    checked(ZSTD_decompressDCtx(decoder_, first, shape.size(), code.data(), code.size()));
    if (shape.bytes > 1) {
      for (std::size_t plane = 0; plane < shape.bytes; ++plane)
        for (std::size_t n = 0; n < shape.samples(); ++n)
          samples[n * shape.bytes + plane] = planes_[plane * shape.samples() + n];
    }
    with_word(shape.bytes,
              [&](auto word) { decode_words(shape, reinterpret_cast<decltype(word)*>(samples.data())); });
  }

 private:
  static std::size_t checked(std::size_t size) {
    if (ZSTD_isError(size) != 0) throw std::runtime_error(ZSTD_getErrorName(size));
    return size;
  }

  ZSTD_CCtx* encoder_;
  ZSTD_DCtx* decoder_;
  std::vector<std::uint32_t> words_;  ///< samples of any type; words of 32 bits give the alignment
  std::vector<std::byte> planes_;
};

}  // namespace

std::unique_ptr<BlockCoder> lorenzo_zstd() { return std::make_unique<LorenzoZstd>(); }

}  // namespace adamas::bench
