#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "isosurface/compression/error_stage.h"
#include "isosurface/compression/range_stage.h"
#include "isosurface/compression/range_token.h"
#include "isosurface/compression/row_lanes.h"
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

  /// Whether nothing but the predicted word is expected.
  static constexpr bool is_sure(std::uint16_t context) {
    constexpr int kFirst = kRanges + RangeStages<Word>::kSure;
    return context == kFirst || context == kFirst + RangeStages<Word>::kSideContexts;
  }
};

/// Of a word of a page's range, as it is seen on a side: see ValueFields.
template <class Word>
constexpr Word seen_from(std::size_t side, Word word) {
  return side == 0 ? word : static_cast<Word>(~word);
}

/// Takes the values of points of coarser levels from round the page.
template <class Word>
void fill_coarser_values(const PageShape& shape, const Surroundings<Word>& around, Page<Word>& page) {
  for (LatticePoint q{0, 0, 0}; q.k < shape.count.k; q.k += 2) {
    for (q.j = 0; q.j < shape.count.j; q.j += 2) {
      for (q.i = 0; q.i < shape.count.i; q.i += 2) {
        const std::size_t from = surrounding_place(q), to = PageGrid::place(q, 0);
        page.low[to] = around.low[from];
        page.high[to] = around.high[from];
        page.errors[to] = around.errors[from];
      }
    }
  }
}

/// Copies what is predicted of a stage's sure points to where `target` says that the numbers from a place on
/// are.
template <class Word, class Target>
void copy_sure(const ValueStage<Word>& stage, Target target, Word flipped) {
  for (std::size_t n = 0; n < stage.segment_count; ++n) {
    const auto [place, count, whole_row] = stage.segments[n];
    if (whole_row) {
      const std::size_t row = place & ~std::size_t{15};
      copy_every_other(stage.sure.data() + row, target(row), place & 1u, flipped);
      continue;
    }
    Word* to = target(place);
    for (std::size_t m = 0; m < 2u * count; m += 2) to[m] = stage.sure[place + m] ^ flipped;
  }
}

/// The order in which the values of a page are coded: its errors, then its ranges, in stages of each. Calls
/// port.errors(stage, codes) and port.range(stage, side, words): an encoder reads the stage's places of
/// these, a decoder fills them.
template <class Word, class PageType, class Port>
void walk_values(const PageShape& shape, const Surroundings<Word>& around, PageType& page, bool trust,
                 Port& port) {
  ValueFields<Word> fields;
  fields.load(shape, around, page);
  ValueStage<std::uint8_t> errors;
  for (int phase = 3; port.needs_errors() && phase-- > 0;) {
    ErrorStages<Word>::make(fields, shape, phase, errors);
    port.errors(errors, page.errors);
    for (std::size_t n = 0; n < errors.size; ++n) {
      fields.errors.at_place(errors.places[n]) = page.errors[errors.places[n]];
    }
  }
  std::array<ValueStage<Word>, 2> sides;
  for (int phase = 3; port.needs_ranges() && phase-- > 0;) {
    RangeStages<Word>::make(fields, shape, page.errors, phase, trust, sides);
    for (std::size_t side = 0; side < 2; ++side) {
      ValueStage<Word>& stage = sides[side];
      for (std::size_t n = 0; n < stage.size; ++n) stage.contexts[n] += ValueContexts<Word>::kRanges;
      auto& words = side == 0 ? page.low : page.high;
      copy_sure<Word>(
          stage, [&](std::size_t place) { return &fields.values[side].at_place(place); }, 0);
      port.range(stage, side, words);
      // Nothing follows that would look at them.
      if (phase == 0) continue;
      for (std::size_t n = 0; n < stage.size; ++n) {
        const Word word = words[stage.places[n]];
        fields.values[side].at_place(stage.places[n]) = seen_from(side, word);
      }
    }
  }
}

/// The same of a complete page, of which nothing but the samples is known: plane by plane.
template <class Word, class PageType, class Port>
void walk_complete_values(const PageShape& shape, PageType& page, Port& port) {
  ValueStage<std::uint8_t> errors;
  ValueStage<Word> range;
  errors.clear();
  range.clear();
  for (std::int32_t k = 0; k < shape.count.k; ++k) {
    errors.size = 0;
    for (std::int32_t j = 0; j < shape.count.j; ++j) {
      for (std::int32_t i = 0; i < shape.count.i; ++i) {
        errors.places[errors.size] = static_cast<std::uint16_t>(PageGrid::place({i, j, k}, 0));
        errors.contexts[errors.size] = ValueContexts<Word>::kComplete;
        errors.predicted[errors.size++] = 0;
      }
    }
    if (port.needs_errors()) port.errors(errors, page.errors);
    for (std::size_t side = 0; port.needs_ranges() && side < 2; ++side) {
      range.size = errors.size;
      for (std::size_t n = 0; n < range.size; ++n) {
        range.places[n] = errors.places[n];
        range.contexts[n] = static_cast<std::uint16_t>(ValueContexts<Word>::kComplete + 1 + side);
        range.predicted[n] = seen_from(side, page.samples[range.places[n]]);
        range.bound[n] = 0;
      }
      port.range(range, side, side == 0 ? page.low : page.high);
    }
  }
}

}  // namespace adamas
