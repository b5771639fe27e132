#include "core/geometry/tetrahedron.h"

#include "core/base/assert.h"

namespace adamas {

ClippedTriangle::ClippedTriangle(const Tetrahedron& cell, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double slack = cell.slack;
  corners_[0] = cell.weights(a);
  corners_[1] = cell.weights(b);
  corners_[2] = cell.weights(c);
  for (std::size_t i = 0; i < 4; ++i) {
    if (corners_[0][i] < -slack && corners_[1][i] < -slack && corners_[2][i] < -slack) return;
  }
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
      // Within the slack both may lie on one side of the face.
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

}  // namespace adamas
