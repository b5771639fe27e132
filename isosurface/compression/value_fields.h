#pragma once

#include <array>
#include <cstdint>

#include "isosurface/compression/height_grid.h"
#include "isosurface/compression/padded_grid.h"
#include "isosurface/compression/row_lanes.h"
#include "isosurface/compression/value_stage.h"
#include "isosurface/storage/page.h"

namespace adamas {

/// Numbers of the cubes of a page, whose centres are the points of phase 0, one more on each side: that whose
/// centre is at 2 c - 1 has the coordinates c from 0 to 9.
template <class T>
using CubeNumbers = std::array<T, 1000>;
constexpr std::size_t cube_place(std::int32_t i, std::int32_t j, std::int32_t k) {
  return static_cast<std::size_t>(i + 10 * (j + 10 * k));
}

/// For the points of a row, whose first is q, in steps of two: the greatest number of the cubes that each is
/// in.
template <class T>
std::array<T, 8> greatest_of_cubes(const CubeNumbers<T>& cubes, LatticePoint q) {
  const T* first = cubes.data() + cube_place(first_cube(q.i), first_cube(q.j), first_cube(q.k));
  const std::ptrdiff_t i = (q.i & 1) ^ 1, j = 10 * ((q.j & 1) ^ 1), k = 100 * ((q.k & 1) ^ 1);
  RowLanes<T, 8> lanes(first);
  const auto take = [&lanes, i](const T* from) {
    lanes.take_greatest(from);
    lanes.take_greatest(from + i);
  };
  take(first);
  if (j != 0) take(first + j);
  if (k != 0) take(first + k);
  if (j != 0 && k != 0) take(first + j + k);
  std::array<T, 8> row;
  lanes.store(row.data());
  return row;
}

/// What is known of a page that is not complete while its values become known. Of the two sides of the
/// ranges, side 0 is that of the least samples; side 1 has all bits inverted, so that what is greatest is
/// least there too. The greatest word stands where nothing is known.
template <class Word>
struct ValueFields {
  static constexpr Word kUnknown = static_cast<Word>(~Word{0});

  void load(const PageShape& shape, const Surroundings<Word>& around, const Page<Word>& page);

  std::array<PaddedGrid<Word>, 2> samples;  ///< words of finite samples
  std::array<PaddedGrid<Word>, 2> values;   ///< the ranges found so far
  HeightGrid heights;                       ///< finite; what is not known is mirrored
  PaddedGrid<std::uint8_t> errors;          ///< codes found so far, 0 elsewhere

  /// What no diamond in the cube or on its faces falls below: the greatest of the least samples of the
  /// diamonds that are parents of the cube's; 0 where they are not known.
  std::array<CubeNumbers<Word>, 2> least;
  /// 63 less the least error code of these, on their own scale; 0 where they are not known.
  CubeNumbers<std::uint8_t> error_room;

 private:
  void load_points(const PageShape& shape, const Surroundings<Word>& around, const Page<Word>& page);
  void set_point(LatticePoint q, Word sample);
  template <int Axis>
  void mirror(const PageShape& shape);
  void load_parents(const PageShape& shape, const Surroundings<Word>& around);
};

}  // namespace adamas
