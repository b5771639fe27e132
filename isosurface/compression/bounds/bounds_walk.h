#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "isosurface/compression/bounds/bounds_fields.h"
#include "isosurface/compression/bounds/bounds_stage.h"
#include "isosurface/compression/bounds/error_stage.h"
#include "isosurface/compression/bounds/range_stage.h"

namespace adamas::isosurface {

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
    stage.begin(parity, ParityBox::of(shape.count, parity));
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
