#include "isosurface/compression/error_stage.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "isosurface/preprocessing/error_scale.h"

namespace adamas {
namespace {

constexpr int kSide = PageGrid::kSide;
using Row = std::array<float, kSide>;
using Steps = std::array<std::ptrdiff_t, 3>;

float square(float x) { return x * x; }

/// The code of an error whose square is this many times that of the scale's greatest.
std::uint8_t code_of(float ratio) {
  if (!(ratio > 0)) return 0;
  const auto bits = std::bit_cast<std::uint32_t>(std::min(ratio, 1.0f));
  // Two codes for each power of two of the square.
  constexpr std::uint32_t kRootTwo = 0x3504f3;
  const std::uint32_t fraction = bits & 0x7fffff;
  const int code =
      2 * (static_cast<int>(bits >> 23) - 127) + (fraction > 0 ? 1 : 0) + (fraction > kRootTwo ? 1 : 0);
  return static_cast<std::uint8_t>(std::max(code + ErrorScale::kCodes - 1, 1));
}

/// The steps along the axis of an edge, or across a face, then along the two others.
Steps steps_of(int own) {
  const Steps all{1, PaddedGrid<float>::kSide, PaddedGrid<float>::kSide * PaddedGrid<float>::kSide};
  const auto n = static_cast<std::size_t>(own);
  return {all[n], all[(n + 1) % 3], all[(n + 2) % 3]};
}

/// Squares of errors of edges: by how far the sample is from the mean of the ends, over the least gradient of
/// the eight tetrahedra.
void edge_errors(const float* p, const Steps& d, Row& row) {
  for (int i = 0; i < kSide; ++i, ++p) {
    const float before = p[-d[0]], after = p[d[0]], mean = 0.5f * (before + after);
    float least = INFINITY;
    for (const std::ptrdiff_t b : {-d[1], d[1]}) {
      for (const std::ptrdiff_t c : {-d[2], d[2]}) {
        const float corner = p[b + c];
        least = std::min(least, square(p[b] - mean) + square(corner - p[b]));
        least = std::min(least, square(p[c] - mean) + square(corner - p[c]));
      }
    }
    const float gradient = square(0.5f * (after - before)) + least;
    const float error = square(*p - mean);
    row[static_cast<std::size_t>(i)] = error > 0 ? error / gradient : 0;
  }
}

/// The least code of the parents of the cubes that have the point, on its own scale.
int room_at(const CubeNumbers<std::uint8_t>& most, LatticePoint q) {
  std::uint8_t room = 63;
  const auto first = [](std::int32_t x) { return (x + 1) / 2; };
  const auto last = [](std::int32_t x) { return x / 2 + 1; };
  for (std::int32_t k = first(q.k); k <= last(q.k); ++k) {
    for (std::int32_t j = first(q.j); j <= last(q.j); ++j) {
      for (std::int32_t i = first(q.i); i <= last(q.i); ++i) room = std::min(room, most[cube_place(i, j, k)]);
    }
  }
  // The scales of two levels differ by a factor of two.
  return room == 0 ? 0 : std::min(room + 4, 63);
}

int room_class(int room) {
  if (room <= 0) return room < 0 ? 0 : 1;
  return room < 2 ? 2 : room < 4 ? 3 : room < 7 ? 4 : room < 13 ? 5 : room < 25 ? 6 : 7;
}

/// Of the children on the page.
std::uint8_t greatest_child(const std::uint8_t* errors, const LatticePoint& odd, int phase) {
  const Steps d = steps_of(0);
  std::uint8_t greatest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (phase == 1 && odd[axis] == 0) continue;
    const std::ptrdiff_t step = d[static_cast<std::size_t>(axis)];
    greatest = std::max({greatest, errors[step], errors[-step]});
  }
  return greatest;
}

}  // namespace

template <class Word>
void ErrorStages<Word>::make(const ValueFields<Word>& fields, const PageShape& shape, int phase,
                             ValueStage<std::uint8_t>& stage) {
  stage.size = 0;
  Row row{};
  for (int n = 0; n < value_kind_count(phase); ++n) {
    const ValueKind kind = value_kind(phase, n);
    kind.rows(shape, [&](LatticePoint q) {
      if (phase == 2) edge_errors(fields.heights.at({0, q.j, q.k}), steps_of(n), row);
      for (; q.i < shape.count.i; q.i += 2) {
        constexpr float kGreatest = 1.0f / 12;
        int predicted =
            phase == 2 ? code_of(std::min(row[static_cast<std::size_t>(q.i)], 4.0f) * kGreatest) : 0;
        if (phase < 2) predicted = greatest_child(fields.errors.at(q), kind.odd, phase);
        const int room = room_at(fields.most_errors, q) - predicted;
        const int missing = kind.missing(q, shape, phase) > 0 ? 1 : 0;
        const int group =
            (phase * 2 + (shape.level == 0 ? 0 : 1)) * 4 + missing * 2 + (predicted == 0 ? 1 : 0);
        stage.places[stage.size] = static_cast<std::uint16_t>(PageGrid::place(q, 0));
        stage.contexts[stage.size] = static_cast<std::uint16_t>(group * kRoomClasses + room_class(room));
        stage.predicted[stage.size] = static_cast<std::uint8_t>(predicted);
        ++stage.size;
      }
    });
  }
}

template class ErrorStages<std::uint8_t>;
template class ErrorStages<std::uint16_t>;
template class ErrorStages<std::uint32_t>;

}  // namespace adamas
