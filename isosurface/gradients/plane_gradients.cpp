#include "isosurface/gradients/plane_gradients.h"

#include <cmath>
#include <limits>
#include <type_traits>

#include "core/base/assert.h"
#include "core/base/parallel.h"

namespace adamas::isosurface {

/// Sums and differences of the eight samples round each sample of a row along i, which are across the row and
/// at equal i. Differences are computed before weighting, so that those of integers are exact and equal
/// samples give zero.
template <class Sample>
class PlaneGradients::RowSums {
 public:
  using Sum = std::conditional_t<std::is_integral_v<Sample>, std::int32_t, double>;

  explicit RowSums(std::size_t count) : count_(count), sums_(kSums * count) {}

  /// Sets the sums from the rows at k - 1, k and k + 1, each at j - 1, j and j + 1.
  void set(const std::array<std::array<const Sample*, 3>, 3>& rows) {
    middle_ = rows[1][1];
    set_middle(rows[1][0], rows[1][2], rows[0][1], rows[2][1], at(kAcrossY), at(kAcrossZ), at(kY), at(kZ));
    set_corners(rows[0][0], rows[0][2], rows[2][0], rows[2][2], at(kCorners), at(kCornersY), at(kCornersZ));
  }

  /// Fills the components at [1, count - 1). If the middle is not finite, x is not finite either.
  void components(const std::array<Weights, 3>& weights, Row& to) const {
    along(weights[0], to.x.data());
    across(weights[1], at(kY), at(kCornersY), to.y.data());
    across(weights[2], at(kZ), at(kCornersZ), to.z.data());
  }

 private:
  enum Which : std::size_t { kAcrossY, kAcrossZ, kCorners, kY, kCornersY, kZ, kCornersZ, kSums };

  Sum* at(Which which) { return sums_.data() + which * count_; }
  [[nodiscard]] const Sum* at(Which which) const { return sums_.data() + which * count_; }

  void set_middle(const Sample* south, const Sample* north, const Sample* below, const Sample* above,
                  Sum* __restrict across_y, Sum* __restrict across_z, Sum* __restrict y,
                  Sum* __restrict z) const {
    for (std::size_t i = 0; i < count_; ++i) {
      across_y[i] = Sum{south[i]} + Sum{north[i]};
      across_z[i] = Sum{below[i]} + Sum{above[i]};
      y[i] = Sum{north[i]} - Sum{south[i]};
      z[i] = Sum{above[i]} - Sum{below[i]};
    }
  }
  void set_corners(const Sample* south_below, const Sample* north_below, const Sample* south_above,
                   const Sample* north_above, Sum* __restrict corners, Sum* __restrict y,
                   Sum* __restrict z) const {
    for (std::size_t i = 0; i < count_; ++i) {
      const Sum a = south_below[i], b = north_below[i], c = south_above[i], d = north_above[i];
      corners[i] = (a + d) + (b + c);
      y[i] = (b - a) + (d - c);
      z[i] = (c - a) + (d - b);
    }
  }

  void along(const Weights& w, double* __restrict to) const {
    const Sample* const middle = middle_;
    const Sum *const first = at(kAcrossY), *const second = at(kAcrossZ), *const both = at(kCorners);
    for (std::size_t i = 1; i + 1 < count_; ++i) {
      const auto step = [i](const auto* v) { return static_cast<double>(Sum{v[i + 1]} - Sum{v[i - 1]}); };
      to[i] = (w.alone * step(middle) + w.with_both * step(both)) +
              (w.with_first * step(first) + w.with_second * step(second));
      if constexpr (!std::is_integral_v<Sample>) to[i] += Sum{middle[i]} - Sum{middle[i]};
    }
  }
  /// Adds the differences across a row; `with` has the steps with one along the third axis.
  void across(const Weights& w, const Sum* alone, const Sum* with, double* __restrict to) const {
    for (std::size_t i = 1; i + 1 < count_; ++i) {
      const auto sides = [i](const Sum* v) { return static_cast<double>(v[i - 1] + v[i + 1]); };
      to[i] = (w.alone * static_cast<double>(alone[i]) + w.with_both * sides(with)) +
              (w.with_first * sides(alone) + w.with_second * static_cast<double>(with[i]));
    }
  }

  std::size_t count_;
  std::vector<Sum> sums_;
  const Sample* middle_ = nullptr;
};

// The directions come in pairs that mirror each other, so that the matrix of the least squares is diagonal:
// each component is a weighted sum of differences.
PlaneGradients::PlaneGradients(const Vec3& spacing, std::size_t nx, std::size_t ny)
    : estimate_(spacing), nx_(nx), ny_(ny) {
  for (int axis = 0; axis < 3; ++axis) {
    const double h = spacing[axis], a = spacing[axis == 0 ? 1 : 0], b = spacing[axis == 2 ? 1 : 2];
    const double first = 1 / (1 + (a / h) * (a / h)), second = 1 / (1 + (b / h) * (b / h)),
                 both = 1 / (1 + ((a / h) * (a / h) + (b / h) * (b / h)));
    const double scale = 1 / (2 * h * (1 + 2 * (first + second) + 4 * both));
    weights_[static_cast<std::size_t>(axis)] = {scale, scale * first, scale * second, scale * both};
  }
}

template <class Sample>
Vec3 PlaneGradients::single(const std::array<const Sample*, 3>& planes, std::size_t i, std::size_t j) const {
  Neighbourhood values;
  values.fill(std::numeric_limits<double>::quiet_NaN());
  for (int dk = -1; dk <= 1; ++dk) {
    const Sample* const plane = planes[static_cast<std::size_t>(dk + 1)];
    if (plane == nullptr) continue;
    for (int dj = -1; dj <= 1; ++dj) {
      for (int di = -1; di <= 1; ++di) {
        // Indices before the first wrap to values beyond the last.
        const std::size_t x = i + static_cast<std::size_t>(di), y = j + static_cast<std::size_t>(dj);
        if (x < nx_ && y < ny_) values[neighbour(di, dj, dk)] = static_cast<double>(plane[y * nx_ + x]);
      }
    }
  }
  return estimate_(values);
}

template <class Sample>
void PlaneGradients::row(const std::array<const Sample*, 3>& planes, std::size_t j, RowSums<Sample>& sums,
                         Row& to) const {
  const bool inside = planes[0] != nullptr && planes[2] != nullptr && j > 0 && j + 1 < ny_;
  if (inside) {
    std::array<std::array<const Sample*, 3>, 3> rows;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t n = 0; n < 3; ++n) rows[k][n] = planes[k] + (j + n - 1) * nx_;
    }
    sums.set(rows);
    sums.components(weights_, to);
  }
  for (std::size_t i = 0; i < nx_; ++i) {
    if (inside && i > 0 && i + 1 < nx_ && std::isfinite(to.x[i] + to.y[i] + to.z[i])) continue;
    const Vec3 g = single(planes, i, j);
    to.x[i] = g.x, to.y[i] = g.y, to.z[i] = g.z;
  }
}

template <class Sample, class Store>
void PlaneGradients::for_each_row(const std::array<const Sample*, 3>& planes, Store&& store) const {
  constexpr std::size_t kSamples = std::size_t{1} << 14;
  parallel_chunks(ny_, 1 + kSamples / nx_, [&](std::size_t begin, std::size_t end) {
    RowSums<Sample> sums(nx_);
    const std::vector<double> zeros(nx_);
    Row components{zeros, zeros, zeros};
    for (std::size_t j = begin; j < end; ++j) {
      row(planes, j, sums, components);
      store(j, components);
    }
  });
}

template <class Sample>
void PlaneGradients::operator()(const std::array<const Sample*, 3>& planes,
                                std::span<Gradient> gradients) const {
  ADAMAS_ASSERT(planes[1] != nullptr && gradients.size() == nx_ * ny_);
  for_each_row(planes, [&](std::size_t j, const Row& row) {
    Gradient* const to = gradients.data() + j * nx_;
    for (std::size_t i = 0; i < nx_; ++i) {
      to[i] = {static_cast<float>(row.x[i]), static_cast<float>(row.y[i]), static_cast<float>(row.z[i])};
    }
  });
}

template <class Sample>
void PlaneGradients::operator()(const std::array<const Sample*, 3>& planes,
                                std::span<OctahedralCode> codes) const {
  ADAMAS_ASSERT(planes[1] != nullptr && codes.size() == nx_ * ny_);
  for_each_row(planes, [&](std::size_t j, const Row& row) {
    encode_octahedral(row.x, row.y, row.z, codes.subspan(j * nx_, nx_));
  });
}

template void PlaneGradients::operator()(const std::array<const std::uint8_t*, 3>&,
                                         std::span<Gradient>) const;
template void PlaneGradients::operator()(const std::array<const std::uint16_t*, 3>&,
                                         std::span<Gradient>) const;
template void PlaneGradients::operator()(const std::array<const std::int16_t*, 3>&,
                                         std::span<Gradient>) const;
template void PlaneGradients::operator()(const std::array<const float*, 3>&, std::span<Gradient>) const;
template void PlaneGradients::operator()(const std::array<const std::uint8_t*, 3>&,
                                         std::span<OctahedralCode>) const;
template void PlaneGradients::operator()(const std::array<const std::uint16_t*, 3>&,
                                         std::span<OctahedralCode>) const;
template void PlaneGradients::operator()(const std::array<const std::int16_t*, 3>&,
                                         std::span<OctahedralCode>) const;
template void PlaneGradients::operator()(const std::array<const float*, 3>&, std::span<OctahedralCode>) const;

}  // namespace adamas::isosurface
