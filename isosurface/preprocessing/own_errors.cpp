#include "isosurface/preprocessing/own_errors.h"

#include <algorithm>
#include <cfloat>
#include <cstring>
#include <limits>
#include <type_traits>

#include "core/base/simd.h"
#include "core/lattice/lattice_point.h"
#include "isosurface/preprocessing/error_code.h"

#if defined(__FAST_MATH__)
#error "errors have to be rounded as IEEE 754 says: stores could not be decoded otherwise"
#endif
static_assert(FLT_EVAL_METHOD == 0, "floats are rounded to floats after each operation");

namespace adamas::isosurface {
namespace {

/// The arithmetic of own errors. Besides its corners, a tetrahedron of the finest LOD has samples only in the
/// middle of edges, and each of them is the middle of the same edge in all tetrahedra: the split edge of its
/// own diamond. So the distance of each sample from the mean of two others is computed first (`Deviations`),
/// then the errors.
///
/// If numbers are exact, deviations are replaced by their squares: the greatest deviation has the greatest
/// square.
template <class Real, std::size_t Bytes>
struct Arithmetic {
  static constexpr bool kExact = std::is_same_v<Real, float>;
  using Lanes = Simd<Real, Bytes>;
  using Numbers = typename Lanes::Numbers;
  using Block = SampleBlock<Real>;
  using Steps = typename Block::Steps;

  [[gnu::always_inline]] static inline Numbers square(Numbers x) { return x * x; }
  [[gnu::always_inline]] static inline Numbers magnitude(Numbers x) { return Lanes::greater(x, -x); }
  [[gnu::always_inline]] static inline Numbers mean(Numbers a, Numbers b) { return (a + b) * Real{0.5}; }

  /// Takes lanes of an even number from `a`, others from `b`; or the reverse if `b_first` is set.
  [[gnu::always_inline]] static inline Numbers by_turns(Numbers a, Numbers b, bool b_first) {
    using Integers = decltype(a < b);
    Integers second{};
    for (std::size_t n = 0; n < Lanes::kCount; ++n) second[n] = ((n & 1) != 0) != b_first ? -1 : 0;
    return second ? b : a;
  }
};

/// Returns whether the split edge of a face's diamond is the other diagonal than that through the corner with
/// the least coordinates: the ends of the split edge have either only multiples of four or none. The result
/// is for the first face of a row; if the faces lie across another axis than i, it alternates from one to the
/// next.
constexpr bool is_turned(LatticePoint q, int axis) {
  return ((axis == 0 ? q.j ^ q.k : axis == 1 ? q.k : q.j) & 2) != 0;
}

/// The distance of each sample from the mean of the ends of its diamond's split edge; 0 where it does not
/// count.
template <class Real, std::size_t Bytes>
class Deviations : Arithmetic<Real, Bytes> {
  using Base = Arithmetic<Real, Bytes>;
  using typename Base::Block, typename Base::Lanes, typename Base::Numbers, typename Base::Steps;

 public:
  Deviations(const Block& samples, const Block& counted, Block& found)
      : samples_(samples), counted_(counted), found_(found) {}

  /// Finds the deviations of a row's points from 0 to 16.
  [[gnu::always_inline]] inline void fill(LatticePoint row) const {
    const LatticePoint first{1, row.j, row.k};
    for (std::size_t n = 0; n < 8; n += Lanes::kCount) {
      if ((row.j & row.k & 1) != 0) {
        fill_centre(first, n);
      } else if (((row.j | row.k) & 1) != 0) {
        fill_face(first, (row.j & 1) != 0 ? 2 : 1, n);
      } else {
        fill_edge(first, 0, n);
      }
    }
    if (((row.j | row.k) & 1) == 0) return;
    // Nine points have an even coordinate: some are computed twice.
    for (std::size_t n = 0; n < 9; n += Lanes::kCount) {
      const std::size_t at = std::min(n, 9 - Lanes::kCount);
      if ((row.j & row.k & 1) != 0) {
        fill_face(row, 0, at);
      } else {
        fill_edge(row, (row.j & 1) != 0 ? 1 : 2, at);
      }
    }
  }

 private:
  [[gnu::always_inline]] inline void store(LatticePoint q, std::size_t n, Numbers mean) const {
    const Numbers difference = Lanes::load(counted_.at(q) + n) - mean;
    const Numbers deviation = Base::kExact ? Base::square(difference) : Base::magnitude(difference);
    Lanes::store(Lanes::greater(Numbers{}, deviation), found_.at(q) + n);
  }
  [[gnu::always_inline]] inline void fill_edge(LatticePoint q, int axis, std::size_t n) const {
    const Steps along = Block::steps(q, axis);
    const Real* p = samples_.at(q) + n;
    store(q, n, Base::mean(Lanes::load(p + along.before), Lanes::load(p + along.after)));
  }
  [[gnu::always_inline]] inline void fill_face(LatticePoint q, int axis, std::size_t n) const {
    const Steps a = Block::steps(q, axis == 0 ? 1 : 0), b = Block::steps(q, axis == 2 ? 1 : 2);
    const Real* p = samples_.at(q) + n;
    const Numbers straight =
        Base::mean(Lanes::load(p + a.before + b.before), Lanes::load(p + a.after + b.after));
    const Numbers turned =
        Base::mean(Lanes::load(p + a.before + b.after), Lanes::load(p + a.after + b.before));
    const bool is_first_turned = is_turned(q, axis);
    store(q, n,
          axis != 0         ? Base::by_turns(straight, turned, is_first_turned)
          : is_first_turned ? turned
                            : straight);
  }
  [[gnu::always_inline]] inline void fill_centre(LatticePoint q, std::size_t n) const {
    const Steps i = Block::steps(q, 0), j = Block::steps(q, 1), k = Block::steps(q, 2);
    const bool forth_j = (q.j & 3) == 1, forth_k = (q.k & 3) == 1;
    const Real* from = samples_.at(q) + n + (forth_j ? j.before : j.after) + (forth_k ? k.before : k.after);
    const Real* to = samples_.at(q) + n + (forth_j ? j.after : j.before) + (forth_k ? k.after : k.before);
    store(q, n,
          Base::by_turns(Base::mean(Lanes::load(from + i.before), Lanes::load(to + i.after)),
                         Base::mean(Lanes::load(from + i.after), Lanes::load(to + i.before)), false));
  }

  const Block &samples_, &counted_;
  Block& found_;
};

/// Computes codes of own errors in rows of points.
template <class Real, std::size_t Bytes>
class RowErrors : Arithmetic<Real, Bytes> {
  using Base = Arithmetic<Real, Bytes>;
  using typename Base::Block, typename Base::Lanes, typename Base::Numbers, typename Base::Steps;
  static constexpr std::size_t kCount = Lanes::kCount;

 public:
  RowErrors(const Block& samples, const Block& deviations, const OwnErrorGeometry& geometry)
      : samples_(samples), deviations_(deviations), geometry_(geometry) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      factors_[axis] = static_cast<Real>(geometry.slope_factors[axis]);
  }

  /// Finds the codes of all points of a row, by the parity of their first coordinate.
  [[gnu::always_inline]] inline void fill(LatticePoint row, std::uint8_t* even_codes,
                                          std::uint8_t* odd_codes) const {
    const LatticePoint first{1, row.j, row.k};
    for (std::size_t n = 0; n < 8; n += kCount) {
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
        store(Numbers{}, even_codes + n);
        store(edge<0>(first, n), odd_codes + n);
      }
    }
  }

 private:
  /// Stores the codes of the squared ratios of the errors to the LOD's greatest error.
  [[gnu::always_inline]] static inline void store(Numbers squared, std::uint8_t* to) {
    if constexpr (Base::kExact) {
      store_least_bytes<Bytes>(error_codes<Bytes>(squared), to);
    } else {
      for (std::size_t n = 0; n < kCount; ++n) to[n] = error_code(static_cast<double>(squared[n]));
    }
  }

  /// Returns the squared ratio of a tetrahedron's error to the LOD's greatest: the deviation over the
  /// gradient, or the diameter if that is less. `corners`: the sum of the corners' magnitudes.
  [[gnu::always_inline]] static inline Numbers ratio(Numbers deviation, Numbers slope, Numbers corners,
                                                     float diameter) {
    const Numbers most = Numbers{} + diameter;
    if constexpr (Base::kExact) {
      return deviation > 0 ? Lanes::lesser(most, deviation / slope) : Numbers{};
    } else {
      // Errors are raised by more than rounding may have reduced them.
      const Numbers error = deviation > 0 ? deviation + corners * 0x1p-49 : Numbers{};
      const Numbers bounded = error > 0 ? Lanes::lesser(most, error * error / slope) : Numbers{};
      return (corners + error) * 0 == 0 ? bounded : Numbers{} + 1;
    }
  }

  /// The greatest ratio of tetrahedra of the same deviation and diameter.
  class Tetrahedra {
   public:
    [[gnu::always_inline]] inline Tetrahedra(Numbers deviation, float diameter)
        : deviation_(deviation), diameter_(diameter) {}
    /// Adds two tetrahedra, whose last corner is at `a` or at `b`. `slope` is the part of the slope between
    /// the other corners, and `corners` the sum of their magnitudes; the last step is from `foot` to the last
    /// corner.
    [[gnu::always_inline]] inline void add(Numbers slope, Numbers corners, Numbers foot, Numbers a, Numbers b,
                                           Real factor) {
      const Numbers to_a = Base::square(a - foot), to_b = Base::square(b - foot);
      if constexpr (Base::kExact) {
        // Among quotients with the same dividend, the one with the least divisor is the greatest, also after
        // rounding.
        const Numbers least = slope + Lanes::lesser(to_a, to_b) * factor;
        found_ = Lanes::lesser(found_, least);
      } else {
        const Numbers of_a =
            ratio(deviation_, slope + to_a * factor, corners + Base::magnitude(a), diameter_);
        const Numbers of_b =
            ratio(deviation_, slope + to_b * factor, corners + Base::magnitude(b), diameter_);
        found_ = Lanes::greater(found_, Lanes::greater(of_a, of_b));
      }
    }
    [[gnu::always_inline]] [[nodiscard]] inline Numbers greatest() const {
      if constexpr (Base::kExact) return ratio(deviation_, found_, Numbers{}, diameter_);
      return found_;
    }

   private:
    Numbers deviation_;
    float diameter_;
    /// The least slope if numbers are exact, otherwise the greatest ratio.
    Numbers found_ = Numbers{} + (Base::kExact ? std::numeric_limits<Real>::infinity() : Real{0});
  };

  [[gnu::always_inline]] inline Numbers square_of_half(Numbers difference, int axis) const {
    return Base::square(difference * Real{0.5}) * factor(axis);
  }
  [[nodiscard]] Real factor(int axis) const { return factors_[static_cast<std::size_t>(axis)]; }

  /// Adds eight tetrahedra, each of which has the centre of a face and that of a cube.
  template <int Axis>
  [[gnu::always_inline]] inline Numbers edge(LatticePoint q, std::size_t n) const {
    constexpr int kB = (Axis + 1) % 3, kC = (Axis + 2) % 3;
    const Steps along = Block::steps(q, Axis);
    const Steps across[2] = {Block::steps(q, kB), Block::steps(q, kC)};
    const Real* p = samples_.at(q) + n;
    const Numbers before = Lanes::load(p + along.before), after = Lanes::load(p + along.after);
    const Numbers mean = Base::mean(before, after), own = square_of_half(after - before, Axis);
    const Numbers ends = Base::magnitude(before) + Base::magnitude(after);
    Tetrahedra all(Lanes::load(deviations_.at(q) + n),
                   geometry_.edge_diameters[static_cast<std::size_t>(Axis)]);
    for (int turn = 0; turn < 2; ++turn) {
      const Steps b = across[turn], c = across[1 - turn];
      const Real to_face = factor(turn == 0 ? kB : kC), to_cube = factor(turn == 0 ? kC : kB);
      for (int side = 0; side < 2; ++side) {
        const Real* at = p + (side == 0 ? b.before : b.after);
        const Numbers face = Lanes::load(at);
        all.add(own + Base::square(face - mean) * to_face, ends + Base::magnitude(face), face,
                Lanes::load(at + c.before), Lanes::load(at + c.after), to_cube);
      }
    }
    return all.greatest();
  }

  /// Adds four tetrahedra, each of which has a corner beside the diagonal that is split and the centre of a
  /// cube.
  template <int Axis>
  [[gnu::always_inline]] inline Numbers face(LatticePoint q, std::size_t n) const {
    constexpr int kA = (Axis + 1) % 3, kB = (Axis + 2) % 3;
    const Steps across = Block::steps(q, Axis), a = Block::steps(q, kA), b = Block::steps(q, kB);
    const bool is_first_turned = is_turned(q, Axis);
    const auto turn = [is_first_turned](Numbers straight, Numbers turned) __attribute__((always_inline)) {
      if constexpr (Axis != 0) return Base::by_turns(straight, turned, is_first_turned);
      return is_first_turned ? turned : straight;
    };
    const Real *p = samples_.at(q) + n, *d = deviations_.at(q) + n;
    const Numbers v00 = Lanes::load(p + a.before + b.before), v10 = Lanes::load(p + a.after + b.before);
    const Numbers v01 = Lanes::load(p + a.before + b.after), v11 = Lanes::load(p + a.after + b.after);
    const Numbers mean = turn(Base::mean(v00, v11), Base::mean(v10, v01));
    const Numbers ends =
        turn(Base::magnitude(v00) + Base::magnitude(v11), Base::magnitude(v10) + Base::magnitude(v01));
    const Numbers along_a[2] = {square_of_half(v10 - v00, kA), square_of_half(v11 - v01, kA)};
    const Numbers along_b[2] = {square_of_half(v01 - v00, kB), square_of_half(v11 - v10, kB)};
    const Numbers from_a[2] = {Lanes::load(d + b.before), Lanes::load(d + b.after)};
    const Numbers from_b[2] = {Lanes::load(d + a.before), Lanes::load(d + a.after)};
    const Numbers corner[2] = {turn(v10, v00), turn(v01, v11)};
    const Numbers middle = Lanes::load(d), before = Lanes::load(p + across.before),
                  after = Lanes::load(p + across.after);
    Numbers greatest{};
    for (int half = 0; half < 2; ++half) {
      // These are the sides along a and b that meet in the corner beside the diagonal.
      const Numbers side_b = turn(along_b[1 - half], along_b[half]);
      const Numbers deviation =
          Lanes::greater(middle, Lanes::greater(from_a[half], turn(from_b[1 - half], from_b[half])));
      Tetrahedra both(deviation, geometry_.face_diameters[static_cast<std::size_t>(Axis)]);
      both.add(along_a[half] + side_b, ends + Base::magnitude(corner[half]), mean, before, after,
               factor(Axis));
      greatest = Lanes::greater(greatest, both.greatest());
    }
    return greatest;
  }

  /// Adds six tetrahedra, each of which has three edges of the cube between one end of the diagonal that is
  /// split and the other.
  [[gnu::always_inline]] inline Numbers centre(LatticePoint q, std::size_t n) const {
    const Cube samples(samples_, q, n), deviations(deviations_, q, n);
    Numbers length[8][3];
    for (int corner = 0; corner < 8; ++corner) {
      for (int axis = 0; axis < 3; ++axis) {
        const int next = corner | 1 << axis;
        if (next != corner)
          length[corner][axis] =
              square_of_half(samples.between(next, next) - samples.between(corner, corner), axis);
      }
    }
    const Numbers ends = Base::magnitude(samples.between(0, 0)) + Base::magnitude(samples.between(7, 7));
    Numbers greatest{};
    for (int a = 0; a < 3; ++a) {
      const int first = 1 << a;
      for (int turns = 1; turns < 3; ++turns) {
        const int b = (a + turns) % 3, c = 3 - a - b, second = first | 1 << b;
        Numbers deviation = deviations.between(0, 7);
        for (const Numbers other :
             {deviations.between(first, 7), deviations.between(0, second), deviations.between(0, first),
              deviations.between(first, second), deviations.between(second, 7)})
          deviation = Lanes::greater(deviation, other);
        const Numbers corners = ends + Base::magnitude(samples.between(first, first)) +
                                Base::magnitude(samples.between(second, second));
        greatest =
            Lanes::greater(greatest, ratio(deviation, length[0][a] + length[first][b] + length[second][c],
                                           corners, geometry_.centre_diameter));
      }
    }
    return greatest;
  }

  /// Numbers round the centres of cubes, seen from the beginning of each cube's split edge.
  class Cube {
   public:
    [[gnu::always_inline]] inline Cube(const Block& block, LatticePoint q, std::size_t n) {
      const Real* p = block.at(q) + n;
      const Steps i = Block::steps(q, 0), j = Block::steps(q, 1), k = Block::steps(q, 2);
      const bool forth_j = (q.j & 3) == 1, forth_k = (q.k & 3) == 1;
      const std::ptrdiff_t ys[3] = {forth_j ? j.before : j.after, 0, forth_j ? j.after : j.before};
      const std::ptrdiff_t zs[3] = {forth_k ? k.before : k.after, 0, forth_k ? k.after : k.before};
      for (int z = 0; z < 3; ++z) {
        for (int y = 0; y < 3; ++y) {
          const Real* row = p + ys[y] + zs[z];
          const Numbers before = Lanes::load(row + i.before), after = Lanes::load(row + i.after);
          at_[0][y][z] = Base::by_turns(before, after, false);
          at_[1][y][z] = Lanes::load(row);
          at_[2][y][z] = Base::by_turns(after, before, false);
        }
      }
    }
    /// Returns the number of the point between two corners of the cube, each of which is given by a bit for
    /// each axis.
    [[gnu::always_inline]] [[nodiscard]] inline Numbers between(int a, int b) const {
      return at_[(a & 1) + (b & 1)][(a >> 1 & 1) + (b >> 1 & 1)][(a >> 2) + (b >> 2)];
    }

   private:
    Numbers at_[3][3][3];
  };

  const Block &samples_, &deviations_;
  const OwnErrorGeometry& geometry_;
  Real factors_[3];
};

}  // namespace

template <class Real>
void own_errors(const SampleBlock<Real>& samples, const SampleBlock<Real>& counted,
                const OwnErrorGeometry& geometry, LatticePoint count, OwnErrorCodes& codes) {
  with_wide_lanes([&](auto bytes) {
    SampleBlock<Real> deviations;
    const Deviations<Real, bytes()> to_mean(samples, counted, deviations);
    for (std::int32_t k = 0; k <= (count.k & ~1); ++k) {
      for (std::int32_t j = 0; j <= (count.j & ~1); ++j) to_mean.fill({0, j, k});
    }
    const RowErrors<Real, bytes()> errors(samples, deviations, geometry);
    for (std::int32_t k = 0; k < count.k; ++k) {
      for (std::int32_t j = 0; j < count.j; ++j) errors.fill({0, j, k}, codes.even(j, k), codes.odd(j, k));
    }
  });
}

template void own_errors(const SampleBlock<float>&, const SampleBlock<float>&, const OwnErrorGeometry&,
                         LatticePoint, OwnErrorCodes&);
template void own_errors(const SampleBlock<double>&, const SampleBlock<double>&, const OwnErrorGeometry&,
                         LatticePoint, OwnErrorCodes&);

namespace {

/// Returns the spacing over the greatest of the three, so that no square is too large for a number.
Vec3 relative(const Vec3& spacing) { return (1 / std::max({spacing.x, spacing.y, spacing.z})) * spacing; }

/// Returns the squared length of a lattice vector, where samples lie `spacing` apart.
double squared_length(LatticePoint d, const Vec3& spacing) {
  const double x = d.i * spacing.x, y = d.j * spacing.y, z = d.k * spacing.z;
  return x * x + y * y + z * z;
}

/// Returns the square of the LOD's greatest error: the diameter of the tetrahedra in cubes.
double squared_greatest(const Vec3& spacing) { return squared_length({2, 2, 2}, spacing); }

float squared_ratio(const std::array<LatticePoint, 4>& corners, const Vec3& spacing) {
  double squared = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < a; ++b)
      squared = std::max(squared, squared_length(corners[a] - corners[b], spacing));
  }
  return static_cast<float>(squared / squared_greatest(spacing));
}

}  // namespace

std::array<double, 3> slope_factors(const Vec3& spacing) {
  const Vec3 step = relative(spacing);
  std::array<double, 3> factors{};
  // Factors are limited, since their products have to fit in a float. Errors become too large rather than too
  // small.
  for (int axis = 0; axis < 3; ++axis)
    factors[static_cast<std::size_t>(axis)] =
        std::min(squared_greatest(step) / (step[axis] * step[axis]), 0x1p80);
  return factors;
}

OwnErrorGeometry::OwnErrorGeometry(const Vec3& spacing)
    : slope_factors(adamas::isosurface::slope_factors(spacing)) {
  const Vec3 step = relative(spacing);
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    LatticePoint a{}, b{}, c{};
    a[axis] = 1, b[(axis + 1) % 3] = 1, c[(axis + 2) % 3] = 1;
    edge_diameters[at] = squared_ratio({-a, a, b, b + c}, step);
    face_diameters[at] = squared_ratio({-b - c, b - c, b + c, a}, step);
  }
  centre_diameter = squared_ratio({{{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {1, 1, 1}}}, step);
}

}  // namespace adamas::isosurface
