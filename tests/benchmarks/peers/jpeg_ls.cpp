#include <charls/charls.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "tests/benchmarks/peers/block_coder.h"

namespace adamas::bench {
namespace {

constexpr std::size_t kHalfBytes = 2;

class JpegLs final : public BlockCoder {
 public:
  [[nodiscard]] std::string name() const override { return "JPEG-LS"; }

  [[nodiscard]] std::array<std::size_t, 3> sides(const std::array<std::size_t, 3>& volume) const override {
    return {volume[0], std::clamp<std::size_t>(4096 / volume[0], 1, volume[1]), 1};
  }

  void encode(const BlockShape& shape, std::span<const std::byte> samples,
              std::vector<std::byte>& code) override {
    if (shape.bytes <= kHalfBytes) {
      encode_picture(shape, shape.bits, samples, code);
      return;
    }
    for (const std::size_t half : {kHalfBytes, std::size_t{0}}) {
      take_half(samples, half);
      encode_picture({shape.sides, kHalfBytes, 16}, 16, half_, code);
    }
  }

  void decode(const BlockShape& shape, std::span<const std::byte> code,
              std::span<std::byte> samples) override {
    if (shape.bytes <= kHalfBytes) {
      decode_picture(code, samples);
      return;
    }
    half_.resize(shape.samples() * kHalfBytes);
    std::size_t at = 0;
    for (const std::size_t half : {kHalfBytes, std::size_t{0}}) {
      at += decode_picture(code.subspan(at), half_);
      for (std::size_t n = 0; n < shape.samples(); ++n)
        std::memcpy(samples.data() + 4 * n + half, half_.data() + kHalfBytes * n, kHalfBytes);
    }
  }

 private:
  void take_half(std::span<const std::byte> samples, std::size_t half) {
    half_.resize(samples.size() / 2);
    for (std::size_t n = 0; n < samples.size() / 4; ++n)
      std::memcpy(half_.data() + kHalfBytes * n, samples.data() + 4 * n + half, kHalfBytes);
  }

  static void encode_picture(const BlockShape& shape, int bits, std::span<const std::byte> samples,
                             std::vector<std::byte>& code) {
    charls::jpegls_encoder encoder;
    encoder.encoding_options(charls::encoding_options::none);
    encoder.frame_info({static_cast<std::uint32_t>(shape.sides[0]),
                        static_cast<std::uint32_t>(shape.sides[1] * shape.sides[2]), std::max(bits, 2), 1});
    const std::size_t begin = code.size();
    code.resize(begin + encoder.estimated_destination_size());
    encoder.destination(code.data() + begin, code.size() - begin);
    code.resize(begin + encoder.encode(samples.data(), samples.size()));
  }

  /// Returns the number of bytes of the picture's code.
  static std::size_t decode_picture(std::span<const std::byte> code, std::span<std::byte> samples) {
    charls::jpegls_decoder decoder(code.data(), code.size(), true);
    decoder.decode(samples.data(), samples.size());
    // The end of a picture is marked by bytes that its code cannot contain.
    for (std::size_t n = 0; n + 1 < code.size(); ++n)
      if (code[n] == std::byte{0xff} && code[n + 1] == std::byte{0xd9}) return n + 2;
    throw std::runtime_error("JPEG-LS: a picture has no end");
  }

  std::vector<std::byte> half_;
};

}  // namespace

std::unique_ptr<BlockCoder> jpeg_ls() { return std::make_unique<JpegLs>(); }

}  // namespace adamas::bench
