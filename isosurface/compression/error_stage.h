#pragma once

#include <cstdint>

#include "core/geometry/vec3.h"
#include "isosurface/compression/value_fields.h"
#include "isosurface/compression/value_stage.h"

namespace adamas {

/// What is expected of the error codes of a phase's points: `predicted` is that which the known samples in
/// and on the diamond and its children give. Edges first, then faces, then centres.
template <class Word>
class ErrorStages {
 public:
  static constexpr int kRoomClasses = 8;
  static constexpr std::uint16_t kContexts = 3 * 2 * 2 * 2 * kRoomClasses;

  static void make(const ValueFields<Word>& fields, const PageShape& shape, int phase,
                   ValueStage<std::uint8_t>& stage);
};

}  // namespace adamas
