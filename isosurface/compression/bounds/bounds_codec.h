#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "adamas/geometry.h"
#include "isosurface/compression/bounds/range_rounding.h"
#include "isosurface/compression/entropy/rans_coder.h"
#include "isosurface/preprocessing/own_errors.h"
#include "isosurface/volume/page.h"

namespace adamas::isosurface {

/// Counts the errors and ranges of pages, for the tables of a codec. A codec can code any page, but less well
/// if the page was not counted.
template <class Word>
class BoundsSurvey {
 public:
  /// Makes an empty survey. `spacing` is that of the volume's samples, `rounding` that of the ranges of all
  /// pages.
  explicit BoundsSurvey(const Vec3& spacing, const RangeRounding<Word>& rounding = {});

  /// Counts a page. `around` is not read where the page is complete; of `page` only places that have points
  /// are read.
  void add(const PageShape& shape, const Surroundings<Word>& around, const Page<Word>& page);
  /// Adds the counts of another survey. The order of pages and of merging does not matter.
  void merge(const BoundsSurvey& other) { counts_.merge(other.counts_); }

  [[nodiscard]] const OwnErrorGeometry& geometry() const { return geometry_; }
  [[nodiscard]] const RangeRounding<Word>& rounding() const { return rounding_; }
  [[nodiscard]] const ContextCounts& counts() const { return counts_; }

 private:
  OwnErrorGeometry geometry_;
  RangeRounding<Word> rounding_;
  ContextCounts counts_;
};

/// Codes the error codes (below 64) and the ranges (any words, rounded) of a page's own points, lossless,
/// from the bounds of coarser LODs and the page's samples. Several threads may use it at once. Word: see
/// Page.
template <class Word>
class BoundsCodec {
 public:
  explicit BoundsCodec(const BoundsSurvey<Word>& survey)
      : BoundsCodec(survey.geometry(), survey.rounding(), ContextTables(survey.counts())) {}

  /// Returns the bytes from which `parse` makes the codec again; they are the same for equal surveys.
  [[nodiscard]] std::vector<std::byte> tables() const;
  /// Makes a codec from its tables. Throws Error, which begins with `name`, unless some codec's `tables`
  /// could have given just these bytes. `spacing` is that of the survey.
  [[nodiscard]] static BoundsCodec parse(std::span<const std::byte> tables, const Vec3& spacing,
                                         std::string_view name);

  /// Appends the bounds of the page's own points, in whole bytes. `around` is not read where the page is
  /// complete; of `page` only places that have points are read.
  void encode(const PageShape& shape, const Surroundings<Word>& around, const Page<Word>& page,
              std::vector<std::byte>& out) const;
  /// Fills the errors and ranges of all places that have points, those of coarser LODs from `around`; the
  /// samples are those with which the page was encoded. Returns false, with undefined `bounds`, where the
  /// bytes are not a result of `encode`.
  [[nodiscard]] bool decode(std::span<const std::byte> bytes, const PageShape& shape,
                            const Surroundings<Word>& around, const PageSamples<Word>& samples,
                            PageBounds<Word>& bounds) const;

 private:
  /// Returns whether these bounds, of equal ranges, are coded as such.
  [[nodiscard]] bool are_equal_ranges_coded(const PageShape& shape, const Surroundings<Word>& around,
                                            const PageSamples<Word>& samples,
                                            const PageBounds<Word>& bounds) const;

  BoundsCodec(const OwnErrorGeometry& geometry, const RangeRounding<Word>& rounding, ContextTables contexts)
      : geometry_(geometry), rounding_(rounding), contexts_(std::move(contexts)), tables_(contexts_) {}

  OwnErrorGeometry geometry_;
  RangeRounding<Word> rounding_;
  ContextTables contexts_;
  RansTables tables_;
};

}  // namespace adamas::isosurface
