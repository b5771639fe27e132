#include "isosurface/compression/value_fields.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "isosurface/compression/row_lanes.h"
#include "isosurface/compression/split_edge_prediction.h"
#include "isosurface/compression/wide_lanes.h"

namespace adamas {
namespace {

/// Squares of it are far from overflow.
constexpr float kMostHeight = 1e15f;

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
float height(Word word) {
  if constexpr (sizeof(Word) < 4) {
    return static_cast<float>(word);
  } else {
    return is_finite(word) ? std::clamp(from_ordered<float>(word), -kMostHeight, kMostHeight) : 0;
  }
}

constexpr std::uint8_t kMostCode = 63;

using Codes = EightLanes<std::uint8_t>;

/// 63 less the greatest code that a child of diamonds with these codes may have, which are on the scale of
/// the next coarser level.
Codes error_room_of(const Codes& parents) {
  constexpr std::uint8_t kLevel = 4;
  const Codes::Part codes = parents.parts[0], most = Codes::Part{} + (kMostCode - kLevel);
  const Codes::Part room = codes < most ? most - codes : Codes::Part{};
  return {{codes == 0 ? Codes::Part{} + kMostCode : room}};
}
Codes most_of_room(const Codes& rooms) { return {{kMostCode - rooms.parts[0]}}; }

/// Numbers of the cubes of a page, whose centres are the points of phase 0, one more on each side: that whose
/// centre is at 2 c - 1 has the coordinates c from 0 to 9. Rows of 16, of which the last are not used.
template <class T>
using CubeNumbers = std::array<T, 1600>;
constexpr std::size_t cube_place(std::int32_t i, std::int32_t j, std::int32_t k) {
  return static_cast<std::size_t>(i + 16 * (j + 10 * k));
}

/// Of a row of cubes, whose centres have the coordinates j and k: where in Surroundings the parents of their
/// diamonds lie. They are those corners of a cube that lie in the middle of edges of the next coarser cubes:
/// of which one coordinate is no multiple of four.
class ParentRows {
 public:
  ParentRows(std::int32_t j, std::int32_t k) {
    const auto whole = [](std::int32_t x) { return x + 1 - ((x + 1) & 2); };
    const std::int32_t whole_j = whole(j), whole_k = whole(k);
    along_i_ = surrounding_place({0, whole_j, whole_k});
    along_j_ = surrounding_place({0, 2 * j - whole_j, whole_k});
    along_k_ = surrounding_place({0, whole_j, 2 * k - whole_k});
  }

  /// Of eight cubes from the page's first on: `choose` of the numbers of their parents.
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

/// Calls visit(row, even, odd) with the greatest number of the cubes that each point of a row is in or on.
template <class T, class Visit>
void to_points(const CubeNumbers<T>& cubes, const PageShape& shape, Visit visit) {
  using Lanes = EightLanes<T>;
  // Two cubes along an axis have an even coordinate between them, one has an odd one.
  const auto first = [](std::int32_t x) { return (x + 1) / 2; };
  const auto second = [](std::int32_t x) { return x / 2 + 1; };
  for (std::int32_t k = 0; k < shape.count.k; ++k) {
    for (std::int32_t j = 0; j < shape.count.j; ++j) {
      const auto at = [&](std::int32_t i) {
        const auto load = [&](std::int32_t y, std::int32_t z) {
          return Lanes::load(cubes.data() + cube_place(i, y, z));
        };
        return Lanes::greatest(Lanes::greatest(load(first(j), first(k)), load(second(j), first(k))),
                               Lanes::greatest(load(first(j), second(k)), load(second(j), second(k))));
      };
      const auto before = at(0), behind = at(1);
      visit(LatticePoint{0, j, k}, Lanes::greatest(before, behind), behind);
    }
  }
}

/// The last even coordinate round the page whose points are known.
std::int32_t last_even(std::int32_t count) { return count & ~1; }

}  // namespace

template <class Word>
void ValueFields<Word>::load(const PageShape& shape, const Surroundings<Word>& around,
                             const Page<Word>& page) {
  with_wide_lanes([&](auto) {
    for (std::size_t side = 0; side < 2; ++side) {
      samples[side].fill(kUnknown);
      values[side].fill(kUnknown);
    }
    errors.fill(0);
    if (shape.count != LatticePoint{16, 16, 16}) heights.fill(0);
    load_points(shape, page);
    if (shape.complete) return;
    load_behind(shape, around);
    load_coarser(shape, around);
    mirror<0>(shape);
    mirror<1>(shape);
    mirror<2>(shape);
    load_parents(shape, around);
  });
}

template <class Word>
void ValueFields<Word>::set_point(LatticePoint q, Word sample) {
  *heights.at(q) = height(sample);
  if (!is_finite(sample)) return;
  *samples[0].at(q) = sample;
  *samples[1].at(q) = static_cast<Word>(~sample);
}

template <class Word>
void ValueFields<Word>::load_points(const PageShape& shape, const Page<Word>& page) {
  for (std::int32_t k = 0; k < shape.count.k; ++k) {
    for (std::int32_t j = 0; j < shape.count.j; ++j) {
      const Word* row = page.samples.data() + PageGrid::place({0, j, k}, 0);
      if (sizeof(Word) < sizeof(float) && shape.count.i == PageGrid::kSide) {
        load_whole_row({0, j, k}, row);
      } else {
        for (std::int32_t i = 0; i < shape.count.i; ++i) set_point({i, j, k}, row[i]);
      }
    }
  }
}

/// Of samples that are all finite.
template <class Word>
void ValueFields<Word>::load_whole_row(LatticePoint first, const Word* row) {
  using Words [[gnu::vector_size(16 * sizeof(Word))]] = Word;
  using Pairs [[gnu::vector_size(16 * sizeof(Word))]] = Wider<Word>;
  using Heights [[gnu::vector_size(8 * sizeof(float))]] = float;
  constexpr int kBits = 8 * sizeof(Word);
  Words words;
  std::memcpy(&words, row, sizeof words);
  std::memcpy(samples[0].at(first), &words, sizeof words);
  const Words inverted = ~words;
  std::memcpy(samples[1].at(first), &inverted, sizeof words);
  Pairs pairs;
  std::memcpy(&pairs, row, sizeof pairs);
  constexpr bool kLittle = std::endian::native == std::endian::little;
  const Heights low = __builtin_convertvector(pairs & Wider<Word>{kUnknown}, Heights),
                high = __builtin_convertvector(pairs >> kBits, Heights);
  std::memcpy(heights.at(first), kLittle ? &low : &high, sizeof low);
  std::memcpy(heights.at(first + LatticePoint{1, 0, 0}), kLittle ? &high : &low, sizeof high);
}

template <class Word>
void ValueFields<Word>::load_behind(const PageShape& shape, const Surroundings<Word>& around) {
  const LatticePoint last{last_even(shape.count.i), last_even(shape.count.j), last_even(shape.count.k)};
  for (std::int32_t k = 0; k <= last.k; k += 2) {
    for (std::int32_t j = 0; j <= last.j; j += 2) {
      const bool behind = k >= shape.count.k || j >= shape.count.j;
      for (std::int32_t i = behind ? 0 : last.i; i <= last.i; i += 2) {
        if (!behind && i < shape.count.i) continue;
        set_point({i, j, k}, around.samples[surrounding_place({i, j, k})]);
      }
    }
  }
}

/// The values of points of coarser levels, and what says that nothing is known between them.
template <class Word>
void ValueFields<Word>::load_coarser(const PageShape& shape, const Surroundings<Word>& around) {
  using Words = EightLanes<Word>;
  const Words unknown = Words{}.inverted();
  for (std::int32_t k = 0; k < shape.count.k; k += 2) {
    for (std::int32_t j = 0; j < shape.count.j; j += 2) {
      const LatticePoint row{0, j, k};
      const std::size_t from = surrounding_place(row);
      Words::store_by_turns(Words::load(around.low.data() + from), unknown, values[0].at(row));
      Words::store_by_turns(Words::load(around.high.data() + from).inverted(), unknown, values[1].at(row));
      Codes::store_by_turns(Codes::load(around.errors.data() + from), Codes{}, errors.at(row));
    }
  }
}

/// Before the page, and behind it, where a neighbour's height is not known, stands that of the other
/// neighbour; between two points that are known behind the page, their mean.
template <class Word>
template <int Axis>
void ValueFields<Word>::mirror(const PageShape& shape) {
  constexpr int kA = Axis == 0 ? 1 : 0, kB = Axis == 2 ? 1 : 2;
  LatticePoint step{};
  step[Axis] = 1;
  const std::int32_t end = shape.count[Axis];
  const bool even = (end & 1) == 0;
  for (std::int32_t y = -1; y <= shape.count[kB] && y <= 16; ++y) {
    for (std::int32_t x = -1; x <= shape.count[kA] && x <= 16; ++x) {
      LatticePoint q{};
      q[kA] = x, q[kB] = y, q[Axis] = -1;
      *heights.at(q) = *heights.at(q + 2 * step);
      q[Axis] = end;
      if (even && ((x | y) & 1) == 0) continue;
      const bool inside = x >= 0 && y >= 0 && x < shape.count[kA] && y < shape.count[kB];
      if (!even || !inside) {
        *heights.at(q) = *heights.at(q - (end >= 2 ? 2 : 1) * step);
        continue;
      }
      LatticePoint d{};
      d[kA] = x & 1, d[kB] = y & 1;
      if (d[kA] != 0 && d[kB] != 0 && (((x ^ y) & 2) != 0)) d[kA] = -1;
      *heights.at(q) = 0.5f * (*heights.at(q - d) + *heights.at(q + d));
    }
  }
}

template <class Word>
void ValueFields<Word>::load_parents(const PageShape& shape, const Surroundings<Word>& around) {
  using Words = EightLanes<Word>;
  CubeNumbers<Word> low{}, high{};
  CubeNumbers<std::uint8_t> error_room{};
  for (std::int32_t k = 1; k < shape.count.k; k += 2) {
    for (std::int32_t j = 1; j < shape.count.j; j += 2) {
      const ParentRows rows(j, k);
      const std::size_t cubes = cube_place(1, (j + 1) / 2, (k + 1) / 2);
      rows.find(around.low.data(), Words::greatest).store(low.data() + cubes);
      rows.find(around.high.data(), Words::least).inverted().store(high.data() + cubes);
      error_room_of(rows.find(around.errors.data(), Codes::least)).store(error_room.data() + cubes);
      // Centres behind the last point are no cube's.
      for (std::size_t n = static_cast<std::size_t>(shape.count.i) / 2; n < 8; ++n)
        low[cubes + n] = high[cubes + n] = error_room[cubes + n] = 0;
    }
  }
  to_points(low, shape, [this](LatticePoint row, auto even, auto odd) {
    Words::store_by_turns(even, odd, bounds[0].at(row));
  });
  to_points(high, shape, [this](LatticePoint row, auto even, auto odd) {
    Words::store_by_turns(even, odd, bounds[1].at(row));
  });
  to_points(error_room, shape, [this](LatticePoint row, auto even, auto odd) {
    Codes::store_by_turns(most_of_room(even), most_of_room(odd), most_errors.at(row));
  });
}

template <class Word>
void ValueFields<Word>::load_values(const PageShape& shape, const Page<Word>& page) {
  LatticePoint q{};
  for (q.k = 0; q.k < shape.count.k; ++q.k) {
    for (q.j = 0; q.j < shape.count.j; ++q.j) {
      for (q.i = 0; q.i < shape.count.i; ++q.i) {
        if (!shape.owns(q)) continue;
        const std::size_t from = PageGrid::place(q, 0);
        *values[0].at(q) = page.low[from];
        *values[1].at(q) = static_cast<Word>(~page.high[from]);
        *errors.at(q) = page.errors[from];
      }
    }
  }
}

template <class Word>
void ValueFields<Word>::fill_errors(const PageShape& shape, std::uint8_t code) {
  LatticePoint q{};
  for (q.k = 0; q.k < shape.count.k; ++q.k) {
    for (q.j = 0; q.j < shape.count.j; ++q.j) {
      for (q.i = 0; q.i < shape.count.i; ++q.i) {
        if (shape.owns(q)) *errors.at(q) = code;
      }
    }
  }
}

template struct ValueFields<std::uint8_t>;
template struct ValueFields<std::uint16_t>;
template struct ValueFields<std::uint32_t>;

}  // namespace adamas
