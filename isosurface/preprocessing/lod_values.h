#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/assert.h"
#include "core/lattice/lattice_point.h"

namespace adamas::isosurface {

/// The values of the points of one LOD, in the planes of k that are being processed or in all of them.
/// Coordinates are in units of the LOD. Word: OrderedWord of the samples' type.
template <class Word>
class LodValues {
 public:
  static constexpr Word kGreatest = std::numeric_limits<Word>::max();

  /// Makes room for `size` points per axis, of which `planes` planes are held at a time: plane z replaces
  /// plane z - planes.
  LodValues(LatticePoint size, int planes, bool with_samples)
      : size_(size),
        planes_(std::min(size.k, planes)),
        stride_(static_cast<std::size_t>(size.i) + 1),
        plane_(stride_ * static_cast<std::size_t>(size.j)) {
    const std::size_t total = plane_ * static_cast<std::size_t>(planes_) + 1;
    codes_.assign(total, 0);
    low_.assign(total, kGreatest);
    high_.assign(total, 0);
    if (with_samples) samples_.assign(total, 0);
  }

  [[nodiscard]] LatticePoint size() const { return size_; }

  /// Clears plane z, which replaces another plane.
  void open(std::int32_t z) {
    const auto begin = static_cast<std::ptrdiff_t>(offset(0, z)), count = static_cast<std::ptrdiff_t>(plane_);
    std::fill_n(codes_.begin() + begin, count, std::uint8_t{0});
    std::fill_n(low_.begin() + begin, count, kGreatest);
    std::fill_n(high_.begin() + begin, count, Word{0});
  }

  /// Returns the samples of a row of plane z. low() and high() return its ranges: low > high where there is
  /// no sample.
  [[nodiscard]] Word* samples(std::int32_t j, std::int32_t z) { return samples_.data() + offset(j, z); }
  [[nodiscard]] const Word* samples(std::int32_t j, std::int32_t z) const {
    return samples_.data() + offset(j, z);
  }
  [[nodiscard]] Word* low(std::int32_t j, std::int32_t z) { return low_.data() + offset(j, z); }
  [[nodiscard]] Word* high(std::int32_t j, std::int32_t z) { return high_.data() + offset(j, z); }
  /// Returns the error codes of a row.
  [[nodiscard]] std::uint8_t* codes(std::int32_t j, std::int32_t z) { return codes_.data() + offset(j, z); }

  /// Returns the diamond's own code. Any thread may call this.
  [[nodiscard]] std::uint8_t own(LatticePoint p) {
    return std::atomic_ref<std::uint8_t>(codes(p.j, p.k)[p.i]).load(std::memory_order_relaxed);
  }
  /// Raises the diamond's own code to `code`, if that is greater. Any thread may call this.
  void raise(LatticePoint p, std::uint8_t code) {
    const std::atomic_ref<std::uint8_t> own(codes(p.j, p.k)[p.i]);
    std::uint8_t old = own.load(std::memory_order_relaxed);
    while (old < code && !own.compare_exchange_weak(old, code, std::memory_order_relaxed)) {
    }
  }

 private:
  [[nodiscard]] std::size_t offset(std::int32_t j, std::int32_t z) const {
    ADAMAS_ASSERT(j >= 0 && j < size_.j && z >= 0 && z < size_.k);
    return static_cast<std::size_t>(z % planes_) * plane_ + static_cast<std::size_t>(j) * stride_;
  }

  LatticePoint size_;
  int planes_;
  std::size_t stride_, plane_;
  std::vector<std::uint8_t> codes_;
  std::vector<Word> samples_, low_, high_;
};

/// The samples whose coordinates are multiples of 16, and those that stand for points beyond the data.
template <class Word>
class CoarseSamples {
 public:
  static constexpr int kBits = 4;

  explicit CoarseSamples(LatticePoint last)
      : last_(last),
        end_{(last.i + 15) >> kBits, (last.j + 15) >> kBits, (last.k + 15) >> kBits},
        words_((static_cast<std::size_t>(end_.i) + 1) * (static_cast<std::size_t>(end_.j) + 1) *
               (static_cast<std::size_t>(end_.k) + 1)) {}

  /// Returns the number of planes that samples are taken from; plane(n) is the nth of them.
  [[nodiscard]] std::int32_t planes() const { return end_.k + 1; }
  [[nodiscard]] std::int32_t plane(std::int32_t n) const { return std::min(n << kBits, last_.k); }
  /// Copies samples of plane(n).
  void take(std::int32_t n, const Word* samples) {
    const std::size_t row = static_cast<std::size_t>(last_.i) + 1;
    for (std::int32_t j = 0; j <= end_.j; ++j) {
      const Word* from = samples + row * static_cast<std::size_t>(std::min(j << kBits, last_.j));
      for (std::int32_t i = 0; i <= end_.i; ++i)
        words_[place({i, j, n})] = from[std::min(i << kBits, last_.i)];
    }
  }

  /// Returns the sample at a point whose coordinates are multiples of 16; it may lie anywhere beyond the
  /// data.
  [[nodiscard]] Word at(LatticePoint p) const {
    return words_[place(
        {std::min(p.i >> kBits, end_.i), std::min(p.j >> kBits, end_.j), std::min(p.k >> kBits, end_.k)})];
  }

 private:
  [[nodiscard]] std::size_t place(LatticePoint q) const {
    const auto row = static_cast<std::size_t>(end_.i) + 1, rows = static_cast<std::size_t>(end_.j) + 1;
    return static_cast<std::size_t>(q.i) +
           row * (static_cast<std::size_t>(q.j) + rows * static_cast<std::size_t>(q.k));
  }

  LatticePoint last_, end_;
  std::vector<Word> words_;
};

}  // namespace adamas::isosurface
