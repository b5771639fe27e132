#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "isosurface/compression/bounds/bounds_fields.h"
#include "isosurface/compression/bounds/range_rounding.h"
#include "isosurface/compression/parity_cells.h"
#include "isosurface/volume/page.h"

namespace adamas::isosurface {

/// The parities of a page's points in the order in which they are coded: edges, faces, centres.
inline constexpr std::array<int, 7> kCodedParities{1, 2, 4, 3, 5, 6, 7};

/// Returns the phase of the diamonds of a parity's points.
constexpr int phase_of(int parity) { return 3 - (parity & 1) - (parity >> 1 & 1) - (parity >> 2); }

/// Calls f with a coded parity as a constant.
template <class F>
[[gnu::always_inline]] inline void with_parity(int parity, F f) {
  [&]<std::size_t... N>(std::index_sequence<N...>) {
    ((kCodedParities[N] == parity ? f(std::integral_constant<int, kCodedParities[N]>{}) : void()), ...);
  }
  (std::make_index_sequence<kCodedParities.size()>());
}

/// Returns, for each point, the greatest number of the cubes that contain it. `cube`: the cell of the cube
/// whose centre is in the same cell as the first point. Lanes: see Simd.
template <int Parity, class Lanes, class T>
[[gnu::always_inline]] inline typename Lanes::Numbers greatest_of_cubes(const T* cube) {
  typename Lanes::Numbers greatest = Lanes::load(cube);
  [&]<int... N>(std::integer_sequence<int, N...>) {
    const auto take = [&]<int Step>(std::integral_constant<int, Step>) {
      if constexpr (Step != 0 && (Step & Parity) == 0)
        greatest = Lanes::greater(
            greatest, Lanes::load(cube - ((Step & 1) + 11 * (Step >> 1 & 1) + 121 * (Step >> 2))));
    };
    (take(std::integral_constant<int, N>{}), ...);
  }
  (std::make_integer_sequence<int, 8>());
  return greatest;
}

/// The points of a parity whose errors or ranges follow from their page: all samples in and on their
/// diamonds, and all children on the page's LOD, are the page's own. In a store they have the derived values,
/// so they need not be coded; if one point of a page does not, all its points are coded.
class DeterminedPoints {
 public:
  /// The kind of bounds. Errors are determined on the finest LOD alone, and so are the ranges of edges; those
  /// of faces and centres are determined on every LOD.
  enum class Bound : std::uint8_t { kErrors, kRanges };

  /// Makes an empty set.
  DeterminedPoints() = default;
  DeterminedPoints(const PageShape& shape, int parity, Bound bound) {
    /// Masks by axis, with all bits of a cell's byte where its coordinate lets points be determined.
    std::array<RowBytes, 3> along{};
    for (int axis = 0; axis < 3; ++axis) {
      const int odd = parity >> axis & 1;
      for (std::int32_t c = 0; c < 8; ++c) {
        if (is_determined(2 * c + odd, shape.count[axis], phase_of(parity), bound))
          along[static_cast<std::size_t>(axis)] |= RowBytes{255} << 8 * c;
      }
    }
    const ParityBox box = ParityBox::for_parity(shape.count, parity);
    std::size_t n = 0;
    for (int k = 0; k < box.nk; ++k) {
      for (int j = 0; j < box.nj; ++j)
        rows_[n++] = (along[1] >> 8 * j & along[2] >> 8 * k & 1) != 0 ? along[0] : 0;
    }
  }

  /// Returns a mask of the determined points of the nth row of the parity's points.
  [[nodiscard]] RowBytes row(std::size_t n) const { return rows_[n]; }

 private:
  /// Returns whether a coordinate lets points be determined, where the page has `count` of them.
  static bool is_determined(std::int32_t x, std::int32_t count, int phase, Bound bound) {
    const bool odd = (x & 1) != 0;
    // Samples of edges and faces, and children of all diamonds, lie in the cubes on both sides.
    if (bound == Bound::kErrors) return odd ? phase == 2 || x + 1 < count : x > 0 && x + 1 < count;
    // The range of an edge depends on samples, some of which may lie before the page; that of others on
    // children, some of which may lie behind it.
    if (phase == 2) return odd || x > 0;
    return !odd || x < PageGrid::kSide - 1 || count < PageGrid::kSide;
  }

  std::array<RowBytes, 64> rows_{};
};

/// The points of a parity that are coded, one after another.
struct BoundsStage {
  static constexpr std::size_t kMost = 512, kSlack = 8;

  int parity = 0;
  ParityBox box;
  std::size_t base = 0;                                 ///< the offset of the contexts
  std::size_t size = 0;                                 ///< number of coded points
  std::array<std::uint8_t, kMost + kSlack> contexts{};  ///< the contexts of these points, row by row
  std::array<RowBytes, 64> coded{};                     ///< masks of the points that are coded, by row

  void begin(int new_parity, const ParityBox& points) {
    parity = new_parity;
    box = points;
    size = 0;
  }
  /// Adds all rows. row(cell, mask of the determined points) returns the contexts of the row's points, and a
  /// mask of those that are coded. Wide: see with_wide_lanes.
  template <bool Wide, class Row>
  void add_rows(const DeterminedPoints& points, Row row);
};

template <bool Wide, class Row>
void BoundsStage::add_rows(const DeterminedPoints& points, Row row) {
  std::size_t n = 0;
  box.for_each_row([&](std::size_t cell, std::size_t, int count) {
    const auto [all_contexts, all_coded] = row(cell, points.row(n));
    const RowBytes those = all_coded & first_bytes(count);
    coded[n++] = those;
    store_row(gather_bytes<Wide>(all_contexts, those), contexts.data() + size);
    size += bytes_in(those);
  });
}

/// Predicts the error codes of a parity's points: an error is at least that of each child. On the finest LOD
/// it is also at least the own error (own_errors), as far as the samples in and on the diamond are known. The
/// edges of coarse LODs have no such bound: there the greatest possible error and the errors round the edge
/// form the context.
template <class Word>
class ErrorStages {
 public:
  static constexpr int kRoomClasses = 7;
  /// The context of determined points, and of points with a child that has the greatest error that the
  /// parents on the coarser LOD allow: another error is possible only in a page that is of no volume.
  static constexpr std::uint8_t kDetermined = 0;
  /// The first contexts of edges of coarse LODs, which are last. Before them are those of the other groups,
  /// by phase, finest LOD or coarser, whether the point is determined and whether the expected error is 0.
  static constexpr int kCoarseEdges = 1 + 5 * 2 * 2 * kRoomClasses;
  static constexpr int kLimitClasses = 13, kMeanClasses = 8;
  static constexpr int kContexts = kCoarseEdges + kLimitClasses * kMeanClasses;

  /// Fills fields.predicted of the parity, and the stage with the points that are coded. `left_out`: whether
  /// determined points are left out.
  static void make(BoundsFields<Word>& fields, const PageShape& shape, int parity, bool left_out,
                   BoundsStage& stage);
};

/// Codes the end of a range as a distance below the word `predicted`, in levels of a RangeRounding. The limit
/// is the least end that is expected, and not above `predicted`. All of them are rounded. A symbol stands for
/// one distance or several; extra bits distinguish these.
template <class Word>
struct RangeToken {
  static constexpr int kBits = 8 * sizeof(Word);
  static constexpr std::uint8_t kPredicted = 0;  ///< the end is the predicted word
  static constexpr std::uint8_t kLimit = 1;      ///< the end is the limit, which is another word
  static constexpr std::uint8_t kFirst = 2;      ///< the distance is 1
  /// Shorter distances have a symbol each, others one for each leading 1 and the bit below it.
  static constexpr int kDirectBits = 5;
  /// The first symbol with extra bits.
  static constexpr std::uint8_t kFirstOpen = kFirst + (1 << kDirectBits) - 1;
  /// The symbol of an end above the predicted word, or without a prediction; all bits of the end follow.
  static constexpr std::uint8_t kBehind = static_cast<std::uint8_t>(kFirstOpen + 2 * (kBits - kDirectBits));
  static constexpr std::size_t kSymbols = kBehind + 1;

  std::uint8_t symbol = 0;
  std::uint32_t extra = 0;

  /// Makes the token of an end. `bits` are those of the rounding.
  static constexpr RangeToken encode(Word value, Word predicted, Word limit, int bits) {
    if (value == predicted) return {kPredicted, 0};
    if (value == limit) return {kLimit, 0};
    if (value > predicted || is_unknown(predicted)) return {kBehind, value};
    const auto distance = static_cast<std::uint32_t>((predicted >> bits) - (value >> bits));
    if (distance < 1u << kDirectBits) return {static_cast<std::uint8_t>(kFirst + distance - 1), 0};
    const auto width = static_cast<int>(std::bit_width(distance));
    const std::uint32_t half = distance >> (width - 2) & 1;
    return {static_cast<std::uint8_t>(kFirstOpen + 2 * (width - kDirectBits - 1) + static_cast<int>(half)),
            distance & ((1u << (width - 2)) - 1)};
  }

  /// Returns the number of extra bits of a symbol from kFirst on.
  static constexpr int extra_bits(std::uint8_t symbol) {
    if (symbol == kBehind) return kBits;
    return symbol < kFirstOpen ? 0 : (symbol - kFirstOpen) / 2 + kDirectBits - 1;
  }

  /// Returns the least distance of a symbol from kFirstOpen to before kBehind; its lowest bits are the extra
  /// ones.
  static constexpr std::uint32_t lead(std::uint8_t symbol) {
    const int number = symbol - kFirstOpen;
    return (2u | static_cast<std::uint32_t>(number & 1)) << (number / 2 + kDirectBits - 1);
  }

  static constexpr bool is_unknown(Word predicted) {
    return RangeRounding<Word>::kKeepsUnknown && predicted == RangeRounding<Word>::kUnknown;
  }
};

/// Predicts the ranges of a parity's points, each side alike (see BoundsFields). A range ends at `known`, the
/// least known word in and on the diamond, rounded, or below it; it does not end below its limit, which
/// follows from the ranges of the parents on the coarser LOD. The diamond of a centre is covered by those of
/// its faces, and that of a face by those of its edges: if all these are known, they determine the range.
template <class Word>
class RangeStages {
 public:
  static constexpr int kRoomClasses = 8, kErrorClasses = 8, kGroups = 3;
  /// The context of determined points, and of points whose limit is the predicted word: another range is
  /// possible only in a page that is of no volume.
  static constexpr std::uint8_t kDetermined = 0;
  static constexpr int kContexts = 1 + kGroups * kRoomClasses * kErrorClasses;

  /// Fills fields.known and fields.limits, and the stages of both sides with the points that are coded. All
  /// errors are known. `left_out`: whether determined points are not coded.
  static void make(BoundsFields<Word>& fields, const PageShape& shape, int parity, bool left_out,
                   std::array<BoundsStage, 2>& stages);
};

/// The contexts of a page's symbols: first those of errors, then those of ranges; last those of complete
/// pages, which are one for the errors and one for each side of the ranges.
template <class Word>
struct BoundsContexts {
  static constexpr std::size_t kRanges = ErrorStages<Word>::kContexts;
  static constexpr std::size_t kComplete = kRanges + RangeStages<Word>::kContexts;
  static constexpr std::size_t kCount = kComplete + 3;
  static constexpr std::size_t kErrorSymbols = 64;
  static constexpr std::size_t kSymbols = std::max(kErrorSymbols, RangeToken<Word>::kSymbols);
};

/// Says whether determined points (contexts kDetermined), which are as predicted, are left out of the coded
/// errors and ranges.
struct LeftOutPoints {
  bool errors, ranges;
};

/// Calls port.errors(stage) and port.range(side, stage) in the order in which the bounds of a page are coded:
/// its errors, then its ranges, in stages of each. The port of an encoder reads the fields' errors and
/// ranges; that of a decoder fills those of the stage's parity, with the predictions where points are not
/// coded. The fields must be loaded.
template <class Word, class Port>
void walk_bounds(BoundsFields<Word>& fields, const OwnErrorGeometry& geometry, const PageShape& shape,
                 LeftOutPoints left_out, Port& port) {
  std::array<BoundsStage, 2> stages;
  if (port.needs_errors()) {
    fields.predict_errors(shape, geometry);
    for (const int parity : kCodedParities) {
      ErrorStages<Word>::make(fields, shape, parity, left_out.errors, stages[0]);
      port.errors(stages[0]);
    }
  }
  if (!port.needs_ranges()) return;
  for (BoundsStage& stage : stages) stage.base = BoundsContexts<Word>::kRanges;
  for (const int parity : kCodedParities) {
    RangeStages<Word>::make(fields, shape, parity, left_out.ranges, stages);
    for (std::size_t side = 0; side < 2; ++side) port.range(side, stages[side]);
  }
}

/// Calls the port, as walk_bounds(), for the bounds of a complete page, of which only the samples are known:
/// errors are predicted as 0, and ranges as the samples, rounded.
template <class Word, class Port>
void walk_complete_bounds(BoundsFields<Word>& fields, const PageShape& shape, Port& port) {
  for (auto& cells : fields.predicted) cells.fill(0);
  for (auto& cells : fields.limits) cells.fill(0);
  BoundsStage stage;
  for (int parity = 0; parity < 8; ++parity) {
    stage.begin(parity, ParityBox::for_parity(shape.count, parity));
    // No point is left out, as determined points of the context 0 would be.
    stage.add_rows<false>({}, [](std::size_t, RowBytes) { return std::pair(kEachByte, ~RowBytes{0}); });
    stage.base = BoundsContexts<Word>::kComplete - 1;
    if (port.needs_errors()) port.errors(stage);
    for (std::size_t side = 0; port.needs_ranges() && side < 2; ++side) {
      ++stage.base;
      const auto& samples = fields.samples[side][static_cast<std::size_t>(parity)];
      std::transform(samples.begin(), samples.end(), fields.known[side].begin(),
                     [&](Word sample) { return fields.rounding.round(side, sample); });
      port.range(side, stage);
    }
  }
}

}  // namespace adamas::isosurface
