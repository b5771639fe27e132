#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/base/simd.h"
#include "isosurface/compression/interpolation/interpolation_prediction.h"
#include "isosurface/compression/interpolation/residual_tokens.h"
#include "isosurface/compression/parity_cells.h"
#include "isosurface/volume/page.h"

namespace adamas::isosurface {

/// A page on its way to residuals or back, set by set: `predict`, then `residuals` or what was decoded, then
/// `apply`. Residuals are folded (ResidualToken) and lie by parity, then by point, i running fastest.
template <class Depth>
class InterpolationPage {
 public:
  using Word = typename Depth::Word;
  using Samples = PagePoints<Word>;
  using Around = typename Surroundings<Word>::template Points<Word>;
  using Cells = InterpolationCells<Depth>;
  using Value = typename Cells::Value;
  static constexpr std::size_t kMostInSet = 3 * 512;

  InterpolationPage(LatticePoint count, const Around& around) : count_(count) {
    // Loops also run over cells without a point. Their results are not used, but memory that was never
    // written must not be read, and `steps` is the only such array.
    cells_.steps.fill(0);
    for (std::size_t n = 0; n < around.size(); ++n) cells_.values[0][n] = Depth::value(around[n]);
    for (typename Cells::Cells& residuals : cells_.residuals) residuals.fill(0);
  }

  /// Number of residuals of a set.
  [[nodiscard]] std::size_t size(int set) const {
    std::size_t total = 0;
    for (int n = 0; n < Cells::parities(set); ++n) total += static_cast<std::size_t>(box(set, n).size());
    return total;
  }

  void predict(int set) { InterpolationPrediction<Depth>::predict(set, (count_.k + 1) / 2, cells_); }

  /// Adds to the activity round each point of the set, in the bits above it, the class of its prediction by
  /// the distance from the volume's prevailing sample. Bytes: see with_wide_lanes.
  template <std::size_t Bytes>
  void add_prevailing_classes(int set, Word prevailing) {
    using Lanes = Simd<Value, Bytes>;
    // The cells of the page's own points, and what lies between.
    constexpr std::size_t kBegin = kFirstCell;
    const std::size_t end = static_cast<std::size_t>((count_.k + 1) / 2 * Cells::kPlane + 97);
    const Value centre = Depth::value(prevailing);
    for (int n = 0; n < Cells::parities(set); ++n) {
      const Value* const values = cells_.values[parity(set, n)].data();
      Value* const activity = cells_.activity[static_cast<std::size_t>(n)].data();
      std::size_t cell = kBegin;
      for (; cell + Lanes::kCount <= end; cell += Lanes::kCount) {
        const auto value = Lanes::load(values + cell), middle = typename Lanes::Numbers{} + centre;
        const auto distance = Lanes::greater(value, middle) - Lanes::lesser(value, middle);
        Lanes::store(Lanes::load(activity + cell) + ActivityContext<Depth>::class_of(distance),
                     activity + cell);
      }
      for (; cell < end; ++cell) {
        const auto distance =
            static_cast<Value>(std::max(values[cell], centre) - std::min(values[cell], centre));
        activity[cell] = static_cast<Value>(activity[cell] + ActivityContext<Depth>::class_of(distance));
      }
    }
  }

  /// What `of` makes of the activity round each point.
  template <class Of>
  void contexts(int set, Of&& of, std::uint8_t* contexts) const {
    for (int n = 0; n < Cells::parities(set); ++n) {
      const Value* const activity = cells_.activity[static_cast<std::size_t>(n)].data();
      box(set, n).for_each_row([&](std::size_t cell, std::size_t before, auto row) {
        for (std::size_t i = 0; i < static_cast<std::size_t>(row); ++i)
          contexts[before + i] = of(activity[cell + i]);
      });
      contexts += box(set, n).size();
    }
  }

  void residuals(int set, const Samples& samples, Word* folded) const {
    for (int n = 0; n < Cells::parities(set); ++n) {
      const Value* const values = cells_.values[parity(set, n)].data();
      const Word* const first = samples.data() + sample(parity(set, n));
      box(set, n).for_each_row([&](std::size_t cell, std::size_t before, auto row) {
        const Word* const from = first + sample_row(cell);
        for (std::size_t i = 0; i < static_cast<std::size_t>(row); ++i) {
          folded[before + i] =
              ResidualToken<Word>::fold(static_cast<Word>(from[2 * i] - Depth::word(values[cell + i])));
        }
      });
      folded += box(set, n).size();
    }
  }

  /// 1 for points whose sample is the prevailing one and was not predicted, 0 for others.
  void find_prevailing(int set, const Samples& samples, Word prevailing, std::uint8_t* found) const {
    for (int n = 0; n < Cells::parities(set); ++n) {
      const Value* const values = cells_.values[parity(set, n)].data();
      const Word* const first = samples.data() + sample(parity(set, n));
      box(set, n).for_each_row([&](std::size_t cell, std::size_t before, auto row) {
        const Word* const from = first + sample_row(cell);
        for (std::size_t i = 0; i < static_cast<std::size_t>(row); ++i) {
          const bool is_other = Depth::word(values[cell + i]) != prevailing;
          found[before + i] = from[2 * i] == prevailing && is_other ? 1 : 0;
        }
      });
      found += box(set, n).size();
    }
  }

  /// Makes the residuals of these points, which are 0, those that lead to the prevailing sample. False where
  /// one of them was predicted.
  [[nodiscard]] bool put_prevailing(int set, Word prevailing, const std::uint8_t* where, Word* folded) const {
    using Eight [[gnu::vector_size(8)]] = std::uint8_t;
    using SignedEight [[gnu::vector_size(8)]] = std::int8_t;
    using Values [[gnu::vector_size(8 * sizeof(Value))]] = Value;
    RowBytes predicted = 0;
    for (int n = 0; n < Cells::parities(set); ++n) {
      const Value* const values = cells_.values[parity(set, n)].data();
      box(set, n).for_each_row([&](std::size_t cell, std::size_t before, auto row) {
        std::array<std::uint8_t, 8> at{}, found{};
        const auto size = static_cast<std::size_t>(row);
        std::copy_n(where + before, size, at.begin());
        const RowBytes here = load_row(at.data()) * 255;
        if (here == 0) return;
        std::copy_n(folded + before, size, found.begin());
        Values predictions;
        std::memcpy(&predictions, values + cell, sizeof predictions);
        const Eight residuals = Eight{} + static_cast<std::uint8_t>(prevailing - Depth::kCentre) -
                                __builtin_convertvector(predictions, Eight);
        const auto signs = std::bit_cast<Eight>(std::bit_cast<SignedEight>(residuals) < SignedEight{});
        const auto all = std::bit_cast<std::array<std::uint8_t, 8>>((residuals + residuals) ^ signs);
        const RowBytes those = load_row(all.data());
        predicted |= here & ~bytes_not_zero(those);
        store_row((load_row(found.data()) & ~here) | (those & here), found.data());
        std::copy_n(found.begin(), size, folded + before);
      });
      where += box(set, n).size();
      folded += box(set, n).size();
    }
    return predicted == 0;
  }

  /// Makes predictions the samples.
  void apply(int set, const Word* folded) {
    for (int n = 0; n < Cells::parities(set); ++n) {
      Value* const values = cells_.values[parity(set, n)].data();
      // Those of centres, parity 7, go to a place from which none are read.
      Value* const magnitudes = cells_.residuals[parity(set, n) % 7].data();
      box(set, n).for_each_row([&](std::size_t cell, std::size_t before, auto row) {
        // Separate arrays let the compiler see that no step depends on another.
        std::array<Value, 8> sums, sizes;
        for (std::size_t i = 0; i < static_cast<std::size_t>(row); ++i) {
          const Word word = folded[before + i];
          const Word prediction = Depth::word(values[cell + i]);
          sums[i] = Depth::value(static_cast<Word>(prediction + ResidualToken<Word>::unfold(word)));
          sizes[i] = static_cast<Value>((word >> 1) + (word & 1));
        }
        for (std::size_t i = 0; i < static_cast<std::size_t>(row); ++i) {
          values[cell + i] = sums[i];
          magnitudes[cell + i] = sizes[i];
        }
      });
      folded += box(set, n).size();
    }
  }

  /// All points of the page, and others.
  void store(Samples& samples) const {
    for (std::size_t k = 0; k < PageGrid::kSide; ++k) {
      for (std::size_t j = 0; j < PageGrid::kSide; ++j) {
        const std::size_t parity = (j & 1) * 2 + (k & 1) * 4, cell = 1 + 11 * (j / 2 + 1 + 11 * (k / 2 + 1));
        const Value* const even = cells_.values[parity].data() + cell;
        const Value* const odd = cells_.values[parity + 1].data() + cell;
        Word* const to = samples.data() + PageGrid::kSide * (j + PageGrid::kSide * k);
        interleave(even, odd, to);
      }
    }
  }

 private:
  /// A row of the page.
  static void interleave(const Value* even, const Value* odd, Word* to) {
    constexpr std::size_t kPairs = PageGrid::kSide / 2;
    if constexpr (sizeof(Word) == 1 && std::endian::native == std::endian::little) {
      std::array<std::uint16_t, kPairs> pairs;
      for (std::size_t i = 0; i < kPairs; ++i) pairs[i] = static_cast<std::uint16_t>(even[i] | odd[i] << 8);
      std::memcpy(to, pairs.data(), sizeof pairs);
    } else {
      for (std::size_t i = 0; i < kPairs; ++i) {
        to[2 * i] = Depth::word(even[i]);
        to[2 * i + 1] = Depth::word(odd[i]);
      }
    }
  }

  static constexpr std::size_t parity(int set, int n) {
    return static_cast<std::size_t>(
        Cells::kParities[static_cast<std::size_t>(set)][static_cast<std::size_t>(n)]);
  }
  [[nodiscard]] ParityBox box(int set, int n) const {
    return ParityBox::of(count_, static_cast<int>(parity(set, n)));
  }
  /// Place in the page of the first point of a parity.
  static constexpr std::size_t sample(std::size_t parity) {
    return (parity & 1) + PageGrid::kSide * ((parity >> 1 & 1) + PageGrid::kSide * (parity >> 2));
  }
  /// How far from there the row is that begins at a cell.
  static constexpr std::size_t sample_row(std::size_t cell) {
    return 2 * PageGrid::kSide * (cell / 11 % 11 - 1 + PageGrid::kSide * (cell / Cells::kPlane - 1));
  }

  LatticePoint count_;
  Cells cells_;
};

}  // namespace adamas::isosurface
