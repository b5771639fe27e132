#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "isosurface/compression/error_stage.h"
#include "isosurface/compression/known_errors.h"
#include "isosurface/compression/range_stage.h"
#include "isosurface/compression/range_token.h"
#include "isosurface/compression/value_fields.h"
#include "isosurface/compression/value_stage.h"

namespace adamas {

/// All contexts of a page's symbols: those of errors, those of ranges, then of complete pages one for the
/// errors and one for each side of the ranges.
template <class Word>
struct ValueContexts {
  static constexpr std::uint16_t kRanges = ErrorStages<Word>::kContexts;
  static constexpr std::uint16_t kComplete = kRanges + RangeStages<Word>::kContexts;
  static constexpr std::size_t kCount = kComplete + 3;
  static constexpr std::size_t kErrorSymbols = 64;
  static constexpr std::size_t kSymbols = std::max(kErrorSymbols, RangeToken<Word>::kSymbols);
};

/// Whether points of which nothing is expected but what is predicted are not coded.
struct ValueTrust {
  bool errors, ranges;
};

/// Of a word of a page's range, as it is seen on a side: see ValueFields.
template <class Word>
constexpr Word seen_from(std::size_t side, Word word) {
  return side == 0 ? word : static_cast<Word>(~word);
}

/// The order in which the values of a page are coded: its errors, then its ranges, in stages of each. Calls
/// port.errors(phase, stage) and port.range(phase, side, stage), in which an encoder reads the fields' errors
/// and values and a decoder, which says so by kFills, fills those of the stage; the others are there, as
/// predicted. The fields are loaded.
template <class Word, class Port>
void walk_values(ValueFields<Word>& fields, const ErrorGeometry& geometry, const PageShape& shape,
                 ValueTrust trust, Port& port) {
  std::array<ValueStage, 2> stages;
  if (port.needs_errors()) {
    known_errors(fields.heights, geometry, shape, fields.predicted);
    for (int phase = 3; phase-- > 0;) {
      ErrorStages<Word>::make(fields, shape, phase, trust.errors, Port::kFills, stages[0]);
      port.errors(phase, stages[0]);
    }
  }
  for (int phase = 3; port.needs_ranges() && phase-- > 0;) {
    RangeStages<Word>::make(fields, shape, phase, trust.ranges, Port::kFills, stages);
    for (std::size_t side = 0; side < 2; ++side) {
      ValueStage& stage = stages[side];
      for (std::size_t n = 0; n < stage.size; ++n) stage.contexts[n] += ValueContexts<Word>::kRanges;
      port.range(phase, side, stage);
    }
  }
}

/// The same of a complete page, of which nothing but the samples is known: plane by plane, errors predicted
/// as 0 and ranges as the samples.
template <class Word, class Port>
void walk_complete_values(ValueFields<Word>& fields, const PageShape& shape, Port& port) {
  fields.predicted.fill(0);
  for (auto& bounds : fields.bounds) bounds.fill(0);
  ValueStage stage;
  for (std::int32_t k = 0; k < shape.count.k; ++k) {
    stage.size = 0;
    for (std::int32_t j = 0; j < shape.count.j; ++j) {
      for (std::int32_t i = 0; i < shape.count.i; ++i)
        stage.places[stage.size++] = static_cast<std::uint16_t>(PaddedGrid<Word>::place({i, j, k}));
    }
    const auto fill = [&stage](std::size_t context) {
      std::fill_n(stage.contexts.begin(), stage.size, static_cast<std::uint16_t>(context));
    };
    fill(ValueContexts<Word>::kComplete);
    if (port.needs_errors()) port.errors(-1, stage);
    for (std::size_t side = 0; port.needs_ranges() && side < 2; ++side) {
      fill(ValueContexts<Word>::kComplete + 1 + side);
      for (std::size_t n = 0; n < stage.size; ++n) {
        const Word known = fields.samples[side][stage.places[n]];
        fields.known[side][stage.places[n]] = known;
        if (Port::kFills) fields.values[side][stage.places[n]] = known;
      }
      port.range(-1, side, stage);
    }
  }
}

}  // namespace adamas
