#include "isosurface/compression/error_stage.h"

#include <algorithm>

#include "isosurface/compression/row_lanes.h"

namespace adamas {
namespace {

constexpr int kMostCode = 63;

/// How much more than predicted a code may be, from -63 to 63, in classes.
constexpr auto kClassOfRoom = [] {
  std::array<std::uint8_t, 2 * kMostCode + 1> classes{};
  for (int room = -kMostCode; room <= kMostCode; ++room) {
    int number = 0;
    for (const int least : {0, 1, 2, 4, 7, 13, 25}) number += room >= least ? 1 : 0;
    classes[static_cast<std::size_t>(room + kMostCode)] = static_cast<std::uint8_t>(number);
  }
  return classes;
}();

/// The greatest code that goes with ValueFields::error_room: the scales of two levels differ by a factor of
/// two.
constexpr auto kMostOfRoom = [] {
  std::array<std::uint8_t, kMostCode + 1> most{};
  for (int room = 0; room < kMostCode; ++room) {
    most[static_cast<std::size_t>(room)] =
        static_cast<std::uint8_t>(std::min(kMostCode - room + 4, kMostCode));
  }
  return most;
}();

/// Of the children on the page, of all points of a row.
void greatest_child(const PaddedGrid<std::uint8_t>& errors, LatticePoint row, const LatticePoint& odd,
                    std::uint8_t* greatest) {
  RowLanes<std::uint8_t, PageGrid::kSide> lanes(errors.at({-1, -1, -1}));
  for (int axis = 0; axis < 3; ++axis) {
    if (odd[axis] == 0) continue;
    LatticePoint step{};
    step[axis] = 1;
    lanes.take_greatest(errors.at(row - step));
    lanes.take_greatest(errors.at(row + step));
  }
  lanes.store(greatest);
}

}  // namespace

template <class Word>
void ErrorStages<Word>::make(const ValueFields<Word>& fields, const PageShape& shape, int phase,
                             ValueStage<std::uint8_t>& stage) {
  stage.clear();
  ErrorRow known{};
  std::array<std::uint8_t, PageGrid::kSide> children{};
  for (int n = 0; n < value_kind_count(phase); ++n) {
    const ValueKind kind = value_kind(phase, n);
    kind.rows(shape, [&](LatticePoint q) {
      const LatticePoint row{0, q.j, q.k};
      if (phase == 2) known_edge_errors(fields.heights, q, n, known);
      if (phase == 1) known_face_errors(fields.heights, q, n, known);
      if (phase == 0) known_centre_errors(fields.heights, q, known);
      if (phase < 2) greatest_child(fields.errors, row, kind.odd, children.data());
      add_row(kind, q, shape, phase, greatest_of_cubes(fields.error_room, q), known, children, stage);
    });
  }
}

template <class Word>
void ErrorStages<Word>::add_row(const ValueKind& kind, LatticePoint q, const PageShape& shape, int phase,
                                const std::array<std::uint8_t, 8>& rooms, const ErrorRow& known,
                                const std::array<std::uint8_t, PageGrid::kSide>& children,
                                ValueStage<std::uint8_t>& stage) {
  constexpr int kMissing = 2 * kRoomClassCount;
  const int count = (shape.count.i - q.i + 1) / 2;
  const auto context = [&](int n) {
    const int missing = kind.missing({q.i + 2 * n, q.j, q.k}, shape, phase) > 0 ? kMissing : 0;
    return (phase * 2 + (shape.level == 0 ? 0 : 1)) * 2 * kMissing + missing;
  };
  // But for the points at its ends all of a row miss as much.
  const int first = context(0), last = context(count - 1), inner = context(std::min(1, count - 1));
  const std::size_t begin = stage.size, place = PageGrid::place(q, 0);
  for (int n = 0; n < count; ++n) {
    const auto i = static_cast<std::size_t>(q.i + 2 * n), to = begin + static_cast<std::size_t>(n);
    const int predicted = std::max<int>(known[static_cast<std::size_t>(n)], children[i]);
    const int room = kMostOfRoom[rooms[static_cast<std::size_t>(n)]] - predicted;
    stage.places[to] = static_cast<std::uint16_t>(place + 2 * static_cast<std::size_t>(n));
    stage.predicted[to] = static_cast<std::uint8_t>(predicted);
    stage.contexts[to] = static_cast<std::uint16_t>(inner + (predicted == 0 ? kRoomClassCount : 0) +
                                                    kClassOfRoom[static_cast<std::size_t>(room + kMostCode)]);
  }
  stage.size += static_cast<std::size_t>(count);
  stage.contexts[begin] = static_cast<std::uint16_t>(stage.contexts[begin] + first - inner);
  if (count > 1) {
    stage.contexts[stage.size - 1] =
        static_cast<std::uint16_t>(stage.contexts[stage.size - 1] + last - inner);
  }
}

template class ErrorStages<std::uint8_t>;
template class ErrorStages<std::uint16_t>;
template class ErrorStages<std::uint32_t>;

}  // namespace adamas
