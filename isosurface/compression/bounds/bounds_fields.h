#pragma once

#include <array>
#include <cstdint>

#include "isosurface/compression/bounds/range_rounding.h"
#include "isosurface/compression/parity_cells.h"
#include "isosurface/preprocessing/own_errors.h"
#include "isosurface/volume/page.h"

namespace adamas::isosurface {

/// What is known of a page while its bounds become known, in cells by parity. Ranges have two sides, which
/// are worked on alike: side 0 has the least samples; side 1 has the greatest ones with all bits inverted, so
/// that the greatest is the least there. The greatest word stands where nothing is known.
template <class Word>
struct BoundsFields {
  static constexpr Word kUnknown = RangeRounding<Word>::kUnknown;

  RangeRounding<Word> rounding;  ///< the rounding of all ranges of the page and of those before it

  /// Loads what is known before any bound; of a complete page its samples alone.
  void load(const PageShape& shape, const Surroundings<Word>& around, const PageSamples<Word>& page);
  /// Loads the page's own bounds, for an encoder.
  void load_bounds(const PageShape& shape, const PageBounds<Word>& page);
  /// Gives all own points the same error.
  void fill_errors(const PageShape& shape, std::uint8_t code);
  /// Gives all own points the same range, by side.
  void fill_ranges(const PageShape& shape, const std::array<Word, 2>& range);
  /// Makes `predicted` the own errors that follow from the samples, which are found on the finest LOD alone:
  /// what those of a coarse LOD tell is not worth working out.
  void predict_errors(const PageShape& shape, const OwnErrorGeometry& geometry);
  /// Stores the bounds of all places of the page.
  void store_bounds(const PageShape& shape, PageBounds<Word>& page) const;

  std::array<AllCells<Word>, 2> samples;  ///< words of finite samples
  std::array<AllCells<Word>, 2> ranges;   ///< the ranges found so far, and those of coarser LODs
  AllCells<std::uint8_t> errors;          ///< codes found so far, and those of coarser LODs; 0 elsewhere
  /// The greatest end of the ranges of the parents of the diamonds in a cube of 2^3 points, in the cell of
  /// the cube's centre; 0 where it is not known.
  std::array<ParityCells<Word>, 2> cube_limits;
  /// 63 less the greatest code that the least error of these parents lets a point have, by cube; 0 where it
  /// is not known.
  ParityCells<std::uint8_t> cube_error_room;
  /// The page's samples and those round it as numbers, on the finest LOD alone; those that are not known are
  /// like others that are, and none is infinite.
  SampleBlock<float> numbers;

  // What stages work with, of the points of one parity; the predictions of errors of all.
  std::array<ParityCells<Word>, 2> known;   ///< the ends that RangeStages expects
  std::array<ParityCells<Word>, 2> limits;  ///< the least end of a range; not above `known`
  AllCells<std::uint8_t> predicted;         ///< own errors, of which ErrorStages makes what is expected

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
