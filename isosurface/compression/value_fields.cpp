#include "isosurface/compression/value_fields.h"

#include <algorithm>
#include <cmath>

#include "isosurface/compression/split_edge_prediction.h"

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

/// The last even coordinate round the page whose points are known.
std::int32_t last_even(std::int32_t count) { return count & ~1; }

}  // namespace

template <class Word>
void ValueFields<Word>::load(const PageShape& shape, const Surroundings<Word>& around,
                             const Page<Word>& page) {
  for (int side = 0; side < 2; ++side) {
    samples[static_cast<std::size_t>(side)].fill(kUnknown);
    values[static_cast<std::size_t>(side)].fill(kUnknown);
  }
  heights.fill(0);
  errors.fill(0);
  load_points(shape, around, page);
  mirror<0>(shape);
  mirror<1>(shape);
  mirror<2>(shape);
  load_parents(shape, around);
}

template <class Word>
void ValueFields<Word>::set_point(LatticePoint q, Word sample) {
  *heights.at(q) = height(sample);
  if (!is_finite(sample)) return;
  *samples[0].at(q) = sample;
  *samples[1].at(q) = static_cast<Word>(~sample);
}

template <class Word>
void ValueFields<Word>::load_points(const PageShape& shape, const Surroundings<Word>& around,
                                    const Page<Word>& page) {
  for (std::int32_t k = 0; k < shape.count.k; ++k) {
    for (std::int32_t j = 0; j < shape.count.j; ++j) {
      const Word* row = page.samples.data() + PageGrid::place({0, j, k}, 0);
      Word* low_side = samples[0].at({0, j, k});
      Word* high_side = samples[1].at({0, j, k});
      for (std::int32_t i = 0; i < shape.count.i; ++i) {
        const bool finite = is_finite(row[i]);
        low_side[i] = finite ? row[i] : kUnknown;
        high_side[i] = finite ? static_cast<Word>(~row[i]) : kUnknown;
      }
      float* even = heights.at({0, j, k});
      for (std::int32_t i = 0; i < shape.count.i; i += 2) even[i / 2] = height(row[i]);
      float* odd = heights.at({1, j, k});
      for (std::int32_t i = 1; i < shape.count.i; i += 2) odd[i / 2] = height(row[i]);
    }
  }
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
  for (auto& side : least) side.fill(0);
  error_room.fill(0);
  for (std::int32_t k = 1; k < shape.count.k; k += 2) {
    for (std::int32_t j = 1; j < shape.count.j; j += 2) {
      for (std::int32_t i = 1; i < shape.count.i; i += 2) {
        const std::size_t cube = cube_place((i + 1) / 2, (j + 1) / 2, (k + 1) / 2);
        // The parents are those corners that lie in the middle of edges of the next coarser cubes: of which
        // one coordinate is no multiple of four.
        const LatticePoint whole{i + 1 - ((i + 1) & 2), j + 1 - ((j + 1) & 2), k + 1 - ((k + 1) & 2)};
        const LatticePoint half{2 * i - whole.i, 2 * j - whole.j, 2 * k - whole.k};
        for (int axis = 0; axis < 3; ++axis) {
          LatticePoint parent = whole;
          parent[axis] = half[axis];
          const std::size_t place = surrounding_place(parent);
          least[0][cube] = std::max(least[0][cube], around.low[place]);
          least[1][cube] = std::max(least[1][cube], static_cast<Word>(~around.high[place]));
          const int code = std::min<int>(around.errors[place], 63);
          error_room[cube] = std::max(error_room[cube], static_cast<std::uint8_t>(63 - code));
        }
      }
    }
  }
}

template struct ValueFields<std::uint8_t>;
template struct ValueFields<std::uint16_t>;
template struct ValueFields<std::uint32_t>;

}  // namespace adamas
