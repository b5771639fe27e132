#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "isosurface/compression/bounds/bounds_walk.h"

namespace adamas::isosurface {

/// How a page's errors are coded, and its ranges. The first that serves is taken.
enum class ErrorMode : std::uint8_t {
  kZero,                ///< all are 0
  kEqual,               ///< all are the same
  kCodedButDetermined,  ///< determined points are as predicted, the others are coded
  kCoded
};
enum class RangeMode : std::uint8_t {
  kEmpty,               ///< all have nothing in them
  kPredicted,           ///< all as predicted
  kCodedButDetermined,  ///< as of errors
  kCoded,
  kEqual  ///< all are the same; taken before those that are coded
};

constexpr bool is_coded(ErrorMode mode) { return mode >= ErrorMode::kCodedButDetermined; }
constexpr bool is_coded(RangeMode mode) {
  return mode == RangeMode::kCodedButDetermined || mode == RangeMode::kCoded;
}

/// What is to be found of a page's errors and ranges to know their modes.
struct BoundsSummary {
  std::uint8_t any_error = 0;    ///< the bits that some code has
  std::uint8_t all_errors = 63;  ///< the bits that all have
  bool any_word = false;         ///< whether a range is not empty
  bool any_other = false;        ///< whether a range is not as predicted
  bool any_determined_error_other = false, any_determined_range_other = false;  ///< of determined points
  bool equal_ranges = false;  ///< whether all are the same; looked at where some is not as predicted

  /// Takes in the page's own errors.
  template <class Word>
  void add_errors(const PageShape& shape, const BoundsFields<Word>& fields);
  /// Takes in whether its ranges are empty, and whether they are the same.
  template <class Word>
  void add_ranges(const PageShape& shape, const BoundsFields<Word>& fields);

  [[nodiscard]] ErrorMode error_mode() const {
    if (any_error == 0) return ErrorMode::kZero;
    if (any_error == all_errors) return ErrorMode::kEqual;
    return any_determined_error_other ? ErrorMode::kCoded : ErrorMode::kCodedButDetermined;
  }
  [[nodiscard]] RangeMode range_mode() const {
    if (!any_word) return RangeMode::kEmpty;
    if (!any_other) return RangeMode::kPredicted;
    if (equal_ranges) return RangeMode::kEqual;
    return any_determined_range_other ? RangeMode::kCoded : RangeMode::kCodedButDetermined;
  }
};

/// The range of a page's first own point, by side.
template <class Word>
std::array<Word, 2> first_range(const PageShape& shape, const BoundsFields<Word>& fields);

/// What a page's errors and ranges are coded as.
template <class Word>
class BoundsSymbols {
 public:
  /// The ranges of the page and round it are rounded.
  BoundsSymbols(const OwnErrorGeometry& geometry, const RangeRounding<Word>& rounding, const PageShape& shape,
                const Surroundings<Word>& around, const Page<Word>& page);

  struct Extra {
    std::uint32_t bits;
    int count;
  };
  struct Stage {
    std::size_t base = 0;  ///< to which contexts are added
    std::vector<std::uint8_t> contexts, symbols;
    std::vector<Extra> extras;  ///< the bits that symbols leave open, in their order
  };

  [[nodiscard]] const BoundsSummary& summary() const { return summary_; }
  /// Of the page's first own point, by side: that of all where they are the same.
  [[nodiscard]] std::array<Word, 2> first_range() const {
    return adamas::isosurface::first_range(shape_, *fields_);
  }
  /// Those to be coded, by stages.
  [[nodiscard]] const std::vector<Stage>& stages() const { return stages_; }

  // For walk_bounds.
  [[nodiscard]] static bool needs_errors() { return true; }
  [[nodiscard]] static bool needs_ranges() { return true; }
  void errors(const BoundsStage& stage);
  void range(std::size_t side, const BoundsStage& stage);

 private:
  void collect(const OwnErrorGeometry& geometry, Omissions omitted);
  void leave_out_what_modes_tell();
  /// Adds the stage, with the symbols that symbol(cell) gives of the points that are coded. Returns whether
  /// any other point is not as expected.
  template <class T, class Symbol>
  bool add(const BoundsStage& stage, const ParityCells<T>& found, const ParityCells<T>& expected,
           Symbol symbol);

  PageShape shape_;
  std::unique_ptr<BoundsFields<Word>> fields_;
  BoundsSummary summary_;
  std::vector<Stage> stages_;
  std::vector<std::size_t> range_stages_;  ///< which of them
};

}  // namespace adamas::isosurface
