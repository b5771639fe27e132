#pragma once

#include <cstdint>

#include "isosurface/compression/bounds_fields.h"
#include "isosurface/compression/bounds_stage.h"

namespace adamas {

/// What is expected of the error codes of a parity's points: on the finest LOD that which the known samples
/// in and on the diamond and its children give, on others that of the children.
template <class Word>
class ErrorStages {
 public:
  static constexpr int kRoomClasses = 7;
  /// The context of points whose error is known but for the unforeseen: of those on the finest LOD that
  /// have all samples and children on the page, and of those that have a child with the greatest error that
  /// the coarser LOD lets them have.
  static constexpr std::uint8_t kSure = 0;
  static constexpr int kContexts = 1 + 3 * 2 * 2 * 2 * kRoomClasses;

  /// Fills fields.predicted of the parity, and the stage with the points that are coded. `trust`: whether
  /// sure points are not.
  static void make(BoundsFields<Word>& fields, const PageShape& shape, int parity, bool trust,
                   BoundsStage& stage);
};

}  // namespace adamas
