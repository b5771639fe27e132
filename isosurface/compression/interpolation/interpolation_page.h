#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include "core/base/simd.h"
#include "isosurface/compression/interpolation/residual_tokens.h"
#include "isosurface/compression/parity_cells.h"
#include "isosurface/volume/page.h"

namespace adamas::isosurface {

/// The representation of samples for prediction: a word less kCentre, in a number that is wide enough for the
/// sums of a prediction if the word is from 0 to kGreatest.
template <class SampleWord, class Number, int kSampleBits, SampleWord kGreatestSample, SampleWord kMiddle>
struct SampleDepth {
  using Word = SampleWord;
  using Value = Number;
  static constexpr int kBits = kSampleBits;
  static constexpr Word kGreatest = kGreatestSample, kCentre = kMiddle;

  static constexpr Value value(Word word) { return static_cast<Value>(static_cast<Word>(word - kCentre)); }
  static constexpr Word word(Value value) { return static_cast<Word>(static_cast<Word>(value) + kCentre); }
};

template <class Word, class Value>
using WholeDepth =
    SampleDepth<Word, Value, std::numeric_limits<Word>::digits, std::numeric_limits<Word>::max(), 0>;

using Depth8 = WholeDepth<std::uint8_t, std::int16_t>;
using Depth16 = WholeDepth<std::uint16_t, std::int32_t>;
using Depth32 = WholeDepth<std::uint32_t, std::int64_t>;
/// The depth of samples up to 4094, whose sums (twelve of them, and eight halves) fit in 16 bits. Greater
/// samples are coded without loss too, but less well.
using Depth12 = SampleDepth<std::uint16_t, std::int16_t, 12, 4094, 2047>;

/// The depth of all samples of a type.
template <class Word>
using DepthOf =
    std::conditional_t<sizeof(Word) == 1, Depth8, std::conditional_t<sizeof(Word) == 2, Depth16, Depth32>>;

/// A page and its surroundings, by the parity of the coordinates.
template <class Depth>
struct InterpolationCells {
  using Value = typename Depth::Value;
  static constexpr std::array<int, 3> kStride = kCellStrides;
  static constexpr int kPlane = kStride[2];
  using Cells = ParityCells<Value>;
  static constexpr int kCells = std::tuple_size_v<Cells>;

  /// Samples by parity; for samples of other pages, their predictions.
  std::array<Cells, 8> values;
  /// The magnitudes of the residuals of the samples, by parity.
  std::array<Cells, 7> residuals;
  /// The variation of the samples round each point, for the parities of the present set.
  std::array<Cells, 3> activity;
  /// The absolute differences between each even point and the next, by axis; and the sums of the six of them
  /// round a point. Edges need both.
  std::array<Cells, 3> gradients;
  Cells steps;

  static constexpr int kSets = 3;
  /// The parities of a set, which are predicted together: edges, faces, centres.
  static constexpr std::array<std::array<int, 3>, kSets> kParities{{{1, 2, 4}, {3, 5, 6}, {7, 0, 0}}};
  static constexpr int parities(int set) { return set == 2 ? 1 : 3; }
};

/// Predicts the samples of a page from those of the next coarser LOD, in three sets: points on edges by cubic
/// interpolation along them, then those on faces, then those in centres, from all neighbours. Loops run over
/// all cells from the first one to the last, with those between the rows, and every step fits in a Value, so
/// that a processor works at many cells at once.
template <class Depth>
class InterpolationPrediction {
 public:
  using Cells = InterpolationCells<Depth>;
  using Value = typename Cells::Value;

  /// Fills `values` and `activity` of the set's parities from those of the sets before, for the first
  /// `planes` of the page's 8 planes of cells.
  static void predict(int set, int planes, Cells& cells) {
    if (set == 0) return predict_all_edges(planes, cells);
    if (set == 2) return predict_centres(planes, cells);
    predict_faces<0, 1>(planes, cells);
    predict_faces<0, 2>(planes, cells);
    predict_faces<1, 2>(planes, cells);
  }

 private:
  static constexpr Value kLeast = Depth::value(0), kGreatest = Depth::value(Depth::kGreatest);
  static constexpr int kI = Cells::kStride[0], kJ = Cells::kStride[1], kK = Cells::kStride[2];

  // The cells that loops run over: the first one is (1, 1, 1). The edges and faces round the page's own
  // points are included, with those between, so each set reaches farther than the next one.
  static constexpr int kFirst = kI + kJ + kK;

  static constexpr Value value(Value x) { return x; }
  template <class Wide>
  static constexpr Value value(Wide x) {
    return static_cast<Value>(x);
  }
  static constexpr Value within(Value least, Value x, Value greatest) {
    return std::min(std::max(x, least), greatest);
  }

  static void predict_all_edges(int planes, Cells& cells) {
    measure_gradient<0>(planes, cells);
    measure_gradient<1>(planes, cells);
    measure_gradient<2>(planes, cells);
    add_gradients(planes, cells);
    predict_edges<0>(planes, cells);
    predict_edges<1>(planes, cells);
    predict_edges<2>(planes, cells);
  }

  template <int kAxis>
  static void measure_gradient(int planes, Cells& cells) {
    constexpr int kStep = Cells::kStride[kAxis];
    const int end = (planes + 3) * kK - kStep;
    const Value* const p = cells.values[0].data();
    Value* const g = cells.gradients[kAxis].data();
    ADAMAS_INDEPENDENT
    for (int n = 0; n < end; ++n) {
      g[n] = value(std::max(p[n], p[n + kStep]) - std::min(p[n], p[n + kStep]));
    }
  }

  /// Adds up the absolute differences to the neighbours of each point.
  static void add_gradients(int planes, Cells& cells) {
    const int end = (planes + 2) * kK;
    const Value *const gi = cells.gradients[0].data(), *const gj = cells.gradients[1].data(),
                       *const gk = cells.gradients[2].data();
    Value* const steps = cells.steps.data();
    ADAMAS_INDEPENDENT
    for (int n = kK; n < end; ++n) {
      steps[n] = value(gi[n] + gi[n - kI] + gj[n] + gj[n - kJ] + gk[n] + gk[n - kK]);
    }
  }

  template <int kAxis>
  static void predict_edges(int planes, Cells& cells) {
    constexpr int kStep = Cells::kStride[kAxis];
    const int end = (planes + (kAxis == 2 ? 1 : 2)) * kK;
    const Value* const p = cells.values[0].data();
    const Value *const g = cells.gradients[kAxis].data(), *const steps = cells.steps.data();
    Value *const to = cells.values[1 << kAxis].data(), *const activity = cells.activity[kAxis].data();
    ADAMAS_INDEPENDENT
    for (int n = kFirst; n < end; ++n) {
      // This is (9 ends - beyond + 8) / 16, rounded down, by steps that need few bits; the formulas below are
      // computed likewise.
      const Value ends = value(p[n] + p[n + kStep]), beyond = value(p[n - kStep] + p[n + 2 * kStep]);
      const Value bend = value(ends - beyond + 8), two = value(ends + (bend >> 3));
      to[n] = within(kLeast, value(two >> 1), kGreatest);
      activity[n] = value(steps[n] + steps[n + kStep] + 2 * g[n] + g[n - kStep] + g[n + kStep]);
    }
  }

  template <int kA, int kB>
  static void predict_faces(int planes, Cells& cells) {
    constexpr int kStepA = Cells::kStride[kA], kStepB = Cells::kStride[kB];
    const int end = (planes + (kB == 2 ? 0 : 1)) * kK + 9 * (kI + kJ) + 1;
    const Value* const p = cells.values[0].data();
    const Value *const ea = cells.values[1 << kA].data(), *const eb = cells.values[1 << kB].data();
    const Value *const ra = cells.residuals[1 << kA].data(), *const rb = cells.residuals[1 << kB].data();
    Value* const to = cells.values[1 << kA | 1 << kB].data();
    Value* const activity = cells.activity[kA + kB - 1].data();
    ADAMAS_INDEPENDENT
    for (int n = kFirst; n < end; ++n) {
      const Value e0 = ea[n], e1 = ea[n + kStepB], e2 = eb[n], e3 = eb[n + kStepA];
      const Value c0 = p[n], c1 = p[n + kStepA], c2 = p[n + kStepB], c3 = p[n + kStepA + kStepB];
      const Value edges = value(e0 + e1 + e2 + e3), corners = value(c0 + c1 + c2 + c3);
      const Value e_least = std::min(std::min(e0, e1), std::min(e2, e3));
      const Value e_most = std::max(std::max(e0, e1), std::max(e2, e3));
      const Value c_least = std::min(std::min(c0, c1), std::min(c2, c3));
      const Value c_most = std::max(std::max(c0, c1), std::max(c2, c3));
      // This is (5 edges - corners + 8) / 16.
      const Value bend = value(edges - corners + 8), four = value(edges + (bend >> 2));
      to[n] = within(std::min(e_least, c_least), value(four >> 2), std::max(e_most, c_most));
      const Value errors = value(ra[n] + ra[n + kStepB] + rb[n] + rb[n + kStepA]);
      activity[n] = value(2 * (e_most - e_least + errors) + c_most - c_least);
    }
  }

  static void predict_centres(int planes, Cells& cells) {
    const int end = planes * kK + 8 * (kI + kJ) + 1;
    const Value *const p = cells.values[0].data(), *const ei = cells.values[1].data(),
                       *const ej = cells.values[2].data(), *const ek = cells.values[4].data(),
                       *const fij = cells.values[3].data(), *const fik = cells.values[5].data(),
                       *const fjk = cells.values[6].data();
    const Value *const rij = cells.residuals[3].data(), *const rik = cells.residuals[5].data(),
                       *const rjk = cells.residuals[6].data();
    Value* const to = cells.values[7].data();
    Value* const activity = cells.activity[0].data();
    ADAMAS_INDEPENDENT
    for (int n = kFirst; n < end; ++n) {
      const Value f0 = fjk[n], f1 = fjk[n + kI], f2 = fik[n], f3 = fik[n + kJ], f4 = fij[n], f5 = fij[n + kK];
      const Value least = std::min(std::min(std::min(f0, f1), std::min(f2, f3)), std::min(f4, f5));
      const Value most = std::max(std::max(std::max(f0, f1), std::max(f2, f3)), std::max(f4, f5));
      const Value faces = value(f0 + f1 + f2 + f3 + f4 + f5);
      const Value edges =
          value(ei[n] + ei[n + kJ] + ei[n + kK] + ei[n + kJ + kK] + ej[n] + ej[n + kI] + ej[n + kK] +
                ej[n + kI + kK] + ek[n] + ek[n + kI] + ek[n + kJ] + ek[n + kI + kJ]);
      const Value corners = value(p[n] + p[n + kI] + p[n + kJ] + p[n + kK] + p[n + kI + kJ] + p[n + kI + kK] +
                                  p[n + kJ + kK] + p[n + kI + kJ + kK]);
      // This is (8 faces - 2 edges + corners + 16) / 32.
      const Value bend = value((corners >> 1) - edges + 8), four = value(faces + (bend >> 2));
      to[n] = within(least, value(four >> 2), most);
      const Value errors = value(rjk[n] + rjk[n + kI] + rik[n] + rik[n + kJ] + rij[n] + rij[n + kK]);
      activity[n] = value(2 * (most - least + errors));
    }
  }
};

/// The context of an activity (InterpolationCells): its logarithm, in steps of half an octave, or of one
/// octave for samples of 32 bits.
template <class Depth>
struct ActivityContext {
  static constexpr bool kHalves = Depth::kBits < 32;
  /// Activities are below 2^(bits + 4).
  static constexpr int kBits = Depth::kBits + 4;
  static constexpr int kContexts = 1 + (kHalves ? 2 : 1) * kBits;
  /// The number of classes of predictions, by the number of bits of their distance from the prevailing
  /// sample. There is more than one if samples have one byte and the volume has a prevailing sample.
  static constexpr int kClasses = Depth::kBits == 8 ? 6 : 1;
  /// Returns the class of a distance, or the classes of several, in the bits above an activity.
  template <class Distance>
  [[gnu::always_inline]] static constexpr Distance class_of(Distance distance) {
    const auto is_least = [&](int least) {
      const auto from = static_cast<typename Depth::Value>(least);
      if constexpr (std::is_integral_v<Distance>) {
        return static_cast<Distance>(distance >= from ? 1 : 0);
      } else {
        return static_cast<Distance>((distance >= from) & 1);
      }
    };
    static_assert(kClasses == 1 || kClasses == 6);
    const auto number = is_least(1) + is_least(2) + is_least(4) + is_least(8) + is_least(16);
    return static_cast<Distance>(number << kBits);
  }
  /// Returns the context of an activity with a class in the bits above it.
  static constexpr std::uint8_t context_with_class(typename Depth::Value both) {
    const auto number = static_cast<std::make_unsigned_t<typename Depth::Value>>(both);
    const auto activity = static_cast<typename Depth::Value>(number & ((1u << kBits) - 1));
    return static_cast<std::uint8_t>((number >> kBits) * kContexts + context(activity));
  }

  /// Returns the context of an activity. The highest bit of 16-bit numbers belongs to the activity too.
  static constexpr std::uint8_t context(typename Depth::Value activity) {
    const auto number = static_cast<std::make_unsigned_t<typename Depth::Value>>(activity);
    if constexpr (kHalves) {
      // These are the exponent and the highest bit below the leading 1 of an exact float; 253 is before that
      // of 1. There is no branch, so that a processor works at many numbers at once.
      const auto upper =
          std::bit_cast<std::uint32_t>(static_cast<float>(static_cast<std::int32_t>(number))) >> 22;
      return static_cast<std::uint8_t>(std::max(static_cast<std::int32_t>(upper) - 253, 0));
    } else {
      return static_cast<std::uint8_t>(std::bit_width(number));
    }
  }
};

/// A page that is converted to residuals or back, set by set: `predict`, then `residuals` or the decoded
/// ones, then `apply`. Residuals are folded (ResidualToken) and ordered by parity, then by point, i running
/// fastest.
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
    // Loops also run over cells without a point. Their results are not used, but they must not read
    // uninitialised memory, and `steps` is the only array without other values there.
    cells_.steps.fill(0);
    for (std::size_t n = 0; n < around.size(); ++n) cells_.values[0][n] = Depth::value(around[n]);
    for (typename Cells::Cells& residuals : cells_.residuals) residuals.fill(0);
  }

  /// Returns the number of residuals of a set.
  [[nodiscard]] std::size_t size(int set) const {
    std::size_t total = 0;
    for (int n = 0; n < Cells::parities(set); ++n) total += static_cast<std::size_t>(box(set, n).size());
    return total;
  }

  void predict(int set) { InterpolationPrediction<Depth>::predict(set, (count_.k + 1) / 2, cells_); }

  /// Adds to the activity of each point of the set, in the bits above it, the class of its prediction by the
  /// distance from the volume's prevailing sample. Bytes: see with_wide_lanes.
  template <std::size_t Bytes>
  void add_prevailing_classes(int set, Word prevailing) {
    using Lanes = Simd<Value, Bytes>;
    // The range has the cells of the page's own points, and those between.
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

  /// Fills the context of each point of the set: context_of(its activity).
  template <class ContextOf>
  void contexts(int set, ContextOf&& context_of, std::uint8_t* contexts) const {
    for (int n = 0; n < Cells::parities(set); ++n) {
      const Value* const activity = cells_.activity[static_cast<std::size_t>(n)].data();
      box(set, n).for_each_row([&](std::size_t cell, std::size_t before, auto row) {
        for (std::size_t i = 0; i < static_cast<std::size_t>(row); ++i)
          contexts[before + i] = context_of(activity[cell + i]);
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

  /// Sets 1 for points whose sample is the prevailing one and was not predicted, 0 for others.
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

  /// Sets the residuals of marked points, which are 0, to those that give the prevailing sample. Returns
  /// false where one of them was predicted.
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

  /// Adds residuals to the predictions, which become the samples.
  void apply(int set, const Word* folded) {
    for (int n = 0; n < Cells::parities(set); ++n) {
      Value* const values = cells_.values[parity(set, n)].data();
      // Magnitudes of centres, parity 7, are not needed: they go to a place that is not read.
      Value* const magnitudes = cells_.residuals[parity(set, n) % 7].data();
      box(set, n).for_each_row([&](std::size_t cell, std::size_t before, auto row) {
        // Separate arrays show the compiler that no step depends on another.
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

  /// Stores all points of the page, and anything at other places.
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
  /// Stores a row of the page.
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
    return ParityBox::for_parity(count_, static_cast<int>(parity(set, n)));
  }
  /// Returns the place in the page of the first point of a parity.
  static constexpr std::size_t sample(std::size_t parity) {
    return (parity & 1) + PageGrid::kSide * ((parity >> 1 & 1) + PageGrid::kSide * (parity >> 2));
  }
  /// Returns the distance from there to the row that begins at a cell.
  static constexpr std::size_t sample_row(std::size_t cell) {
    return 2 * PageGrid::kSide * (cell / 11 % 11 - 1 + PageGrid::kSide * (cell / Cells::kPlane - 1));
  }

  LatticePoint count_;
  Cells cells_;
};

}  // namespace adamas::isosurface
