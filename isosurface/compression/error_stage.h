#pragma once

#include <cstdint>

#include "isosurface/compression/known_errors.h"
#include "isosurface/compression/value_fields.h"
#include "isosurface/compression/value_stage.h"

namespace adamas {

/// What is expected of the error codes of a phase's points: `predicted` is that which the known samples in
/// and on the diamond and its children give. Edges first, then faces, then centres.
template <class Word>
class ErrorStages {
 public:
  static constexpr int kRoomClassCount = 8;
  static constexpr std::uint16_t kContexts = 3 * 2 * 2 * 2 * kRoomClassCount;

  static void make(const ValueFields<Word>& fields, const PageShape& shape, int phase,
                   ValueStage<std::uint8_t>& stage);

 private:
  static void add_row(const ValueKind& kind, LatticePoint q, const PageShape& shape, int phase,
                      const std::array<std::uint8_t, 8>& rooms, const ErrorRow& known,
                      const std::array<std::uint8_t, PageGrid::kSide>& children,
                      ValueStage<std::uint8_t>& stage);
};

}  // namespace adamas
