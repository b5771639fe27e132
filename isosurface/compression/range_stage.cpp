#include "isosurface/compression/range_stage.h"

#include <algorithm>
#include <vector>

namespace adamas {
namespace {

/// From a point: the samples in and on its diamond that may be known, and the children on the page's level.
struct Neighbours {
  int sample_count = 0, child_count = 0;
  std::array<std::ptrdiff_t, 11> samples{};
  std::array<std::ptrdiff_t, 6> children{};
};

constexpr Neighbours neighbours(const ValueKind& kind, int phase) {
  Neighbours result;
  const auto add = [&result](LatticePoint d) {
    result.samples[static_cast<std::size_t>(result.sample_count++)] = PaddedGrid<int>::offset(d);
  };
  // The axis by which edges and faces differ from each other.
  int own = 0;
  while (phase != 0 && kind.odd[own] != (phase == 2 ? 1 : 0)) ++own;
  for (int code = 0; code < 27; ++code) {
    const LatticePoint d{code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1};
    const int length = d.i * d.i + d.j * d.j + d.k * d.k;
    const bool in_plane = d[own] == 0, on_axis = length == 1 && !in_plane;
    if (phase == 0 ? length == 3 || length == 0 : in_plane || on_axis) add(d);
    const bool is_child = phase == 0 ? length == 1 : phase == 1 && length == 1 && in_plane;
    if (is_child) {
      result.children[static_cast<std::size_t>(result.child_count++)] = PaddedGrid<int>::offset(d);
    }
  }
  return result;
}

constexpr std::array<std::array<Neighbours, 3>, 3> all_neighbours() {
  std::array<std::array<Neighbours, 3>, 3> result{};
  for (int phase = 0; phase < 3; ++phase) {
    for (int n = 0; n < value_kind_count(phase); ++n) {
      result[static_cast<std::size_t>(phase)][static_cast<std::size_t>(n)] =
          neighbours(value_kind(phase, n), phase);
    }
  }
  return result;
}
constexpr auto kNeighbours = all_neighbours();

template <class Word>
void take_least(Word* row, const Word* from) {
  for (int i = 0; i < PageGrid::kSide; ++i) row[i] = std::min(row[i], from[i]);
}

/// Of all points of a row, those of other kinds too, whose numbers mean nothing.
template <class Word>
void known_least(const ValueFields<Word>& fields, std::size_t side, LatticePoint q, const Neighbours& near,
                 Word* row) {
  std::fill_n(row, PageGrid::kSide, ValueFields<Word>::kUnknown);
  const Word* samples = fields.samples[side].at({0, q.j, q.k});
  const Word* values = fields.values[side].at({0, q.j, q.k});
  for (int n = 0; n < near.sample_count; ++n)
    take_least(row, samples + near.samples[static_cast<std::size_t>(n)]);
  for (int n = 0; n < near.child_count; ++n)
    take_least(row, values + near.children[static_cast<std::size_t>(n)]);
}

/// The greatest bound of the cubes that have the point.
template <class Word>
Word bound_at(const CubeNumbers<Word>& least, LatticePoint q) {
  Word bound = 0;
  // A cube whose centre has the coordinate alone, or those before and after it.
  const auto first = [](std::int32_t x) { return (x + 1) / 2; };
  const auto last = [](std::int32_t x) { return x / 2 + 1; };
  for (std::int32_t k = first(q.k); k <= last(q.k); ++k) {
    for (std::int32_t j = first(q.j); j <= last(q.j); ++j) {
      for (std::int32_t i = first(q.i); i <= last(q.i); ++i)
        bound = std::max(bound, least[cube_place(i, j, k)]);
    }
  }
  return bound;
}

/// About four times the logarithm of a number to the base 2.
int quarter_octaves(std::uint32_t number) {
  const auto bits = static_cast<int>(std::bit_width(number));
  if (bits == 0) return 0;
  return 4 * (bits - 1) + static_cast<int>((std::uint64_t{number} << 2 >> (bits - 1)) & 3);
}

/// How far the samples inside may be from the interpolation, which the error tells, as seen from the bound.
int error_class(std::uint8_t error, std::uint32_t spread, std::uint32_t bound) {
  if (error == 0) return 0;
  const int ratio = error - 60 + quarter_octaves(spread) - quarter_octaves(bound);
  return std::clamp((ratio + 20) / 4, 1, 7);
}

template <class Word>
int bound_class(Word bound) {
  constexpr int kStep = sizeof(Word) == 1 ? 1 : sizeof(Word) == 2 ? 2 : 4;
  return (static_cast<int>(std::bit_width(bound)) + kStep - 1) / kStep;
}

}  // namespace

template <class Word>
void RangeStages<Word>::make(const ValueFields<Word>& fields, const PageShape& shape,
                             const typename Page<Word>::template Points<std::uint8_t>& errors, int phase,
                             std::array<ValueStage<Word>, 2>& stages) {
  for (auto& stage : stages) stage.size = 0;
  std::array<std::array<Word, PageGrid::kSide>, 2> known;
  for (int n = 0; n < value_kind_count(phase); ++n) {
    const ValueKind kind = value_kind(phase, n);
    const Neighbours& near = kNeighbours[static_cast<std::size_t>(phase)][static_cast<std::size_t>(n)];
    kind.rows(shape, [&](LatticePoint q) {
      for (std::size_t side = 0; side < 2; ++side) known_least(fields, side, q, near, known[side].data());
      for (; q.i < shape.count.i; q.i += 2) {
        const std::size_t place = PageGrid::place(q, 0);
        const auto x = static_cast<std::size_t>(q.i);
        const int missing = kind.missing(q, shape, phase);
        const bool sure = missing == 0 && (phase < 2 || shape.level == 0);
        const auto greatest = static_cast<Word>(~known[1][x]);
        const std::uint32_t spread =
            greatest > known[0][x] ? static_cast<std::uint32_t>(greatest - known[0][x]) : 0;
        for (std::size_t side = 0; side < 2; ++side) {
          ValueStage<Word>& stage = stages[side];
          const Word predicted = known[side][x];
          const Word least = std::min(bound_at(fields.least[side], q), predicted);
          std::uint16_t context = kSure;
          if (!sure) {
            const auto room = static_cast<Word>(predicted - least);
            const int group = phase < 2 ? 2 : shape.level == 0 ? 0 : 1;
            const int bounds = bound_class(room);
            const int error = bounds == 0 ? 0 : error_class(errors[place], spread, room);
            context =
                static_cast<std::uint16_t>(1 + (group * kBoundClasses + bounds) * kErrorClasses + error);
          }
          stage.places[stage.size] = static_cast<std::uint16_t>(place);
          stage.contexts[stage.size] = static_cast<std::uint16_t>(side * kSideContexts + context);
          stage.predicted[stage.size] = predicted;
          stage.bound[stage.size] = least;
          ++stage.size;
        }
      }
    });
  }
}

template class RangeStages<std::uint8_t>;
template class RangeStages<std::uint16_t>;
template class RangeStages<std::uint32_t>;

}  // namespace adamas
