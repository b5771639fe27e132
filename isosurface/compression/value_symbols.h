#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "isosurface/compression/value_walk.h"

namespace adamas {

/// How a page's errors are coded, and its ranges. The first that serves is taken.
enum class ErrorMode : std::uint8_t {
  kZero,   ///< all are 0
  kEqual,  ///< all are the same
  kCoded
};
enum class RangeMode : std::uint8_t {
  kEmpty,         ///< all have nothing in them
  kPredicted,     ///< all as predicted
  kCodedButSure,  ///< those that were sure are as predicted, the others are coded
  kCoded
};

/// What is to be found of a page's errors and ranges to know their modes.
template <class Word>
struct ValueSummary {
  std::uint8_t any_error = 0;    ///< the bits that any of the codes has
  std::uint8_t all_errors = 63;  ///< the bits that all have
  bool any_other = false;        ///< a word of a range that is not predicted
  bool any_sure_other = false;   ///< among those of which all is known
  bool any_word = false;         ///< a range that is not empty

  void add_error(std::uint8_t code) {
    any_error |= code;
    all_errors &= code;
  }
  void add_range(Word value, Word predicted, bool sure) {
    any_other |= value != predicted;
    any_sure_other |= sure && value != predicted;
    any_word |= value != ValueFields<Word>::kUnknown;
  }

  /// Points whose ranges are as predicted.
  void add_sure(const ValueStage<Word>& stage) {
    for (std::size_t n = 0; n < stage.segment_count && !any_word; ++n) {
      const auto& [place, count, whole_row] = stage.segments[n];
      for (std::size_t m = place; m < place + 2u * count; m += 2) {
        any_word |= stage.sure[m] != ValueFields<Word>::kUnknown;
      }
    }
  }

  [[nodiscard]] ErrorMode error_mode() const {
    if (any_error == 0) return ErrorMode::kZero;
    return any_error == all_errors ? ErrorMode::kEqual : ErrorMode::kCoded;
  }
  [[nodiscard]] RangeMode range_mode() const {
    if (!any_word) return RangeMode::kEmpty;
    if (!any_other) return RangeMode::kPredicted;
    return any_sure_other ? RangeMode::kCoded : RangeMode::kCodedButSure;
  }
};

/// What a page's errors and ranges are coded as.
template <class Word>
class ValueSymbols {
 public:
  ValueSymbols(const PageShape& shape, const Surroundings<Word>& around, const Page<Word>& page);

  struct Stage {
    std::vector<std::uint16_t> contexts;
    std::vector<std::uint8_t> symbols;
  };
  struct Extra {
    std::uint32_t bits;
    int count;
  };

  [[nodiscard]] const ValueSummary<Word>& summary() const { return summary_; }
  /// Those to be coded, by stages.
  [[nodiscard]] const std::vector<Stage>& stages() const { return stages_; }
  /// The bits that symbols leave open, in their order.
  [[nodiscard]] const std::vector<Extra>& extras() const { return extras_; }

  // For walk_values.
  [[nodiscard]] static bool needs_errors() { return true; }
  [[nodiscard]] static bool needs_ranges() { return true; }
  void errors(const ValueStage<std::uint8_t>& stage,
              const typename Page<Word>::template Points<std::uint8_t>& codes);
  void range(const ValueStage<Word>& stage, std::size_t side,
             const typename Page<Word>::template Points<Word>& words);

 private:
  void collect(const PageShape& shape, const Surroundings<Word>& around, const Page<Word>& page, bool trust);
  void leave_out_what_modes_tell();

  ValueSummary<Word> summary_;
  std::vector<Stage> stages_;
  std::vector<std::size_t> range_stages_;  ///< which of them
  std::vector<Extra> extras_;
};

}  // namespace adamas
