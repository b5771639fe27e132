#include "isosurface/compression/known_errors.h"

#include <cstring>

#include "isosurface/compression/padded_grid.h"

namespace adamas {
namespace {

// Four points of a row at once.
constexpr int kLanes = 4;
using Numbers [[gnu::vector_size(16)]] = float;
using Integers [[gnu::vector_size(16)]] = std::int32_t;

/// Keeps quotients of zeros finite.
constexpr float kTiny = 1e-37f;

Numbers load(const float* from) {
  Numbers numbers;
  std::memcpy(&numbers, from, sizeof numbers);
  return numbers;
}
Numbers square(Numbers x) { return x * x; }
Numbers lesser(Numbers a, Numbers b) { return b < a ? b : a; }
Numbers greater(Numbers a, Numbers b) { return b > a ? b : a; }
Numbers mean_of(Numbers a, Numbers b) { return 0.5f * (a + b); }

/// Writes the codes of errors whose squares are these, in units of the points' distance, but no more than
/// `most`. A code is a quarter octave, half of one of the squares.
void put_codes(Numbers squares, float most, std::int32_t* codes) {
  constexpr float kScale = 1.0f / 12;  // the longest edge is a cube's diagonal, of side 2
  constexpr std::int32_t kRootTwo = 0x3504f3, kFraction = 0x7fffff, kBias = 127, kGreatest = 63;
  const Numbers ratio = kScale * lesser(squares, Numbers{} + most);
  Integers bits;
  std::memcpy(&bits, &ratio, sizeof bits);
  const Integers fraction = bits & kFraction;
  // What holds is -1.
  Integers code = 2 * ((bits >> 23) - kBias) - (fraction > 0) - (fraction > kRootTwo) + kGreatest;
  code = code > 1 ? code : Integers{} + 1;
  code &= ratio > 0;
  std::memcpy(codes, &code, sizeof code);
}

/// The steps along the axis, then along the two others.
std::array<std::ptrdiff_t, 3> steps_of(int axis) {
  constexpr std::ptrdiff_t kSide = PaddedGrid<float>::kSide;
  constexpr std::array<std::ptrdiff_t, 5> kAll{1, kSide, kSide * kSide, 1, kSide};
  const auto n = static_cast<std::size_t>(axis);
  return {kAll[n], kAll[n + 1], kAll[n + 2]};
}

/// How far samples are from the mean of two others, squared, and these from each other.
struct Side {
  Numbers deviation, length;

  Side(Numbers middle, Numbers a, Numbers b)
      : deviation(square(middle - mean_of(a, b))), length(square(a - b)) {}
};

/// Of one of the two halves of a face: the greatest deviation on its sides over the gradient.
Numbers half_error(Numbers deviation, Numbers across, const Side& a, const Side& b) {
  return greater(deviation, greater(a.deviation, b.deviation)) / (0.25f * (a.length + b.length) + across + kTiny);
}

}  // namespace

void known_edge_errors(const float* heights, int own, ErrorRow& row) {
  const auto [along, b, c] = steps_of(own);
  for (std::size_t i = 0; i < row.size(); i += kLanes) {
    const float* p = heights + i;
    const Numbers before = load(p - along), after = load(p + along), mean = mean_of(before, after);
    // The least gradient of the eight tetrahedra, each of which has a face's centre and a cube's.
    Numbers least = Numbers{} + 1e38f;
    for (const std::ptrdiff_t u : {-b, b}) {
      const Numbers first = load(p + u), first_height = square(first - mean);
      for (const std::ptrdiff_t v : {-c, c}) {
        const Numbers second = load(p + v), corner = load(p + u + v);
        least = lesser(least, first_height + square(corner - first));
        least = lesser(least, square(second - mean) + square(corner - second));
      }
    }
    const Numbers gradient = square(0.5f * (after - before)) + least + kTiny;
    put_codes(square(load(p) - mean) / gradient, 4, row.data() + i);
  }
}

void known_face_errors(const float* heights, LatticePoint q, int own, ErrorRow& row) {
  const auto [across, a, b] = steps_of(own);
  // The split edge runs along the diagonal whose ends have multiples of four or none of them; from one face to
  // the next along i it turns.
  const std::int32_t turned = own == 0 ? (q.j ^ q.k) & 2 : own == 1 ? q.k & 2 : q.j & 2;
  const Integers turns = Integers{0, 0, 0, own == 0 ? 0 : 2} ^ turned;
  for (std::size_t i = 0; i < row.size(); i += kLanes) {
    const float* p = heights + i;
    const Numbers v00 = load(p - a - b), v10 = load(p + a - b), v01 = load(p - a + b), v11 = load(p + a + b);
    const Side before_b(load(p - b), v00, v10), after_b(load(p + b), v01, v11);
    const Side before_a(load(p - a), v00, v01), after_a(load(p + a), v10, v11);
    Side first = after_a, second = before_a;
    const Integers turn = turns != 0;
    first.deviation = turn ? before_a.deviation : after_a.deviation;
    first.length = turn ? before_a.length : after_a.length;
    second.deviation = turn ? after_a.deviation : before_a.deviation;
    second.length = turn ? after_a.length : before_a.length;
    const Numbers mean = turn ? mean_of(v10, v01) : mean_of(v00, v11);
    const Numbers deviation = square(load(p) - mean);
    const Numbers height = lesser(square(load(p - across) - mean), square(load(p + across) - mean));
    const Numbers squares =
        greater(half_error(deviation, height, before_b, first), half_error(deviation, height, after_b, second));
    put_codes(squares, 8, row.data() + i);
  }
}

}  // namespace adamas
