#include "isosurface/preprocessing/tetrahedron_samples.h"

#include <numeric>

#include "core/base/assert.h"

namespace adamas {

namespace {

/// Of a positive divisor.
std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

}  // namespace

TetrahedronRows::TetrahedronRows(const Corners& corners) : low_(corners[0]), high_(corners[0]) {
  for (const LatticePoint p : corners) {
    for (int axis = 0; axis < 3; ++axis) {
      low_[axis] = std::min(low_[axis], p[axis]);
      high_[axis] = std::max(high_[axis], p[axis]);
    }
  }
  for (std::size_t m = 0; m < 4; ++m) {
    const LatticePoint on = corners[(m + 1) % 4];
    const LatticePoint a = corners[(m + 2) % 4] - on, b = corners[(m + 3) % 4] - on;
    const auto minor = [&](int x, int y) { return std::int64_t{a[x]} * b[y] - std::int64_t{a[y]} * b[x]; };
    std::int64_t i = minor(1, 2), j = minor(2, 0), k = minor(0, 1);
    const std::int64_t common = std::gcd(std::gcd(i, j), k);
    ADAMAS_ASSERT(common > 0);
    i /= common, j /= common, k /= common;
    const LatticePoint up = corners[m] - on;
    std::int64_t height = i * up.i + j * up.j + k * up.k;
    ADAMAS_ASSERT(height != 0);
    if (height < 0) i = -i, j = -j, k = -k, height = -height;
    faces_[m] = {i, j, k, -(i * on.i + j * on.j + k * on.k), height};
  }
}

TetrahedronRows::Row TetrahedronRows::row(std::int32_t j, std::int32_t k, std::int32_t begin,
                                          std::int32_t end) const {
  std::int64_t low = begin, high = std::int64_t{end} - 1;
  for (const Face& face : faces_) {
    const std::int64_t rest = face.at(0, j, k);
    if (face.i > 0) {
      low = std::max(low, -floor_divide(rest, face.i));
    } else if (face.i < 0) {
      high = std::min(high, floor_divide(rest, -face.i));
    } else if (rest < 0) {
      return {begin, begin};
    }
  }
  return {static_cast<std::int32_t>(low), static_cast<std::int32_t>(std::max(low, high + 1))};
}

}  // namespace adamas
