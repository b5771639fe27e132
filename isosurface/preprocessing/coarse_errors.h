#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

#include "core/base/assert.h"
#include "core/base/simd.h"
#include "core/lattice/diamond.h"
#include "core/lattice/lattice_point.h"
#include "isosurface/preprocessing/cube_samples.h"
#include "isosurface/preprocessing/error_code.h"
#include "isosurface/preprocessing/lod_values.h"
#include "isosurface/preprocessing/own_errors.h"
#include "isosurface/volume/error_scale.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// The 24 tetrahedra of phase 2 and scale 8 of a cube of 16^3 cells. Every larger tetrahedron consists of
/// such. Coordinates are relative to the cube's first corner, for a cube whose own first split runs from
/// there; in other cubes they are mirrored.
class LeafPoints {
 public:
  static constexpr std::size_t kLeaves = 24;
  static constexpr std::size_t kPadding = 8;

  struct Leaf {
    std::array<LatticePoint, 4> corners;
    LatticePoint split_vertex;
    std::uint32_t first, last;  ///< range of points: a multiple of kPadding, filled up by repeating one
  };

  LeafPoints();

  [[nodiscard]] const std::vector<Leaf>& leaves() const { return leaves_; }
  /// Returns the coordinates of the points, one list per axis.
  template <class Real>
  [[nodiscard]] const Real* coordinates(int axis) const {
    if constexpr (sizeof(Real) == sizeof(float)) {
      return floats_[static_cast<std::size_t>(axis)].data();
    } else {
      return doubles_[static_cast<std::size_t>(axis)].data();
    }
  }
  /// Returns the places of the points among the cube's 17^3; an axis is mirrored if its bit in `mirrored` is
  /// set.
  [[nodiscard]] const std::uint16_t* places(int mirrored) const {
    return places_[static_cast<std::size_t>(mirrored)].data();
  }

 private:
  void add(LatticePoint p);

  std::vector<Leaf> leaves_;
  std::array<std::vector<float>, 3> floats_;
  std::array<std::vector<double>, 3> doubles_;
  std::array<std::vector<std::uint16_t>, 8> places_;
};

/// A tetrahedron that bisection makes of a lattice cube of side 2^depth, and then the larger ones that
/// contain it. Coordinates count samples.
class Ancestor {
 public:
  Ancestor(const std::array<LatticePoint, 4>& corners, LatticePoint split_vertex, int depth)
      : corners_(corners), split_vertex_(split_vertex), depth_(depth) {}

  [[nodiscard]] const std::array<LatticePoint, 4>& corners() const { return corners_; }
  /// Returns the split vertex of the diamond to which the tetrahedron belongs.
  [[nodiscard]] LatticePoint split_vertex() const { return split_vertex_; }
  [[nodiscard]] int scale_bits() const { return trailing_zeros(split_vertex_); }

  /// Goes on to the tetrahedron of which this one is a half; returns false if this one is not made by
  /// bisection.
  bool ascend() {
    LatticePoint* newest = nullptr;
    int latest = -1;
    for (LatticePoint& c : corners_) {
      const int zeros = trailing_zeros(c);
      if (zeros >= depth_) continue;
      const int generation = 3 * (depth_ - zeros) + 3 - odd_count(c, zeros);
      if (generation > latest) newest = &c, latest = generation;
    }
    if (newest == nullptr) return false;
    // The newest corner split the larger tetrahedron, and replaced one end of the split edge.
    const LatticePoint middle = *newest;
    const int zeros = trailing_zeros(middle);
    const LatticePoint half =
        (1 << zeros) * split_direction({middle.i >> zeros, middle.j >> zeros, middle.k >> zeros});
    bool has_upper = false;
    for (const LatticePoint c : corners_) has_upper = has_upper || c == middle + half;
    *newest = has_upper ? middle - half : middle + half;
    split_vertex_ = middle;
    return true;
  }

 private:
  static int odd_count(LatticePoint p, int zeros) {
    return (p.i >> zeros & 1) + (p.j >> zeros & 1) + (p.k >> zeros & 1);
  }

  std::array<LatticePoint, 4> corners_;
  LatticePoint split_vertex_;
  int depth_;
};

/// Own errors of the diamonds of scale 8 and more, as far as they depend on the samples of one cube of 16^3
/// cells: of every tetrahedron that contains a part of the cube.
template <class Sample>
class CoarseErrors {
 public:
  using Real = RealOf<Sample>;
  using Word = OrderedWord<Sample>;

  CoarseErrors(int depth, LatticePoint last, const Vec3& spacing, const CoarseSamples<Word>& coarse)
      : depth_(depth),
        last_(last),
        unit_((1 / lod_error_scale(spacing, 0).greatest()) * spacing),
        coarse_(coarse),
        factors_(slope_factors(spacing)) {}

  /// Raises the own codes of `lods`, the first of which has the samples round the cube.
  void measure(const CubeSamples<Sample>& cube, std::vector<LodValues<Word>>& lods) const {
    int mirrored = 0;
    for (int axis = 0; axis < 3; ++axis) mirrored |= (cube.base[axis] >> 4 & 1) << axis;
    for (const LeafPoints::Leaf& leaf : leaf_points_.leaves()) {
      const Part part = part_of(cube, leaf, mirrored);
      std::array<LatticePoint, 4> corners{};
      for (std::size_t c = 0; c < 4; ++c) corners[c] = place(cube.base, leaf.corners[c], mirrored);
      Ancestor cell(corners, place(cube.base, leaf.split_vertex, mirrored), depth_);
      do {
        const int bits = cell.scale_bits();
        LodValues<Word>& lod = lods[static_cast<std::size_t>(bits)];
        const LatticePoint at = cell.split_vertex();
        const LatticePoint p{at.i >> bits, at.j >> bits, at.k >> bits}, size = lod.size();
        if (p.i >= size.i || p.j >= size.j || p.k >= size.k) continue;
        lod.raise(p, code(cell, part, lods.front(), lod.own(p)));
      } while (cell.ascend());
    }
  }

 private:
  static constexpr std::size_t kMostPoints = 512;
  /// The samples of a leaf, as numbers.
  struct Part {
    LatticePoint base;
    int mirrored;
    std::array<LatticePoint, 4> corners;  ///< corners in the coordinates of LeafPoints
    std::size_t first, count;
    /// The range of the samples: low > high where none counts, `high` infinite where a sample of the data is
    /// not finite.
    /// not finite.
    double low, high;
    alignas(16) std::array<Real, kMostPoints> samples;
    /// The samples as doubles; not filled if Real is double.
    alignas(16) std::array<double, kMostPoints> exact;
  };
  /// The function constant + slope . p of a point p in the coordinates of LeafPoints.
  struct Linear {
    double constant = 0;
    std::array<double, 3> slope{};
    [[nodiscard]] double at(LatticePoint p) const {
      return constant + slope[0] * p.i + slope[1] * p.j + slope[2] * p.k;
    }
  };

  static LatticePoint place(LatticePoint base, LatticePoint p, int mirrored) {
    for (int axis = 0; axis < 3; ++axis) base[axis] += (mirrored >> axis & 1) != 0 ? 16 - p[axis] : p[axis];
    return base;
  }

  [[nodiscard]] Part part_of(const CubeSamples<Sample>& cube, const LeafPoints::Leaf& leaf,
                             int mirrored) const {
    Part part;
    part.base = cube.base;
    part.mirrored = mirrored;
    part.corners = leaf.corners;
    part.first = leaf.first;
    part.count = leaf.last - leaf.first;
    ADAMAS_ASSERT(part.count <= kMostPoints);
    const std::uint16_t* places = leaf_points_.places(mirrored) + leaf.first;
    auto low = std::numeric_limits<Real>::infinity(), high = -low;
    for (std::size_t n = 0; n < part.count; ++n) {
      const Real sample = part.samples[n] = cube.whole[places[n]];
      low = sample < low ? sample : low;
      high = sample > high ? sample : high;
    }
    part.low = low, part.high = high;
    if constexpr (sizeof(Real) < sizeof(double)) {
      if (depth_ > kExactBits + 1) std::copy_n(part.samples.begin(), part.count, part.exact.begin());
    }
    return part;
  }

  /// Up to tetrahedra of this scale the linear interpolation of integers is exact in a float: slopes are
  /// multiples of 1 / (2 scale), and at most the greatest integer over the scale.
  static constexpr int kExactBits = sizeof(Sample) == 1 ? 14 : 6;

  /// Returns the code of the tetrahedron's error, as far as it depends on the part; any lower code where it
  /// is at most `known`.
  [[nodiscard]] std::uint8_t code(const Ancestor& cell, const Part& part, const LodValues<Word>& samples,
                                  std::uint8_t known) const {
    const double scale = std::ldexp(1.0, cell.scale_bits());
    const double diameter = squared_diameter(cell.corners()) / (scale * scale);
    std::array<double, 4> values{};
    double sum = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      values[c] = value(cell.corners()[c], samples);
      sum += std::abs(values[c]);
    }
    if constexpr (std::is_same_v<Sample, float>) {
      if (!std::isfinite(sum) || part.high == std::numeric_limits<double>::infinity()) return error_code(1.0);
    }
    const Linear linear = interpolation(cell, values, part);
    double slope = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double step = linear.slope[axis] * scale;
      slope += step * step * factors_[axis];
    }
    const auto code_of = [&](double error) {
      return error > 0 ? error_code(std::min(error * error / slope, diameter)) : std::uint8_t{0};
    };
    // This is what rounding may subtract; nothing is rounded if samples are integers.
    const double slack = std::is_same_v<Sample, float> ? sum * 0x1p-48 : 0;
    if (code_of(greatest_difference(linear, part) + slack) <= known) return 0;
    const double error = difference(linear, part, cell.scale_bits());
    return error > 0 ? code_of(error + slack) : std::uint8_t{0};
  }

  /// Returns the square of the diameter, in units of the greatest error of LOD 0.
  [[nodiscard]] double squared_diameter(const std::array<LatticePoint, 4>& corners) const {
    double greatest = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const LatticePoint d = corners[a] - corners[b];
        greatest = std::max(greatest, squared_norm({d.i * unit_.x, d.j * unit_.y, d.k * unit_.z}));
      }
    }
    return greatest;
  }

  /// Returns a bound of the difference that holds wherever the samples lie.
  static double greatest_difference(const Linear& linear, const Part& part) {
    double greatest = 0;
    for (const LatticePoint corner : part.corners) {
      const double value = linear.at(corner);
      greatest = std::max({greatest, value - part.low, part.high - value});
    }
    return greatest;
  }

  [[nodiscard]] double difference(const Linear& linear, const Part& part, int scale_bits) const {
    if constexpr (sizeof(Real) < sizeof(double)) {
      if (scale_bits > kExactBits) return difference(linear, part.exact.data(), part);
    }
    return difference(linear, part.samples.data(), part);
  }

  [[nodiscard]] double value(LatticePoint p, const LodValues<Word>& samples) const {
    const Word word =
        ((p.i | p.j | p.k) & 15) == 0
            ? coarse_.at(p)
            : samples.samples(std::min(p.j, last_.j), std::min(p.k, last_.k))[std::min(p.i, last_.i)];
    return from_ordered<Sample>(word);
  }

  static Linear interpolation(const Ancestor& cell, const std::array<double, 4>& values, const Part& part) {
    const auto& c = cell.corners();
    const auto edge = [&](std::size_t n) {
      const LatticePoint e = c[n] - c[0];
      return Vec3{static_cast<double>(e.i), static_cast<double>(e.j), static_cast<double>(e.k)};
    };
    // The determinant is a power of two: nothing is rounded.
    const Vec3 u = edge(1), v = edge(2), w = edge(3);
    const Vec3 vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
    const Vec3 sum =
        (values[1] - values[0]) * vw + (values[2] - values[0]) * wu + (values[3] - values[0]) * uv;
    const Vec3 slope = (1 / dot(u, vw)) * sum;
    Linear linear;
    linear.constant = values[0];
    for (int axis = 0; axis < 3; ++axis) {
      const bool is_mirrored = (part.mirrored >> axis & 1) != 0;
      const std::int32_t origin = part.base[axis] + (is_mirrored ? 16 : 0);
      linear.constant += slope[axis] * (origin - c[0][axis]);
      linear.slope[static_cast<std::size_t>(axis)] = is_mirrored ? -slope[axis] : slope[axis];
    }
    return linear;
  }

  /// Returns the greatest difference between the samples and the linear function.
  template <class T>
  [[nodiscard]] double difference(const Linear& linear, const T* samples, const Part& part) const {
    const T *x = leaf_points_.coordinates<T>(0) + part.first,
            *y = leaf_points_.coordinates<T>(1) + part.first,
            *z = leaf_points_.coordinates<T>(2) + part.first;
    using Vector = Simd<T, 16>;
    using Lanes = typename Vector::Numbers;
    const Lanes zero{}, constant = zero + static_cast<T>(linear.constant);
    const Lanes i = zero + static_cast<T>(linear.slope[0]), j = zero + static_cast<T>(linear.slope[1]),
                k = zero + static_cast<T>(linear.slope[2]);
    Lanes greatest{}, least{};
    for (std::size_t n = 0; n < part.count; n += Vector::kCount) {
      const Lanes above = constant + i * Vector::load(x + n) + j * Vector::load(y + n) +
                          k * Vector::load(z + n) - Vector::load(samples + n);
      greatest = Vector::greater(greatest, above);
      least = Vector::greater(least, -above);
    }
    std::array<T, Vector::kCount> errors;
    Vector::store(Vector::greater(greatest, least), errors.data());
    return static_cast<double>(*std::max_element(errors.begin(), errors.end()));
  }

  int depth_;
  LatticePoint last_;
  Vec3 unit_;  ///< spacing over the greatest error of LOD 0
  const CoarseSamples<Word>& coarse_;
  std::array<double, 3> factors_;
  LeafPoints leaf_points_;
};

}  // namespace adamas::isosurface
