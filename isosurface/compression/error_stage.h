#pragma once

#include <cstdint>

#include "isosurface/compression/value_fields.h"
#include "isosurface/compression/value_stage.h"

namespace adamas {

/// What is expected of the error codes of a phase's points: that which the known samples in and on the
/// diamond and its children give. Edges first, then faces, then centres.
template <class Word>
class ErrorStages {
 public:
  static constexpr int kRoomClasses = 7;
  /// The context of points whose error is known but for the unforeseen: of those on the finest level that
  /// have all samples and children on the page, and of those that have a child with the greatest error that
  /// the coarser level lets them have.
  static constexpr std::uint16_t kSure = 0;
  static constexpr std::uint16_t kContexts = 1 + 3 * 2 * 2 * 2 * kRoomClasses;

  /// Fills fields.predicted, and the stage with the points that are coded. `trust`: whether sure points are
  /// not. `take`: whether what is predicted becomes the errors of the phase's points.
  static void make(ValueFields<Word>& fields, const PageShape& shape, int phase, bool trust, bool take,
                   ValueStage& stage);
};

}  // namespace adamas
