#include "core/geometry/tetrahedron.h"

#include "core/base/assert.h"

namespace adamas::inline core {

namespace {

std::array<Weights, 3> weights(const Tetrahedron& cell, const Vec3& a, const Vec3& b, const Vec3& c) {
  return {cell.weights(a), cell.weights(b), cell.weights(c)};
}

bool separated(double slack, const std::array<Weights, 3>& corners) {
  for (std::size_t face = 0; face < 4; ++face) {
    if (corners[0][face] < -slack && corners[1][face] < -slack && corners[2][face] < -slack) return true;
  }
  return false;
}

}  // namespace

bool meets(const Tetrahedron& cell, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto corners = weights(cell, a, b, c);
  for (const Weights& w : corners) {
    if (std::min({w[0], w[1], w[2], w[3]}) >= -cell.slack) return true;
  }
  return !ClippedTriangle(cell.slack, corners).empty();
}

ClippedTriangle::ClippedTriangle(const Tetrahedron& cell, const Vec3& a, const Vec3& b, const Vec3& c)
    : ClippedTriangle(cell.slack, weights(cell, a, b, c)) {}

ClippedTriangle::ClippedTriangle(double slack, const std::array<Weights, 3>& corners) {
  if (separated(slack, corners)) return;
  std::copy(corners.begin(), corners.end(), corners_.begin());
  size_ = 3;
  for (std::size_t face = 0; face < 4; ++face) {
    std::array<Weights, 8> kept;
    std::size_t count = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const Weights &p = corners_[i], &q = corners_[i + 1 == size_ ? 0 : i + 1];
      const bool p_in = p[face] >= -slack, q_in = q[face] >= -slack;
      if (p_in) {
        ADAMAS_ASSERT(count < kept.size());
        kept[count++] = p;
      }
      if (p_in == q_in) continue;
      // Within the slack both points may lie on one side of the face.
      const double t = std::clamp(p[face] / (p[face] - q[face]), 0.0, 1.0);
      ADAMAS_ASSERT(count < kept.size());
      Weights& w = kept[count++];
      for (std::size_t j = 0; j < 4; ++j) w[j] = (1 - t) * p[j] + t * q[j];
      w[face] = 0;
    }
    corners_ = kept;
    size_ = count;
    if (size_ == 0) return;
  }
}

}  // namespace adamas::inline core
