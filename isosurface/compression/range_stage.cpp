#include "isosurface/compression/range_stage.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "isosurface/compression/row_lanes.h"
#include "isosurface/compression/wide_lanes.h"

namespace adamas {
namespace {

/// From a point: the samples in and on its diamond that may be known, and the children on the page's level.
struct Neighbours {
  int sample_count = 0, child_count = 0;
  std::array<std::ptrdiff_t, 11> samples{};
  std::array<std::ptrdiff_t, 6> children{};
};

/// Of edges along the axis `own`, of faces across it, or of centres.
constexpr Neighbours neighbours(int phase, int own) {
  Neighbours result;
  const auto add = [&result](LatticePoint d) {
    result.samples[static_cast<std::size_t>(result.sample_count++)] = PaddedGrid<int>::offset(d);
  };
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

template <int Phase, int Own>
constexpr Neighbours kNeighbours = neighbours(Phase, Own);

/// Of the points of a row, those of other kinds too, whose numbers mean nothing. Unrolled: nearly all time
/// goes here.
template <int Phase, int Own, class Word>
void known_least(const Word* samples, const Word* values, Word* row) {
  constexpr Neighbours kNear = kNeighbours<Phase, Own>;
  RowLanes<Word, PageGrid::kSide> least(samples);
  [&]<std::size_t... N>(std::index_sequence<N...>) { (least.take_least(samples + kNear.samples[N]), ...); }
  (std::make_index_sequence<kNear.sample_count>());
  [&]<std::size_t... N>(std::index_sequence<N...>) { (least.take_least(values + kNear.children[N]), ...); }
  (std::make_index_sequence<kNear.child_count>());
  least.store(row);
}

template <class Word>
constexpr int kMostBits = 8 * sizeof(Word);

/// How far the samples inside may be from the interpolation, as the error tells, seen from the bound: by
/// error and by how many bits more the samples' spread has than the room to the bound has.
template <class Word>
constexpr auto kClassesOfErrors = [] {
  constexpr int kMost = kMostBits<Word>;
  std::array<std::array<std::uint8_t, 2 * kMost + 1>, 64> classes{};
  for (int error = 1; error < 64; ++error) {
    for (int bits = -kMost; bits <= kMost; ++bits)
      classes[static_cast<std::size_t>(error)][static_cast<std::size_t>(bits + kMost)] =
          static_cast<std::uint8_t>(std::clamp((error >> 2) - 10 + bits, 1, 7));
  }
  return classes;
}();

/// The contexts of points, kSure where nothing is open.
template <class Word>
class ContextsOf {
 public:
  /// `base`: the first context.
  ContextsOf(const ValueFields<Word>& fields, int base) : fields_(fields), base_(base) {}

  /// Of both sides.
  [[nodiscard]] std::array<int, 2> find(std::size_t place) const {
    const Word low = fields_.known[0][place], high = static_cast<Word>(~fields_.known[1][place]);
    const std::uint32_t spread = high > low ? static_cast<std::uint32_t>(high - low) : 0u;
    const int spread_bits = static_cast<int>(std::bit_width(spread)) + kMostBits<Word>;
    const auto& classes = kClassesOfErrors<Word>[fields_.errors[place]];
    std::array<int, 2> contexts;
    for (std::size_t side = 0; side < 2; ++side) {
      const Word known = fields_.known[side][place];
      const auto room = static_cast<std::uint32_t>(known - std::min(known, fields_.bounds[side][place]));
      const int bits = static_cast<int>(std::bit_width(room));
      constexpr int kStep = sizeof(Word);
      const int context = base_ + (bits - 1) / kStep * RangeStages<Word>::kErrorClasses +
                          classes[static_cast<std::size_t>(spread_bits - bits)];
      contexts[side] = room == 0 ? int{RangeStages<Word>::kSure} : context;
    }
    return contexts;
  }

 private:
  const ValueFields<Word>& fields_;
  int base_;
};

/// Makes fields.known of the rows of a phase.
template <int Phase, class Word>
void find_known(ValueFields<Word>& fields, const PageShape& shape, bool take) {
  for_each_row(shape, Phase, [&](LatticePoint first) {
    const LatticePoint row{0, first.j, first.k};
    // The axis by which edges and faces differ from each other.
    constexpr std::int32_t kOwn = Phase == 2 ? 1 : 0;
    const bool own_j = Phase != 0 && (first.j & 1) == kOwn, own_k = Phase != 0 && (first.k & 1) == kOwn;
    for (std::size_t side = 0; side < 2; ++side) {
      const Word *samples = fields.samples[side].at(row), *values = fields.values[side].at(row);
      Word* known = fields.known[side].at(row);
      if (own_j) {
        known_least<Phase, 1>(samples, values, known);
      } else if (own_k) {
        known_least<Phase, 2>(samples, values, known);
      } else {
        known_least<Phase, 0>(samples, values, known);
      }
      if (take) copy_points(shape, first, fields.known[side], fields.values[side]);
    }
  });
}

}  // namespace

template <class Word>
void RangeStages<Word>::make(ValueFields<Word>& fields, const PageShape& shape, int phase, bool trust,
                             bool take, std::array<ValueStage, 2>& stages) {
  with_wide_lanes([&](auto) {
    if (phase == 0) find_known<0>(fields, shape, take);
    if (phase == 1) find_known<1>(fields, shape, take);
    if (phase == 2) find_known<2>(fields, shape, take);
    const int group = phase < 2 ? 2 : shape.level == 0 ? 0 : 1;
    const ContextsOf<Word> contexts(fields, 1 + group * kBoundClasses * kErrorClasses);
    const bool are_known = phase < 2 || shape.level == 0;
    with_points(shape, phase, PhasePoints::Of::kRanges, [&](const PhasePoints& points) {
      const bool some = trust && are_known;
      const auto list = some ? points.open() : points.all();
      std::array<std::size_t, 2> sizes{};
      for (std::size_t n = 0; n < list.size(); ++n) {
        const bool is_sure = !some && are_known && points.sure()[n];
        const auto of_sides = contexts.find(list[n]);
        for (std::size_t side = 0; side < 2; ++side) {
          const int context = is_sure ? int{kSure} : of_sides[side];
          stages[side].places[sizes[side]] = list[n];
          stages[side].contexts[sizes[side]] = static_cast<std::uint16_t>(context);
          sizes[side] += context == kSure && trust ? 0 : 1;
        }
      }
      for (std::size_t side = 0; side < 2; ++side) stages[side].size = sizes[side];
    });
  });
}

template class RangeStages<std::uint8_t>;
template class RangeStages<std::uint16_t>;
template class RangeStages<std::uint32_t>;

}  // namespace adamas
