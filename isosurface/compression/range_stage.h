#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "isosurface/compression/value_fields.h"
#include "isosurface/compression/value_stage.h"

namespace adamas {

/// What is expected of one side of the ranges of a phase's points: `predicted` is the least known word in and
/// on the diamond, from which the range begins or before which; `bound` the word before which it should not
/// begin. Edges first, then faces, then centres: the diamond of a centre is that of its faces together, and
/// these those of their edges, so that where all are known there is nothing to be coded.
template <class Word>
class RangeStages {
 public:
  static constexpr int kBoundClasses = 9, kErrorClasses = 8, kGroups = 3;
  /// The context of points whose range is known but for the unforeseen.
  static constexpr std::uint16_t kSure = 0;
  static constexpr std::uint16_t kSideContexts = 1 + kGroups * kBoundClasses * kErrorClasses;
  static constexpr std::uint16_t kContexts = 2 * kSideContexts;

  /// Both sides of a phase. `errors`: the page's, all known. `trust`: whether sure points are not coded.
  static void make(const ValueFields<Word>& fields, const PageShape& shape,
                   const typename Page<Word>::template Points<std::uint8_t>& errors, int phase, bool trust,
                   std::array<ValueStage<Word>, 2>& stages);
};

}  // namespace adamas
