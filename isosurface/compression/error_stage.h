#pragma once

#include <cstdint>

#include "isosurface/compression/bounds_fields.h"
#include "isosurface/compression/bounds_stage.h"

namespace adamas {

/// Predicts the error codes of a parity's points: an error is at least that of each child. On the finest LOD
/// it is also at least the own error (own_errors), which follows from the samples in and on the diamond, as
/// far as these are known.
template <class Word>
class ErrorStages {
 public:
  static constexpr int kRoomClasses = 7;
  /// The context of determined points, and of points with a child that has the greatest error that the
  /// parents on the coarser LOD let the point have: another error is possible only in a page that no volume
  /// gives.
  static constexpr std::uint8_t kDetermined = 0;
  static constexpr int kContexts = 1 + 3 * 2 * 2 * 2 * kRoomClasses;

  /// Fills fields.predicted of the parity, and the stage with the points that are coded. `omitted`: whether
  /// determined points are left out.
  static void make(BoundsFields<Word>& fields, const PageShape& shape, int parity, bool omitted,
                   BoundsStage& stage);
};

}  // namespace adamas
