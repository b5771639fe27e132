#pragma once

#include <array>
#include <cstdint>

#include "isosurface/compression/bounds/range_rounding.h"
#include "isosurface/compression/parity_cells.h"
#include "isosurface/preprocessing/own_errors.h"
#include "isosurface/volume/page.h"

namespace adamas::isosurface {

/// The known numbers of a page while its bounds are coded, in cells by parity. Ranges have two sides, which
/// are treated alike: side 0 has the least samples; side 1 has the greatest ones with all bits inverted, so
/// that the greatest becomes the least. Unknown numbers are the greatest word.
template <class Word>
class BoundsFields {
 public:
  static constexpr Word kUnknown = RangeRounding<Word>::kUnknown;

  RangeRounding<Word> rounding;  ///< the rounding of all ranges of the page and of those before it

  /// Loads the numbers that are known before any bound; for a complete page its samples alone.
  void load(const PageShape& shape, const Surroundings<Word>& around, const PageSamples<Word>& page);
  /// Loads the page's own bounds, for an encoder.
  void load_bounds(const PageShape& shape, const PageBounds<Word>& page);
  /// Sets the same error for all own points.
  void fill_errors(const PageShape& shape, std::uint8_t code);
  /// Sets the same range for all own points, by side.
  void fill_ranges(const PageShape& shape, const std::array<Word, 2>& range);
  /// Fills `predicted` with the own errors that follow from the samples. It does so on the finest LOD alone:
  /// the gain on coarse LODs does not pay for the time.
  void predict_errors(const PageShape& shape, const OwnErrorGeometry& geometry);
  void store_bounds(const PageShape& shape, PageBounds<Word>& page) const;

  std::array<AllCells<Word>, 2> samples;  ///< words of finite samples
  std::array<AllCells<Word>, 2> ranges;   ///< the ranges decoded so far, and those of coarser LODs
  AllCells<std::uint8_t> errors;  ///< the codes decoded so far, and those of coarser LODs; 0 elsewhere
  /// The greatest end of the ranges of the parents of the diamonds in a cube of 2^3 points, in the cell of
  /// the cube's centre; 0 where it is not known.
  std::array<ParityCells<Word>, 2> cube_limits;
  /// 63 less the greatest code that a point may have according to the least error of these parents, by cube;
  /// 0 where it is not known.
  ParityCells<std::uint8_t> cube_error_room;
  /// The page's samples and those round it as numbers, on the finest LOD alone; unknown ones are copies or
  /// means of others, and none is infinite.
  SampleBlock<float> numbers;

  // The arrays below are the input of stages: for the points of one parity, except the predictions of errors,
  // which are for all points.
  std::array<ParityCells<Word>, 2> known;   ///< the expected ends of RangeStages
  std::array<ParityCells<Word>, 2> limits;  ///< the least possible ends of ranges; not above `known`
  AllCells<std::uint8_t> predicted;  ///< own errors, from which ErrorStages derives the expected errors

 private:
  void load_points(const PageShape& shape, const PageSamples<Word>& page);
  void load_whole(const PageSamples<Word>& page);
  void load_numbers(const PageShape& shape, const Surroundings<Word>& around, const PageSamples<Word>& page);
  void load_coarser(const Surroundings<Word>& around);
  void load_parents(const PageShape& shape, const Surroundings<Word>& around);
  template <int Axis>
  void mirror(const PageShape& shape);
};

}  // namespace adamas::isosurface
