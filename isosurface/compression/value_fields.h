#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "isosurface/compression/height_grid.h"
#include "isosurface/compression/padded_grid.h"
#include "isosurface/storage/page.h"

namespace adamas {

/// What is known of a page while its values become known. Of the two sides of the ranges, side 0 is that of
/// the least samples; side 1 has all bits inverted, so that what is greatest is least there too. The greatest
/// word stands where nothing is known.
template <class Word>
struct ValueFields {
  static constexpr Word kUnknown = static_cast<Word>(~Word{0});

  /// What is known before any value; of a complete page its samples alone.
  void load(const PageShape& shape, const Surroundings<Word>& around, const Page<Word>& page);
  /// The page's own values, for an encoder.
  void load_values(const PageShape& shape, const Page<Word>& page);
  /// Gives all own points the same error.
  void fill_errors(const PageShape& shape, std::uint8_t code);

  /// What no range of a point's diamond falls below, as far as something is known of it.
  [[nodiscard]] Word bound(std::size_t side, std::size_t place) const {
    return std::min(bounds[side][place], known[side][place]);
  }

  std::array<PaddedGrid<Word>, 2> samples;  ///< words of finite samples
  std::array<PaddedGrid<Word>, 2> values;   ///< the ranges found so far, and those of coarser levels
  std::array<PaddedGrid<Word>, 2> known;    ///< what RangeStages makes
  /// The greatest of the least samples of the diamonds that are parents of a cube's that the point is in or
  /// on; 0 where they are not known.
  std::array<PaddedGrid<Word>, 2> bounds;
  HeightGrid heights;  ///< finite; what is not known is mirrored
  /// Codes found so far, and those of coarser levels; 0 elsewhere.
  PaddedGrid<std::uint8_t> errors;
  PaddedGrid<std::uint8_t> predicted;       ///< own errors, of which ErrorStages makes what is expected
  PaddedGrid<std::uint8_t> error_contexts;  ///< what ErrorStages works with
  /// The greatest code that the least error of these parents lets a point have.
  PaddedGrid<std::uint8_t> most_errors;

 private:
  void load_points(const PageShape& shape, const Page<Word>& page);
  void load_whole_row(LatticePoint first, const Word* row);
  void load_behind(const PageShape& shape, const Surroundings<Word>& around);
  void set_point(LatticePoint q, Word sample);
  template <int Axis>
  void mirror(const PageShape& shape);
  void load_coarser(const PageShape& shape, const Surroundings<Word>& around);
  void load_parents(const PageShape& shape, const Surroundings<Word>& around);
};

}  // namespace adamas
