#include "isosurface/compression/known_errors.h"

#include <cstring>

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

/// How far samples are from the mean of two others, squared, and these from each other.
struct Side {
  Numbers deviation, length;

  Side(Numbers middle, Numbers a, Numbers b)
      : deviation(square(middle - mean_of(a, b))), length(square(a - b)) {}
};

Side select(Integers choice, Side a, const Side& b) {
  a.deviation = choice ? a.deviation : b.deviation;
  a.length = choice ? a.length : b.length;
  return a;
}

/// Of one of the two halves of a face: the greatest deviation on its sides over the gradient.
Numbers half_error(Numbers deviation, Numbers across, const Side& a, const Side& b) {
  return greater(deviation, greater(a.deviation, b.deviation)) /
         (0.25f * (a.length + b.length) + across + kTiny);
}

/// The samples of cubes round centres. Along each axis from 0 to 2, in the direction of the split edge.
class CubeHeights {
 public:
  CubeHeights(const HeightGrid& heights, LatticePoint q, std::size_t n) {
    const float* p = heights.at(q) + n;
    const HeightGrid::Steps i = HeightGrid::steps(q, 0);
    const auto towards = [q](int axis) {
      const HeightGrid::Steps steps = HeightGrid::steps(q, axis);
      const bool forth = (q[axis] & 3) == 1;
      return std::array<std::ptrdiff_t, 3>{forth ? steps.before : steps.after, 0,
                                           forth ? steps.after : steps.before};
    };
    const auto j = towards(1), k = towards(2);
    const Integers turn{0, -1, 0, -1};
    for (std::size_t z = 0; z < 3; ++z) {
      for (std::size_t y = 0; y < 3; ++y) {
        const float* at = p + j[y] + k[z];
        const Numbers before = load(at + i.before), after = load(at + i.after);
        heights_[0][y][z] = turn ? after : before;
        heights_[1][y][z] = load(at);
        heights_[2][y][z] = turn ? before : after;
      }
    }
  }

  /// Between two points, and the one in the middle.
  [[nodiscard]] Side side(const std::array<int, 3>& a, const std::array<int, 3>& b) const {
    const auto height = [this](int x, int y, int z) { return heights_[x][y][z]; };
    return Side(height((a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2), height(a[0], a[1], a[2]),
                height(b[0], b[1], b[2]));
  }

 private:
  Numbers heights_[3][3][3];
};

}  // namespace

void known_edge_errors(const HeightGrid& heights, LatticePoint q, int own, ErrorRow& row) {
  const HeightGrid::Steps along = HeightGrid::steps(q, own), b = HeightGrid::steps(q, (own + 1) % 3),
                          c = HeightGrid::steps(q, (own + 2) % 3);
  for (std::size_t n = 0; n < row.size(); n += kLanes) {
    const float* p = heights.at(q) + n;
    const Numbers before = load(p + along.before), after = load(p + along.after),
                  mean = mean_of(before, after);
    // The least gradient of the eight tetrahedra, each of which has a face's centre and a cube's.
    Numbers least = Numbers{} + 1e38f;
    for (const std::ptrdiff_t u : {b.before, b.after}) {
      const Numbers first = load(p + u), first_height = square(first - mean);
      for (const std::ptrdiff_t v : {c.before, c.after}) {
        const Numbers second = load(p + v), corner = load(p + u + v);
        least = lesser(least, first_height + square(corner - first));
        least = lesser(least, square(second - mean) + square(corner - second));
      }
    }
    const Numbers gradient = square(0.5f * (after - before)) + least + kTiny;
    put_codes(square(load(p) - mean) / gradient, 4, row.data() + n);
  }
}

void known_face_errors(const HeightGrid& heights, LatticePoint q, int own, ErrorRow& row) {
  const HeightGrid::Steps across = HeightGrid::steps(q, own), a = HeightGrid::steps(q, (own + 1) % 3),
                          b = HeightGrid::steps(q, (own + 2) % 3);
  // The split edge runs along the diagonal whose ends have multiples of four or none of them; from one face
  // to the next along i it turns.
  const std::int32_t turned = own == 0 ? (q.j ^ q.k) & 2 : own == 1 ? q.k & 2 : q.j & 2;
  const std::int32_t next = own == 0 ? turned : turned ^ 2;
  const Integers turn = Integers{turned, next, turned, next} != 0;
  for (std::size_t n = 0; n < row.size(); n += kLanes) {
    const float* p = heights.at(q) + n;
    const Numbers v00 = load(p + a.before + b.before), v10 = load(p + a.after + b.before);
    const Numbers v01 = load(p + a.before + b.after), v11 = load(p + a.after + b.after);
    const Side before_b(load(p + b.before), v00, v10), after_b(load(p + b.after), v01, v11);
    const Side before_a(load(p + a.before), v00, v01), after_a(load(p + a.after), v10, v11);
    const Side first = select(turn, before_a, after_a), second = select(turn, after_a, before_a);
    const Numbers mean = turn ? mean_of(v10, v01) : mean_of(v00, v11);
    const Numbers deviation = square(load(p) - mean);
    const Numbers height =
        lesser(square(load(p + across.before) - mean), square(load(p + across.after) - mean));
    const Numbers squares = greater(half_error(deviation, height, before_b, first),
                                    half_error(deviation, height, after_b, second));
    put_codes(squares, 8, row.data() + n);
  }
}

void known_centre_errors(const HeightGrid& heights, LatticePoint q, ErrorRow& row) {
  for (std::size_t n = 0; n < row.size(); n += kLanes) {
    const CubeHeights cube(heights, q, n);
    const std::array<int, 3> low{0, 0, 0}, high{2, 2, 2};
    const Numbers middle = cube.side(low, high).deviation;
    Numbers squares{};
    for (std::size_t a = 0; a < 3; ++a) {
      std::array<int, 3> first = low;
      first[a] = 2;
      const Side begin = cube.side(low, first), far_face = cube.side(first, high);
      for (const std::size_t b : {(a + 1) % 3, (a + 2) % 3}) {
        std::array<int, 3> second = first;
        second[b] = 2;
        const Side next = cube.side(first, second), end = cube.side(second, high);
        const Numbers faces = greater(far_face.deviation, cube.side(low, second).deviation);
        const Numbers edges = greater(begin.deviation, greater(next.deviation, end.deviation));
        const Numbers gradient = 0.25f * (begin.length + next.length + end.length) + kTiny;
        squares = greater(squares, greater(middle, greater(faces, edges)) / gradient);
      }
    }
    put_codes(squares, 12, row.data() + n);
  }
}

}  // namespace adamas
