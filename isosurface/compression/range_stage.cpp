#include "isosurface/compression/range_stage.h"

#include <algorithm>
#include <utility>

#include "isosurface/compression/row_lanes.h"

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

template <int Phase, int Number>
constexpr Neighbours kNeighbours = neighbours(value_kind(Phase, Number), Phase);

/// Of the points of a row, those of other kinds too, whose numbers mean nothing. Unrolled: nearly all time
/// goes here.
template <int Phase, int Number, class Word>
void known_least(const Word* samples, const Word* values, Word* row) {
  constexpr Neighbours kNear = kNeighbours<Phase, Number>;
  RowLanes<Word, PageGrid::kSide> least(samples);
  [&]<std::size_t... N>(std::index_sequence<N...>) { (least.take_least(samples + kNear.samples[N]), ...); }
  (std::make_index_sequence<kNear.sample_count>());
  [&]<std::size_t... N>(std::index_sequence<N...>) { (least.take_least(values + kNear.children[N]), ...); }
  (std::make_index_sequence<kNear.child_count>());
  least.store(row);
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

/// Makes both stages of a kind, row by row.
template <class Word, int Phase, int Number>
class RangeRows {
 public:
  using Errors = typename Page<Word>::template Points<std::uint8_t>;
  using Stages = RangeStages<Word>;

  RangeRows(const ValueFields<Word>& fields, const PageShape& shape, const Errors& errors, bool trust,
            std::array<ValueStage<Word>, 2>& stages)
      : fields_(fields), shape_(shape), errors_(errors), trust_(trust), stages_(stages) {}

  void make() {
    kKind.rows(shape_, [this](LatticePoint q) { make(q); });
  }

 private:
  static constexpr ValueKind kKind = value_kind(Phase, Number);

  void make(LatticePoint q) {
    const std::size_t row = PageGrid::place({0, q.j, q.k}, 0);
    for (std::size_t side = 0; side < 2; ++side) {
      known_least<Phase, Number>(fields_.samples[side].at({0, q.j, q.k}),
                                 fields_.values[side].at({0, q.j, q.k}), stages_[side].sure.data() + row);
    }
    const std::int32_t count = (shape_.count.i - q.i + 1) / 2;
    std::int32_t begin = 0, end = 0;
    if (Phase < 2 || shape_.level == 0) {
      const auto sure = [&](std::int32_t n) {
        return kKind.missing({q.i + 2 * n, q.j, q.k}, shape_, Phase) == 0;
      };
      begin = sure(0) ? 0 : 1;
      end = sure(count - 1) ? count : count - 1;
      // A neighbour along another axis is missing to all of them.
      if (begin >= end || !sure(begin)) begin = end = 0;
    }
    if (begin < end) add_sure(q, begin, end);
    if (begin > 0 || end < count) add_open(q, count, begin, end);
  }

  void add_sure(LatticePoint q, std::int32_t begin, std::int32_t end) {
    const auto place =
        static_cast<std::uint16_t>(PageGrid::place(q, 0) + 2 * static_cast<std::size_t>(begin));
    for (std::size_t side = 0; side < 2; ++side) {
      ValueStage<Word>& stage = stages_[side];
      if (trust_) {
        stage.segments[stage.segment_count++] = {place, static_cast<std::uint16_t>(end - begin),
                                                 shape_.count.i == PageGrid::kSide};
        continue;
      }
      for (std::int32_t n = 0; n < end - begin; ++n) {
        const auto at = static_cast<std::uint16_t>(place + 2 * n);
        put(side, at, Stages::kSure, stage.sure[at], stage.sure[at]);
      }
    }
  }

  /// All but those from begin to end.
  void add_open(LatticePoint q, std::int32_t count, std::int32_t begin, std::int32_t end) {
    const std::array<std::array<Word, 8>, 2> bounds{greatest_of_cubes(fields_.least[0], q),
                                                    greatest_of_cubes(fields_.least[1], q)};
    for (std::int32_t n = 0; n < count; ++n) {
      if (n >= begin && n < end) continue;
      const auto place = static_cast<std::uint16_t>(PageGrid::place(q, 0) + 2 * static_cast<std::size_t>(n));
      const Word low = stages_[0].sure[place], high = static_cast<Word>(~stages_[1].sure[place]);
      const std::uint32_t spread = high > low ? static_cast<std::uint32_t>(high - low) : 0;
      for (std::size_t side = 0; side < 2; ++side) {
        const Word known = stages_[side].sure[place];
        const Word bound = std::min(bounds[side][static_cast<std::size_t>(n)], known);
        put(side, place, context(errors_[place], spread, static_cast<Word>(known - bound)), known, bound);
      }
    }
  }

  [[nodiscard]] int context(std::uint8_t error, std::uint32_t spread, Word room) const {
    const int group = Phase < 2 ? 2 : shape_.level == 0 ? 0 : 1;
    const int bounds = bound_class(room);
    const int errors = bounds == 0 ? 0 : error_class(error, spread, room);
    return 1 + (group * Stages::kBoundClasses + bounds) * Stages::kErrorClasses + errors;
  }

  void put(std::size_t side, std::uint16_t place, int context, Word known, Word bound) {
    ValueStage<Word>& stage = stages_[side];
    stage.places[stage.size] = place;
    stage.contexts[stage.size] =
        static_cast<std::uint16_t>(side * Stages::kSideContexts + static_cast<std::size_t>(context));
    stage.predicted[stage.size] = known;
    stage.bound[stage.size++] = bound;
  }

  const ValueFields<Word>& fields_;
  const PageShape& shape_;
  const Errors& errors_;
  bool trust_;
  std::array<ValueStage<Word>, 2>& stages_;
};

}  // namespace

template <class Word>
void RangeStages<Word>::make(const ValueFields<Word>& fields, const PageShape& shape,
                             const typename Page<Word>::template Points<std::uint8_t>& errors, int phase,
                             bool trust, std::array<ValueStage<Word>, 2>& stages) {
  for (auto& stage : stages) stage.clear();
  if (phase == 0) {
    RangeRows<Word, 0, 0>(fields, shape, errors, trust, stages).make();
  } else if (phase == 1) {
    RangeRows<Word, 1, 0>(fields, shape, errors, trust, stages).make();
    RangeRows<Word, 1, 1>(fields, shape, errors, trust, stages).make();
    RangeRows<Word, 1, 2>(fields, shape, errors, trust, stages).make();
  } else {
    RangeRows<Word, 2, 0>(fields, shape, errors, trust, stages).make();
    RangeRows<Word, 2, 1>(fields, shape, errors, trust, stages).make();
    RangeRows<Word, 2, 2>(fields, shape, errors, trust, stages).make();
  }
}

template class RangeStages<std::uint8_t>;
template class RangeStages<std::uint16_t>;
template class RangeStages<std::uint32_t>;

}  // namespace adamas
