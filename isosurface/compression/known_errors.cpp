#include "isosurface/compression/known_errors.h"

#include <bit>
#include <cstring>

#include "isosurface/compression/wide_lanes.h"
#include "isosurface/preprocessing/octant_stencils.h"
#include "isosurface/volume/error_scale.h"

namespace adamas {
namespace {

/// Own errors in rows of points: each function works them out as preprocessing does, with the same operations
/// on the same numbers. Of several quotients with the same dividend that with the least divisor is the
/// greatest, also when all are rounded.
template <std::size_t Bytes>
class RowErrors {
 public:
  using Lanes = FloatLanes<Bytes>;
  using Numbers = typename Lanes::Numbers;
  using Integers = typename Lanes::Integers;

  RowErrors(const HeightGrid& heights, const ErrorGeometry& geometry)
      : heights_(heights), geometry_(geometry) {}

  /// Of all points of a row, by the parity of their first coordinate.
  void fill(LatticePoint row, std::uint8_t* even_codes, std::uint8_t* odd_codes) const {
    for (std::size_t n = 0; n < PageGrid::kSide / 2; n += Lanes::kCount) {
      const LatticePoint first{1, row.j, row.k};
      if ((row.j & row.k & 1) != 0) {
        store(face<0>(row, n), even_codes + n);
        store(centre(first, n), odd_codes + n);
      } else if ((row.j & 1) != 0) {
        store(edge<1>(row, n), even_codes + n);
        store(face<2>(first, n), odd_codes + n);
      } else if ((row.k & 1) != 0) {
        store(edge<2>(row, n), even_codes + n);
        store(face<1>(first, n), odd_codes + n);
      } else {
        store(edge<0>(first, n), odd_codes + n);
      }
    }
  }

 private:
  static constexpr std::size_t kCount = Lanes::kCount;

  [[gnu::always_inline]] static inline void store(Integers codes, std::uint8_t* to) {
    using Narrow [[gnu::vector_size(kCount)]] = std::uint8_t;
    const Narrow narrow = __builtin_convertvector(codes, Narrow);
    std::memcpy(to, &narrow, sizeof narrow);
  }

  /// error_code of each number.
  [[gnu::always_inline]] static inline Integers code(Numbers squared) {
    constexpr std::int32_t kRootOfTwo = 0x3504f3, kFraction = 0x7fffff, kGreatest = 63;
    const Numbers raised = (squared > 1 ? Numbers{} + 1 : squared) * (1 + 0x1p-20f);
    Integers bits;
    std::memcpy(&bits, &raised, sizeof bits);
    // What holds is -1.
    Integers code = 64 + 2 * ((bits >> 23) - 127) - ((bits & kFraction) > kRootOfTwo);
    code = code < 1 ? Integers{} + 1 : code;
    code = code > kGreatest ? Integers{} + kGreatest : code;
    return code & (squared > 0);
  }

  /// The square of an error's ratio to the scale's greatest, from that of the difference.
  [[gnu::always_inline]] static inline Numbers ratio(Numbers difference, Numbers slope, float diameter) {
    const Numbers all = difference / slope, most = Numbers{} + diameter;
    const Numbers bounded = all < most ? all : most;
    return difference > 0 ? bounded : Numbers{};
  }

  [[gnu::always_inline]] inline Numbers square_of_half(Numbers difference, int axis) const {
    return Lanes::square(difference * 0.5f) * factor(axis);
  }
  [[nodiscard]] float factor(int axis) const {
    return geometry_.slope_factors[static_cast<std::size_t>(axis)];
  }
  /// The square of how far a sample is from the mean of two others.
  [[gnu::always_inline]] static inline Numbers deviation(Numbers middle, Numbers a, Numbers b) {
    return Lanes::square(middle - Lanes::mean_of(a, b));
  }

  template <int Axis>
  [[gnu::always_inline]] inline Integers edge(LatticePoint q, std::size_t n) const {
    constexpr int kB = (Axis + 1) % 3, kC = (Axis + 2) % 3;
    const HeightGrid::Steps along = HeightGrid::steps(q, Axis);
    const HeightGrid::Steps across[2] = {HeightGrid::steps(q, kB), HeightGrid::steps(q, kC)};
    const float* p = heights_.at(q) + n;
    const Numbers before = Lanes::load(p + along.before), after = Lanes::load(p + along.after);
    const Numbers mean = Lanes::mean_of(before, after), own = square_of_half(after - before, Axis);
    // Of the eight tetrahedra, each of which has a face's centre and a cube's.
    Numbers least{};
    for (int turn = 0; turn < 2; ++turn) {
      const HeightGrid::Steps b = across[turn], c = across[1 - turn];
      const float to_face = factor(turn == 0 ? kB : kC), to_cube = factor(turn == 0 ? kC : kB);
      for (int side = 0; side < 2; ++side) {
        const float* at = p + (side == 0 ? b.before : b.after);
        const Numbers face = Lanes::load(at);
        const Numbers cube = Lanes::lesser(Lanes::square(Lanes::load(at + c.before) - face),
                                           Lanes::square(Lanes::load(at + c.after) - face));
        const Numbers slope = own + Lanes::square(face - mean) * to_face + cube * to_cube;
        least = turn == 0 && side == 0 ? slope : Lanes::lesser(least, slope);
      }
    }
    return code(ratio(deviation(Lanes::load(p), before, after), least,
                      geometry_.edge_diameters[static_cast<std::size_t>(Axis)]));
  }

  template <int Axis>
  [[gnu::always_inline]] inline Integers face(LatticePoint q, std::size_t n) const {
    constexpr int kA = (Axis + 1) % 3, kB = (Axis + 2) % 3;
    const HeightGrid::Steps across = HeightGrid::steps(q, Axis), a = HeightGrid::steps(q, kA),
                            b = HeightGrid::steps(q, kB);
    // The split edge runs along the diagonal whose ends have multiples of four or none of them; from one face
    // to the next along i it turns.
    const bool turned = ((Axis == 0 ? q.j ^ q.k : Axis == 1 ? q.k : q.j) & 2) != 0;
    const Integers turn = lanes_turned(turned, Axis != 0);
    const float* p = heights_.at(q) + n;
    const Numbers v00 = Lanes::load(p + a.before + b.before), v10 = Lanes::load(p + a.after + b.before);
    const Numbers v01 = Lanes::load(p + a.before + b.after), v11 = Lanes::load(p + a.after + b.after);
    const Numbers mean = turn ? Lanes::mean_of(v10, v01) : Lanes::mean_of(v00, v11);
    const Numbers middle = Lanes::square(Lanes::load(p) - mean);
    const Numbers height = Lanes::lesser(Lanes::square(Lanes::load(p + across.before) - mean),
                                         Lanes::square(Lanes::load(p + across.after) - mean)) *
                           factor(Axis);
    const Numbers along_a[2] = {square_of_half(v10 - v00, kA), square_of_half(v11 - v01, kA)};
    const Numbers along_b[2] = {square_of_half(v01 - v00, kB), square_of_half(v11 - v10, kB)};
    const Numbers from_a[2] = {deviation(Lanes::load(p + b.before), v00, v10),
                               deviation(Lanes::load(p + b.after), v01, v11)};
    const Numbers from_b[2] = {deviation(Lanes::load(p + a.before), v00, v01),
                               deviation(Lanes::load(p + a.after), v10, v11)};
    Numbers greatest{};
    for (int half = 0; half < 2; ++half) {
      // The sides along a and b that meet in a corner beside the diagonal.
      const Numbers side = turn ? along_b[half] : along_b[1 - half];
      const Numbers side_from = turn ? from_b[half] : from_b[1 - half];
      const Numbers difference = Lanes::greater(middle, Lanes::greater(from_a[half], side_from));
      greatest = Lanes::greater(greatest, ratio(difference, along_a[half] + side + height,
                                                geometry_.face_diameters[static_cast<std::size_t>(Axis)]));
    }
    return code(greatest);
  }

  [[gnu::always_inline]] inline Integers centre(LatticePoint q, std::size_t n) const {
    // Along each axis from 0 to 2, in the direction of the split edge.
    Numbers at[3][3][3];
    const float* p = heights_.at(q) + n;
    const HeightGrid::Steps i = HeightGrid::steps(q, 0), j = HeightGrid::steps(q, 1),
                            k = HeightGrid::steps(q, 2);
    const bool forth_j = (q.j & 3) == 1, forth_k = (q.k & 3) == 1;
    const std::ptrdiff_t ys[3] = {forth_j ? j.before : j.after, 0, forth_j ? j.after : j.before};
    const std::ptrdiff_t zs[3] = {forth_k ? k.before : k.after, 0, forth_k ? k.after : k.before};
    const Integers turn = lanes_turned(false, true);
    for (int z = 0; z < 3; ++z) {
      for (int y = 0; y < 3; ++y) {
        const float* row = p + ys[y] + zs[z];
        const Numbers before = Lanes::load(row + i.before), after = Lanes::load(row + i.after);
        at[0][y][z] = turn ? after : before;
        at[1][y][z] = Lanes::load(row);
        at[2][y][z] = turn ? before : after;
      }
    }
    // Corners by the axes along which they lie at 2, as bits; by the bits of two of them, what lies between.
    const auto between = [&at](int a, int b) __attribute__((always_inline)) {
      return at[(a & 1) + (b & 1)][(a >> 1 & 1) + (b >> 1 & 1)][(a >> 2) + (b >> 2)];
    };
    Numbers from[8][3], length[8][3];
    for (int corner = 0; corner < 8; ++corner) {
      for (int axis = 0; axis < 3; ++axis) {
        const int next = corner | 1 << axis;
        if (next == corner) continue;
        const Numbers a = between(corner, corner), b = between(next, next);
        from[corner][axis] = deviation(between(corner, next), a, b);
        length[corner][axis] = square_of_half(b - a, axis);
      }
    }
    const Numbers middle = deviation(between(0, 7), between(0, 0), between(7, 7));
    Numbers greatest{};
    for (int a = 0; a < 3; ++a) {
      const int first = 1 << a;
      const Numbers far_face = deviation(between(first, 7), between(first, first), between(7, 7));
      for (int turns = 1; turns < 3; ++turns) {
        const int b = (a + turns) % 3, c = 3 - a - b, second = first | 1 << b;
        const Numbers near_face = deviation(between(0, second), between(0, 0), between(second, second));
        const Numbers faces = Lanes::greater(middle, Lanes::greater(far_face, near_face));
        const Numbers edges = Lanes::greater(from[0][a], Lanes::greater(from[first][b], from[second][c]));
        const Numbers slope = length[0][a] + length[first][b] + length[second][c];
        greatest =
            Lanes::greater(greatest, ratio(Lanes::greater(faces, edges), slope, geometry_.centre_diameter));
      }
    }
    return code(greatest);
  }

  /// -1 where something is turned: in the first lane or not, and then by turns or always the same.
  [[gnu::always_inline]] static inline Integers lanes_turned(bool first, bool by_turns) {
    Integers turn{};
    for (std::size_t n = 0; n < kCount; ++n) turn[n] = first != (by_turns && (n & 1) != 0) ? -1 : 0;
    return turn;
  }

  const HeightGrid& heights_;
  const ErrorGeometry& geometry_;
};

float squared_ratio(const std::array<LatticePoint, 4>& corners, const Vec3& spacing) {
  const double ratio = world_diameter(corners, spacing) / lod_error_scale(spacing, 0).greatest();
  return static_cast<float>(ratio * ratio);
}

}  // namespace

ErrorGeometry::ErrorGeometry(const Vec3& spacing) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    LatticePoint a{}, b{}, c{};
    a[axis] = 1, b[(axis + 1) % 3] = 1, c[(axis + 2) % 3] = 1;
    slope_factors[at] = static_cast<float>(adamas::slope_factors(spacing)[at]);
    edge_diameters[at] = squared_ratio({-a, a, b, b + c}, spacing);
    face_diameters[at] = squared_ratio({-b - c, b - c, b + c, a}, spacing);
  }
  centre_diameter = squared_ratio({{{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {1, 1, 1}}}, spacing);
}

void known_errors(const HeightGrid& heights, const ErrorGeometry& geometry, const PageShape& shape,
                  AllCells<std::uint8_t>& codes) {
  with_wide_lanes([&](auto bytes) {
    const RowErrors<bytes()> errors(heights, geometry);
    for (std::int32_t k = 0; k < shape.count.k; ++k) {
      for (std::int32_t j = 0; j < shape.count.j; ++j) {
        const auto even = static_cast<std::size_t>((j & 1) << 1 | (k & 1) << 2);
        const std::size_t cell = surrounding_place({0, j & ~1, k & ~1});
        errors.fill({0, j, k}, codes[even].data() + cell, codes[even + 1].data() + cell);
      }
    }
  });
}

}  // namespace adamas
