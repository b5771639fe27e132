#include "isosurface/compression/bounds/bounds_fields.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/base/simd.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {
namespace {

/// The limit of numbers, whose squares are then far from overflow.
constexpr float kMostNumber = 1e15f;

template <class Word>
bool is_finite(Word word) {
  if constexpr (sizeof(Word) < 4) {
    return true;
  } else {
    return word > ordered(-std::numeric_limits<float>::infinity()) &&
           word < ordered(std::numeric_limits<float>::infinity());
  }
}

template <class Word>
float number(Word word) {
  if constexpr (sizeof(Word) < 4) {
    return static_cast<float>(word);
  } else {
    return is_finite(word) ? std::clamp(from_ordered<float>(word), -kMostNumber, kMostNumber) : 0;
  }
}

constexpr std::uint8_t kMostCode = 63;

using Codes = EightLanes<std::uint8_t>;

/// Returns 63 less the greatest code that a child of diamonds with these codes may have; these codes are on
/// the scale of the next coarser LOD.
Codes error_room_of(const Codes& parents) {
  constexpr std::uint8_t kLod = 4;
  const Codes::Part codes = parents.parts[0], most = Codes::Part{} + (kMostCode - kLod);
  const Codes::Part room = codes < most ? most - codes : Codes::Part{};
  return {{codes == 0 ? Codes::Part{} + kMostCode : room}};
}

/// The places in Surroundings of the parents of the diamonds in a row of cubes, whose centres have the
/// coordinates j and k. Parents are the corners of a cube in the middle of edges of the next coarser cubes,
/// which have one coordinate that is no multiple of four.
class ParentRows {
 public:
  ParentRows(std::int32_t j, std::int32_t k) {
    const auto whole = [](std::int32_t x) { return x + 1 - ((x + 1) & 2); };
    const std::int32_t whole_j = whole(j), whole_k = whole(k);
    along_i_ = surrounding_place({0, whole_j, whole_k});
    along_j_ = surrounding_place({0, 2 * j - whole_j, whole_k});
    along_k_ = surrounding_place({0, whole_j, 2 * k - whole_k});
  }

  /// Returns choose(...) of the numbers of the parents, for eight cubes from the page's first on.
  template <class T, class Choose>
  EightLanes<T> find(const T* around, Choose choose) const {
    using Lanes = EightLanes<T>;
    const auto at = [around](std::size_t place) { return Lanes::load(around + place); };
    // The cube n lies between the even points n and n + 1 of the row.
    const auto half = Lanes::by_turns(at(along_i_ + 1), at(along_i_));
    const auto whole_j = Lanes::by_turns(at(along_j_), at(along_j_ + 1));
    const auto whole_k = Lanes::by_turns(at(along_k_), at(along_k_ + 1));
    return choose(half, choose(whole_j, whole_k));
  }

 private:
  std::size_t along_i_, along_j_, along_k_;
};

/// Returns the last even coordinate round the page whose points are known.
std::int32_t last_even(std::int32_t count) { return count & ~1; }

/// Loads a row of 16 samples that are all finite, as numbers, by the parity of their coordinates.
template <class Word>
void load_whole_row(const Word* row, float* even, float* odd) {
  using Lanes = EightLanes<Word>;
  using Numbers [[gnu::vector_size(8 * sizeof(float))]] = float;
  std::array<Lanes, 2> lanes;
  Lanes::load_by_turns(row, lanes[0], lanes[1]);
  // Eight words of at most two bytes are one part.
  const Numbers first = __builtin_convertvector(lanes[0].parts[0], Numbers),
                second = __builtin_convertvector(lanes[1].parts[0], Numbers);
  std::memcpy(even, &first, sizeof first);
  std::memcpy(odd, &second, sizeof second);
}

/// Calls visit(parity, cell, place, number of points) for each row of a page's points of one parity. `place`
/// is that of the first of them; the others follow in steps of two.
template <class Visit>
void for_each_row(const PageShape& shape, int parity, Visit visit) {
  const std::size_t first = PageGrid::place({parity & 1, parity >> 1 & 1, parity >> 2}, 0);
  std::size_t j = 0, k = 0;
  const ParityBox box = ParityBox::for_parity(shape.count, parity);
  box.for_each_row([&](std::size_t cell, std::size_t, auto count) {
    visit(cell, first + 2 * PageGrid::kSide * (j + PageGrid::kSide * k), count);
    if (++j == static_cast<std::size_t>(box.nj)) j = 0, ++k;
  });
}

}  // namespace

template <class Word>
void BoundsFields<Word>::load(const PageShape& shape, const Surroundings<Word>& around,
                              const PageSamples<Word>& page) {
  with_wide_lanes([&](auto) {
    for (std::size_t side = 0; side < 2; ++side) {
      for (std::size_t parity = 0; parity < 8; ++parity) {
        samples[side][parity].fill(kUnknown);
        ranges[side][parity].fill(kUnknown);
      }
    }
    for (auto& cells : errors) cells.fill(0);
    load_points(shape, page);
    if (shape.complete) return;
    load_coarser(around);
    load_parents(shape, around);
    if (shape.lod == 0) load_numbers(shape, around, page);
  });
}

template <class Word>
void BoundsFields<Word>::load_points(const PageShape& shape, const PageSamples<Word>& page) {
  if (sizeof(Word) < sizeof(float) && !shape.complete && shape.count == LatticePoint{16, 16, 16})
    return load_whole(page);
  for (int parity = shape.complete ? 0 : 1; parity < 8; ++parity) {
    Word* const least = samples[0][static_cast<std::size_t>(parity)].data();
    Word* const greatest = samples[1][static_cast<std::size_t>(parity)].data();
    for_each_row(shape, parity, [&](std::size_t cell, std::size_t place, auto count) {
      const Word* from = page.samples.data() + place;
      std::array<Word, 8> row;
      for (int i = 0; i < count; ++i) row[static_cast<std::size_t>(i)] = from[2 * i];
      for (int i = 0; i < count; ++i) {
        const Word word = row[static_cast<std::size_t>(i)];
        least[cell + static_cast<std::size_t>(i)] = is_finite(word) ? word : kUnknown;
        greatest[cell + static_cast<std::size_t>(i)] = is_finite(word) ? static_cast<Word>(~word) : kUnknown;
      }
    });
  }
}

/// Loads a page with all points, whose samples are all finite.
template <class Word>
void BoundsFields<Word>::load_whole(const PageSamples<Word>& page) {
  using Lanes = EightLanes<Word>;
  for (std::int32_t k = 0; k < PageGrid::kSide; ++k) {
    for (std::int32_t j = 0; j < PageGrid::kSide; ++j) {
      const auto even = static_cast<std::size_t>((j & 1) << 1 | (k & 1) << 2);
      const std::size_t cell = surrounding_place({0, j & ~1, k & ~1});
      std::array<Lanes, 2> lanes;
      Lanes::load_by_turns(page.samples.data() + PageGrid::place({0, j, k}, 0), lanes[0], lanes[1]);
      for (std::size_t odd = even == 0 ? 1 : 0; odd < 2; ++odd) {
        lanes[odd].store(samples[0][even + odd].data() + cell);
        lanes[odd].inverted().store(samples[1][even + odd].data() + cell);
      }
    }
  }
}

/// Loads the points whose coordinates are all even.
template <class Word>
void BoundsFields<Word>::load_coarser(const Surroundings<Word>& around) {
  Word* const least = samples[0][0].data();
  Word* const greatest = samples[1][0].data();
  Word* const high = ranges[1][0].data();
  ADAMAS_INDEPENDENT
  for (std::size_t n = 0; n < around.samples.size(); ++n) {
    const Word word = around.samples[n];
    least[n] = is_finite(word) ? word : kUnknown;
    greatest[n] = is_finite(word) ? static_cast<Word>(~word) : kUnknown;
    high[n] = static_cast<Word>(~around.high[n]);
  }
  ranges[0][0] = around.low;
  errors[0] = around.errors;
}

template <class Word>
void BoundsFields<Word>::load_numbers(const PageShape& shape, const Surroundings<Word>& around,
                                      const PageSamples<Word>& page) {
  const LatticePoint count = shape.count;
  if (count != LatticePoint{16, 16, 16}) numbers.fill(0);
  for (std::int32_t k = 0; k < count.k; ++k) {
    for (std::int32_t j = 0; j < count.j; ++j) {
      const Word* row = page.samples.data() + PageGrid::place({0, j, k}, 0);
      if constexpr (sizeof(Word) < sizeof(float)) {
        if (count.i == PageGrid::kSide) {
          load_whole_row(row, numbers.at({0, j, k}), numbers.at({1, j, k}));
          continue;
        }
      }
      for (std::int32_t i = 0; i < count.i; ++i) *numbers.at({i, j, k}) = number(row[i]);
    }
  }
  // These cells are behind the page, where the samples of coarser LODs are known.
  const LatticePoint last{last_even(count.i), last_even(count.j), last_even(count.k)};
  for (std::int32_t k = 0; k <= last.k; k += 2) {
    for (std::int32_t j = 0; j <= last.j; j += 2) {
      const bool behind = k >= count.k || j >= count.j;
      for (std::int32_t i = behind ? 0 : last.i; i <= last.i; i += 2) {
        if (behind || i >= count.i)
          *numbers.at({i, j, k}) = number(around.samples[surrounding_place({i, j, k})]);
      }
    }
  }
  mirror<0>(shape);
  mirror<1>(shape);
  mirror<2>(shape);
}

/// Fills unknown neighbours: before the page and behind it with the number of the other neighbour, between
/// two known points behind the page with their mean.
template <class Word>
template <int Axis>
void BoundsFields<Word>::mirror(const PageShape& shape) {
  constexpr int kA = Axis == 0 ? 1 : 0, kB = Axis == 2 ? 1 : 2;
  LatticePoint step{};
  step[Axis] = 1;
  const std::int32_t end = shape.count[Axis];
  const bool even = (end & 1) == 0;
  for (std::int32_t y = -1; y <= shape.count[kB] && y <= 16; ++y) {
    for (std::int32_t x = -1; x <= shape.count[kA] && x <= 16; ++x) {
      LatticePoint q{};
      q[kA] = x, q[kB] = y, q[Axis] = -1;
      *numbers.at(q) = *numbers.at(q + 2 * step);
      q[Axis] = end;
      if (even && ((x | y) & 1) == 0) continue;
      const bool inside = x >= 0 && y >= 0 && x < shape.count[kA] && y < shape.count[kB];
      if (!even || !inside) {
        *numbers.at(q) = *numbers.at(q - (end >= 2 ? 2 : 1) * step);
        continue;
      }
      LatticePoint d{};
      d[kA] = x & 1, d[kB] = y & 1;
      if (d[kA] != 0 && d[kB] != 0 && (((x ^ y) & 2) != 0)) d[kA] = -1;
      *numbers.at(q) = 0.5f * (*numbers.at(q - d) + *numbers.at(q + d));
    }
  }
}

template <class Word>
void BoundsFields<Word>::load_parents(const PageShape& shape, const Surroundings<Word>& around) {
  using Words = EightLanes<Word>;
  for (auto& cells : cube_limits) cells.fill(0);
  cube_error_room.fill(0);
  const ParityBox box = ParityBox::for_parity(shape.count, 7);
  std::int32_t j = 1, k = 1;
  box.for_each_row([&](std::size_t cell, std::size_t, auto count) {
    const ParentRows rows(j, k);
    const auto store = [&](const auto& lanes, auto& cells) {
      std::array<typename std::remove_reference_t<decltype(cells)>::value_type, 8> row;
      lanes.store(row.data());
      std::copy_n(row.begin(), static_cast<int>(count), cells.begin() + static_cast<std::ptrdiff_t>(cell));
    };
    store(rows.find(around.low.data(), Words::greatest), cube_limits[0]);
    store(rows.find(around.high.data(), Words::least).inverted(), cube_limits[1]);
    store(error_room_of(rows.find(around.errors.data(), Codes::least)), cube_error_room);
    j += 2;
    if (j > 2 * box.nj) j = 1, k += 2;
  });
}

template <class Word>
void BoundsFields<Word>::predict_errors(const PageShape& shape, const OwnErrorGeometry& geometry) {
  if (shape.lod > 0) {
    for (auto& cells : predicted) cells.fill(0);
    return;
  }
  OwnErrorCodes codes;
  own_errors(numbers, numbers, geometry, shape.count, codes);
  for (std::int32_t k = 0; k < shape.count.k; ++k) {
    for (std::int32_t j = 0; j < shape.count.j; ++j) {
      const auto even = static_cast<std::size_t>((j & 1) << 1 | (k & 1) << 2);
      const std::size_t cell = surrounding_place({0, j & ~1, k & ~1});
      std::copy_n(codes.even(j, k), 8, predicted[even].data() + cell);
      std::copy_n(codes.odd(j, k), 8, predicted[even + 1].data() + cell);
    }
  }
}

template <class Word>
void BoundsFields<Word>::load_bounds(const PageShape& shape, const PageBounds<Word>& page) {
  for (int parity = shape.complete ? 0 : 1; parity < 8; ++parity) {
    const auto p = static_cast<std::size_t>(parity);
    for_each_row(shape, parity, [&](std::size_t cell, std::size_t place, int count) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        ranges[0][p][cell + i] = page.low[place + 2 * i];
        ranges[1][p][cell + i] = static_cast<Word>(~page.high[place + 2 * i]);
        errors[p][cell + i] = page.errors[place + 2 * i];
      }
    });
  }
}

template <class Word>
void BoundsFields<Word>::fill_errors(const PageShape& shape, std::uint8_t code) {
  for (int parity = shape.complete ? 0 : 1; parity < 8; ++parity) {
    for_each_row(shape, parity, [&](std::size_t cell, std::size_t, int count) {
      std::fill_n(errors[static_cast<std::size_t>(parity)].begin() + static_cast<std::ptrdiff_t>(cell), count,
                  code);
    });
  }
}

template <class Word>
void BoundsFields<Word>::fill_ranges(const PageShape& shape, const std::array<Word, 2>& range) {
  for (int parity = shape.complete ? 0 : 1; parity < 8; ++parity) {
    for_each_row(shape, parity, [&](std::size_t cell, std::size_t, int count) {
      for (std::size_t side = 0; side < 2; ++side)
        std::fill_n(
            ranges[side][static_cast<std::size_t>(parity)].begin() + static_cast<std::ptrdiff_t>(cell), count,
            range[side]);
    });
  }
}

template <class Word>
void BoundsFields<Word>::store_bounds(const PageShape& shape, PageBounds<Word>& page) const {
  with_wide_lanes([&](auto) {
    for (std::int32_t k = 0; k < shape.count.k; ++k) {
      for (std::int32_t j = 0; j < shape.count.j; ++j) {
        const auto even = static_cast<std::size_t>((j & 1) << 1 | (k & 1) << 2);
        const std::size_t cell = surrounding_place({0, j & ~1, k & ~1}), to = PageGrid::place({0, j, k}, 0);
        const auto join = [&](const auto& all, auto* row, auto change) {
          using Lanes = EightLanes<typename std::remove_cvref_t<decltype(all[0])>::value_type>;
          Lanes::store_by_turns(change(Lanes::load(all[even].data() + cell)),
                                change(Lanes::load(all[even + 1].data() + cell)), row + to);
        };
        const auto same = [](const auto& lanes) { return lanes; };
        join(ranges[0], page.low.data(), same);
        join(ranges[1], page.high.data(), [](const auto& lanes) { return lanes.inverted(); });
        join(errors, page.errors.data(), same);
      }
    }
  });
}

ADAMAS_INSTANTIATE_FOR_WORDS(BoundsFields);

}  // namespace adamas::isosurface
