#pragma once

#include <array>
#include <cstdint>

#include "isosurface/compression/bounds_fields.h"
#include "isosurface/compression/bounds_stage.h"

namespace adamas {

/// What is expected of the two sides of the ranges of a parity's points: `known` is the least known word in
/// and on the diamond, from which the range begins or before which; before the bound it should not begin.
/// The diamond of a centre is that of its faces together, and these those of their edges, so that where all
/// are known there is nothing to be coded.
template <class Word>
class RangeStages {
 public:
  static constexpr int kBoundClasses = 8, kErrorClasses = 8, kGroups = 3;
  /// The context of points whose range is known but for the unforeseen, also from the bound.
  static constexpr std::uint8_t kSure = 0;
  static constexpr int kContexts = 1 + kGroups * kBoundClasses * kErrorClasses;

  /// Fills fields.known and fields.bounds, and the stages of both sides with the points that are coded. All
  /// errors are known. `trust`: whether sure points are not coded.
  static void make(BoundsFields<Word>& fields, const PageShape& shape, int parity, bool trust,
                   std::array<BoundsStage, 2>& stages);
};

}  // namespace adamas
