#include "tests/support/preprocess_reference.h"

#include <algorithm>
#include <cmath>

#include "core/lattice/diamond.h"
#include "isosurface/volume/error_scale.h"
#include "tests/support/bisection_reference.h"

namespace adamas::test {

using namespace isosurface;

namespace {

using Big = std::int64_t;

Big determinant(LatticePoint a, LatticePoint b, LatticePoint c) {
  return Big{a.i} * (Big{b.j} * c.k - Big{b.k} * c.j) + Big{a.j} * (Big{b.k} * c.i - Big{b.i} * c.k) +
         Big{a.k} * (Big{b.i} * c.j - Big{b.j} * c.i);
}

Big volume_of(const std::array<LatticePoint, 4>& c) {
  return determinant(c[1] - c[0], c[2] - c[0], c[3] - c[0]);
}

/// The barycentric coordinates of points in a tetrahedron, multiplied by six times its volume.
struct Barycentric {
  explicit Barycentric(const std::array<LatticePoint, 4>& corners) {
    const Big signed_whole = volume_of(corners), sign = signed_whole > 0 ? 1 : -1;
    whole = sign * signed_whole;
    for (std::size_t c = 0; c < 4; ++c) {
      const auto at = [&](LatticePoint p) {
        auto replaced = corners;
        replaced[c] = p;
        return sign * volume_of(replaced);
      };
      origin[c] = at({0, 0, 0});
      steps[c] = {at({1, 0, 0}) - origin[c], at({0, 1, 0}) - origin[c], at({0, 0, 1}) - origin[c]};
    }
  }
  [[nodiscard]] Big at(std::size_t c, LatticePoint p) const {
    return origin[c] + p.i * steps[c][0] + p.j * steps[c][1] + p.k * steps[c][2];
  }
  /// Returns the gradient, in space, of the linear interpolation of values at the corners.
  [[nodiscard]] Vec3 gradient(const std::array<double, 4>& values, const Vec3& spacing) const {
    Vec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t c = 0; c < 4; ++c)
        slope[axis] += values[c] * (static_cast<double>(steps[c][static_cast<std::size_t>(axis)]) /
                                    static_cast<double>(whole));
      slope[axis] /= spacing[axis];
    }
    return slope;
  }

  Big whole = 0;
  std::array<Big, 4> origin{};
  std::array<std::array<Big, 3>, 4> steps{};
};

}  // namespace

bool ReferenceVolume::contains(LatticePoint p) const {
  const LatticePoint end = last();
  return std::min({p.i, p.j, p.k}) >= 0 && p.i <= end.i && p.j <= end.j && p.k <= end.k;
}

double ReferenceVolume::value(LatticePoint p) const {
  const LatticePoint end = last();
  return values[index({std::min(p.i, end.i), std::min(p.j, end.j), std::min(p.k, end.k)})];
}

PreprocessReference::PreprocessReference(const ReferenceVolume& volume) : volume_(volume) {
  const LatticePoint last = volume.last();
  while ((1 << depth_) < std::max({last.i, last.j, last.k})) ++depth_;
  for (int zeros = 0; zeros < depth_; ++zeros) {
    const std::int32_t s = 1 << zeros;
    for (const int phase : {2, 1, 0}) {
      for (std::int32_t k = 0; k <= last.k + s; k += s)
        for (std::int32_t j = 0; j <= last.j + s; j += s)
          for (std::int32_t i = 0; i <= last.i + s; i += s) {
            const LatticePoint p{i, j, k};
            const int odd = (i >> zeros & 1) + (j >> zeros & 1) + (k >> zeros & 1);
            if (trailing_zeros(p) == zeros && 3 - odd == phase && in_lattice(p) && exists(p)) add(p);
          }
    }
  }
}

const ErrorScale& PreprocessReference::scale(int lod) const {
  const auto found = scales_.find(lod);
  if (found != scales_.end()) return found->second;
  return scales_.emplace(lod, lod_error_scale(volume_.grid.spacing, lod)).first->second;
}

bool PreprocessReference::in_lattice(LatticePoint p) const {
  return std::min({p.i, p.j, p.k}) >= 0 && std::max({p.i, p.j, p.k}) <= 1 << depth_;
}

bool PreprocessReference::exists(LatticePoint p) const {
  const std::int32_t s = 1 << trailing_zeros(p);
  for (int axis = 0; axis < 3; ++axis) {
    if (volume_.last()[axis] > 0 && p[axis] - s >= volume_.last()[axis]) return false;
  }
  return true;
}

std::vector<LatticePoint> PreprocessReference::children(LatticePoint p) const {
  const int shift = kRootBits - depth_;
  const Diamond diamond({p.i << shift, p.j << shift, p.k << shift});
  std::vector<LatticePoint> result;
  if (trailing_zeros(p) == 0 && diamond.phase() == 2) return result;
  for (int c = 0; c < diamond.child_count(); ++c) {
    const LatticePoint q = diamond.child(c);
    const LatticePoint child{q.i >> shift, q.j >> shift, q.k >> shift};
    if (in_lattice(child)) result.push_back(child);
  }
  return result;
}

std::vector<PreprocessReference::Corners> PreprocessReference::tetrahedra(LatticePoint p) const {
  const int shift = kRootBits - depth_;
  const Diamond diamond({p.i << shift, p.j << shift, p.k << shift});
  std::vector<Corners> result;
  for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot) {
    Corners corners = diamond.tetrahedron(slot);
    for (LatticePoint& c : corners) c = {c.i >> shift, c.j >> shift, c.k >> shift};
    if (std::all_of(corners.begin(), corners.end(), [this](LatticePoint c) { return in_lattice(c); }))
      result.push_back(corners);
  }
  return result;
}

double PreprocessReference::measure(const Corners& corners, ReferenceValues& result) const {
  std::array<double, 4> values{};
  LatticePoint from = corners[0], to = corners[0];
  bool is_finite = true;
  for (std::size_t c = 0; c < 4; ++c) {
    values[c] = volume_.value(corners[c]);
    is_finite = is_finite && std::isfinite(values[c]);
    for (int axis = 0; axis < 3; ++axis) {
      from[axis] = std::min(from[axis], corners[c][axis]);
      to[axis] = std::max(to[axis], corners[c][axis]);
    }
  }
  for (int axis = 0; axis < 3; ++axis) to[axis] = std::min(to[axis], volume_.last()[axis]);
  const Barycentric barycentric(corners);
  double error = 0;
  for (std::int32_t k = from.k; k <= to.k; ++k)
    for (std::int32_t j = from.j; j <= to.j; ++j)
      for (std::int32_t i = from.i; i <= to.i; ++i) {
        const LatticePoint p{i, j, k};
        std::array<Big, 4> parts{};
        for (std::size_t c = 0; c < 4; ++c) parts[c] = barycentric.at(c, p);
        if (std::min({parts[0], parts[1], parts[2], parts[3]}) < 0) continue;
        const double sample = volume_.value(p);
        if (!std::isfinite(sample)) {
          is_finite = false;
          continue;
        }
        const std::uint32_t word = volume_.words[volume_.index(p)];
        result.low = std::min(result.low, word);
        result.high = std::max(result.high, word);
        double linear = 0;
        for (std::size_t c = 0; c < 4; ++c)
          linear += values[c] * (static_cast<double>(parts[c]) / static_cast<double>(barycentric.whole));
        error = std::max(error, std::abs(linear - sample));
      }
  double diameter = 0;
  for (const LatticePoint a : corners)
    for (const LatticePoint b : corners) {
      const LatticePoint d = a - b;
      const Vec3& s = volume_.grid.spacing;
      diameter = std::max(diameter, norm({d.i * s.x, d.j * s.y, d.k * s.z}));
    }
  if (!is_finite) {
    const auto [a, b] = longest_edge(corners);
    const int lod = trailing_zeros(midpoint(corners[a], corners[b]));
    return scale(lod).greatest();
  }
  if (error == 0) return 0;
  return std::min(diameter, error / norm(barycentric.gradient(values, volume_.grid.spacing)));
}

void PreprocessReference::add(LatticePoint p) {
  ReferenceValues values;
  for (const Corners& corners : tetrahedra(p)) values.own = std::max(values.own, measure(corners, values));
  const int lod = trailing_zeros(p);
  double least = values.own * (1 - 1e-9), greatest = values.own * (1 + 2e-6);
  for (const LatticePoint child : children(p)) {
    const auto found = diamonds_.find(child);
    if (found == diamonds_.end()) continue;
    const ErrorScale& of_child = scale(trailing_zeros(child));
    least = std::max(least, of_child.decode(found->second.least_code));
    greatest = std::max(greatest, of_child.decode(found->second.greatest_code));
    values.low = std::min(values.low, found->second.low);
    values.high = std::max(values.high, found->second.high);
  }
  values.least_code = scale(lod).encode(least);
  values.greatest_code = scale(lod).encode(greatest);
  diamonds_[p] = values;
}

}  // namespace adamas::test
