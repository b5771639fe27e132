#pragma once

#include <cstdint>

#include "isosurface/compression/bounds/bounds_fields.h"
#include "isosurface/compression/bounds/bounds_stage.h"

namespace adamas::isosurface {

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

}  // namespace adamas::isosurface
