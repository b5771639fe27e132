#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace adamas::bench {

/// A block of samples, i running fastest. Samples are unsigned numbers of `bytes` bytes, of which `bits` bits
/// are used.
struct BlockShape {
  std::array<std::size_t, 3> sides{};
  std::size_t bytes = 1;
  int bits = 8;

  [[nodiscard]] std::size_t samples() const { return sides[0] * sides[1] * sides[2]; }
  [[nodiscard]] std::size_t size() const { return samples() * bytes; }
};

/// A lossless coder by others that codes a block of samples at a time. Each block can be decoded without the
/// others, as a page of a store can.
class BlockCoder {
 public:
  virtual ~BlockCoder() = default;

  [[nodiscard]] virtual std::string name() const = 0;
  /// Returns the sides of all blocks of a volume except those that its border cuts.
  [[nodiscard]] virtual std::array<std::size_t, 3> sides(const std::array<std::size_t, 3>& volume) const = 0;
  /// Appends the code of a block.
  virtual void encode(const BlockShape& shape, std::span<const std::byte> samples,
                      std::vector<std::byte>& code) = 0;
  /// Decodes what encode() has appended.
  virtual void decode(const BlockShape& shape, std::span<const std::byte> code,
                      std::span<std::byte> samples) = 0;
};

/// Returns JPEG-LS by CharLS. Whole rows, together some 4096 samples, are one picture. Samples of four bytes
/// are two pictures, of their high and their low halves, since JPEG-LS has at most 16 bits.
std::unique_ptr<BlockCoder> jpeg_ls();
/// Returns the Lorenzo predictor in bricks of 16^3, with the residuals' bytes in planes, and zstd at level
/// 19.
std::unique_ptr<BlockCoder> lorenzo_zstd();

}  // namespace adamas::bench
