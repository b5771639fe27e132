#include "tests/support/value_reference.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/lattice/diamond_type.h"
#include "isosurface/compression/split_edge_prediction.h"
#include "isosurface/preprocessing/error_scale.h"
#include "isosurface/preprocessing/tetrahedron_samples.h"

namespace adamas::test {
namespace {

Vec3 in_space(LatticePoint p, const Vec3& spacing) {
  return {p.i * spacing.x, p.j * spacing.y, p.k * spacing.z};
}

/// Of the linear function with these values at the corners.
double gradient_length(const std::array<Vec3, 4>& x, const std::array<double, 4>& values) {
  const Vec3 a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
  const double volume = dot(cross(a, b), c);
  const Vec3 sum = (values[1] - values[0]) * cross(b, c) + (values[2] - values[0]) * cross(c, a) +
                   (values[3] - values[0]) * cross(a, b);
  return norm(sum) / std::abs(volume);
}

double diameter(const std::array<Vec3, 4>& x) {
  double longest = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < a; ++b) longest = std::max(longest, distance(x[a], x[b]));
  }
  return longest;
}

}  // namespace

template <class Sample>
ValueReference<Sample>::ValueReference(const std::array<std::uint64_t, 3>& dimensions,
                                       std::vector<Sample> samples, Vec3 spacing, int depth)
    : grid_(dimensions),
      dimensions_(dimensions),
      samples_(std::move(samples)),
      spacing_(spacing),
      depth_(depth) {
  const LatticePoint extent = grid_.extent(grid_.top());
  for (int axis = 0; axis < 3; ++axis) {
    size_[static_cast<std::size_t>(axis)] = (static_cast<std::size_t>(extent[axis]) << grid_.top()) + 1;
  }
  values_.resize(size_[0] * size_[1] * size_[2]);
  const auto end = [this](int axis) {
    return static_cast<std::int32_t>(size_[static_cast<std::size_t>(axis)]);
  };
  for (LatticePoint p{0, 0, 0}; p.k < end(2); ++p.k) {
    for (p.j = 0; p.j < end(1); ++p.j) {
      for (p.i = 0; p.i < end(0); ++p.i) values_[index(p)].sample = static_cast<Word>(ordered(sample(p)));
    }
  }
  for (int bits = depth_; bits < grid_.depth(); ++bits) {
    for (int phase = 3; phase-- > 0;) {
      const std::int32_t step = 1 << bits;
      for (LatticePoint p{0, 0, 0}; p.k < end(2); p.k += step) {
        for (p.j = 0; p.j < end(1); p.j += step) {
          for (p.i = 0; p.i < end(0); p.i += step) work_out(p, bits, phase);
        }
      }
    }
  }
}

template <class Sample>
Sample ValueReference<Sample>::sample(LatticePoint p) const {
  const LatticePoint last = grid_.last();
  for (int axis = 0; axis < 3; ++axis) p[axis] = std::clamp(p[axis], 0, last[axis]);
  return samples_[static_cast<std::size_t>(p.i) +
                  dimensions_[0] *
                      (static_cast<std::size_t>(p.j) + dimensions_[1] * static_cast<std::size_t>(p.k))];
}

/// Whether a page has the point.
template <class Sample>
bool ValueReference<Sample>::is_point(LatticePoint p) const {
  const int level = grid_.level(p);
  const LatticePoint extent = grid_.extent(level);
  for (int axis = 0; axis < 3; ++axis) {
    if (p[axis] < 0 || p[axis] > extent[axis] << level) return false;
  }
  return true;
}

template <class Sample>
double ValueReference<Sample>::greatest_diameter(int bits) const {
  return std::ldexp(2 * norm(spacing_), bits);
}

/// The diamonds of scale 2^bits and of the phase.
template <class Sample>
void ValueReference<Sample>::work_out(LatticePoint p, int bits, int phase) {
  if (trailing_zeros(p) != bits || !is_point(p)) return;
  const DiamondType& type = kDiamondTypes[static_cast<std::size_t>(diamond_type(p, bits))];
  if (type.phase != phase) return;
  Value value{values_[index(p)].sample};
  double error = 0;
  measure(p, bits, phase, error, value);
  const bool has_children = phase < 2 || bits > depth_;
  for (int c = 0; has_children && c < type.child_count; ++c) {
    LatticePoint child = p;
    for (int axis = 0; axis < 3; ++axis) {
      child[axis] += type.child_offsets[static_cast<std::size_t>(c)][axis] * (1 << bits) / 2;
    }
    if (!is_point(child)) continue;
    const Value& of = values_[index(child)];
    value.low = std::min(value.low, of.low);
    value.high = std::max(value.high, of.high);
    const ErrorScale scale(greatest_diameter(trailing_zeros(child)));
    error = std::max(error, scale.decode(of.error));
  }
  value.error = ErrorScale(greatest_diameter(bits)).encode(error);
  values_[index(p)] = value;
}

/// What the samples inside and on the diamond's own tetrahedra say.
template <class Sample>
void ValueReference<Sample>::measure(LatticePoint p, int bits, int phase, double& error, Value& value) const {
  const std::int32_t side = 1 << grid_.depth(), s = 1 << bits;
  const DiamondType& type = kDiamondTypes[static_cast<std::size_t>(diamond_type(p, bits))];
  const SampleBlock<Sample> block{
      {0, 0, 0}, {grid_.last().i + 1, grid_.last().j + 1, grid_.last().k + 1}, samples_.data()};
  for (int slot = 0; slot < type.tetrahedron_count; ++slot) {
    const auto ring = [&](int n) { return type.ring[static_cast<std::size_t>(n % type.tetrahedron_count)]; };
    const std::array<LatticePoint, 4> corners{p - s * type.direction, p + s * type.direction,
                                              p + s * ring(slot), p + s * ring(slot + 1)};
    std::array<Vec3, 4> places{};
    std::array<double, 4> values{};
    bool inside = true, finite = true;
    for (std::size_t n = 0; n < 4; ++n) {
      for (int axis = 0; axis < 3; ++axis) {
        inside = inside && corners[n][axis] >= 0 && corners[n][axis] <= side;
      }
      places[n] = in_space(corners[n], spacing_);
      values[n] = static_cast<double>(sample(corners[n]));
      finite = finite && std::isfinite(values[n]);
    }
    if (!inside) continue;
    SampleDeviation deviation;
    TetrahedronRows(corners).measure(block, values, deviation);
    if (deviation.min <= deviation.max) {
      value.low = std::min(value.low, static_cast<Word>(ordered(static_cast<Sample>(deviation.min))));
      value.high = std::max(value.high, static_cast<Word>(ordered(static_cast<Sample>(deviation.max))));
    }
    const double longest = diameter(places);
    if (!finite) {
      error = std::max(error, bits == 0 && phase == 2 ? 0 : longest);
    } else if (deviation.error > 0) {
      error = std::max(error, std::min(deviation.error / gradient_length(places, values), longest));
    }
  }
}

template <class Sample>
Page<typename ValueReference<Sample>::Word> ValueReference<Sample>::page(const PageId& id) const {
  Page<Word> result{};
  const LatticePoint count = grid_.count(id);
  for (LatticePoint q{0, 0, 0}; q.k < count.k; ++q.k) {
    for (q.j = 0; q.j < count.j; ++q.j) {
      for (q.i = 0; q.i < count.i; ++q.i) {
        const LatticePoint p = (1 << id.level) * (16 * id.block + q);
        const Value& value = values_[index(p)];
        const std::size_t at = PageGrid::place(p, id.level);
        result.samples[at] = value.sample;
        result.low[at] = value.low;
        result.high[at] = value.high;
        result.errors[at] = value.error;
      }
    }
  }
  return result;
}

template <class Sample>
Surroundings<typename ValueReference<Sample>::Word> ValueReference<Sample>::around(const PageId& id) const {
  Surroundings<Word> result{};
  const LatticePoint extent = grid_.extent(id.level + 1);
  for (LatticePoint q{-2, -2, -2}; q.k <= 18; q.k += 2) {
    for (q.j = -2; q.j <= 18; q.j += 2) {
      for (q.i = -2; q.i <= 18; q.i += 2) {
        LatticePoint p = 16 * id.block + q;
        for (int axis = 0; axis < 3; ++axis) {
          p[axis] = std::clamp(p[axis], 0, 2 * extent[axis]) * (1 << id.level);
        }
        const Value& value = values_[index(p)];
        const std::size_t at = surrounding_place(q);
        result.samples[at] = value.sample;
        result.low[at] = value.low;
        result.high[at] = value.high;
        result.errors[at] = value.error;
      }
    }
  }
  return result;
}

template class ValueReference<std::uint8_t>;
template class ValueReference<std::uint16_t>;
template class ValueReference<std::int16_t>;
template class ValueReference<float>;

}  // namespace adamas::test
