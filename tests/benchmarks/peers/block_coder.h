#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace adamas::bench {

/// Samples side by side, i running fastest: unsigned numbers of `bytes` bytes, of which `bits` bits are used.
struct BlockShape {
  std::array<std::size_t, 3> sides{};
  std::size_t bytes = 1;
  int bits = 8;

  [[nodiscard]] std::size_t samples() const { return sides[0] * sides[1] * sides[2]; }
  [[nodiscard]] std::size_t size() const { return samples() * bytes; }
};

/// A lossless coder that others have made, of a block of samples at a time: each can be decoded without the
/// others, as a page of a store can.
class BlockCoder {
 public:
  virtual ~BlockCoder() = default;

  [[nodiscard]] virtual std::string name() const = 0;
  /// The sides of all blocks of a volume, but for those that its border cuts.
  [[nodiscard]] virtual std::array<std::size_t, 3> sides(const std::array<std::size_t, 3>& volume) const = 0;
  /// Appends the code of a block.
  virtual void encode(const BlockShape& shape, std::span<const std::byte> samples,
                      std::vector<std::byte>& code) = 0;
  /// The inverse.
  virtual void decode(const BlockShape& shape, std::span<const std::byte> code,
                      std::span<std::byte> samples) = 0;
};

/// JPEG-LS by CharLS: of whole rows, together some 4096 samples, as one picture. Samples of four bytes are
/// two pictures, of their high and their low halves: JPEG-LS ends at 16 bits.
std::unique_ptr<BlockCoder> jpeg_ls();
/// The Lorenzo predictor in bricks of 16^3, the residuals' bytes in planes, zstd at level 19.
std::unique_ptr<BlockCoder> lorenzo_zstd();

}  // namespace adamas::bench
