#include "core/geometry/tetrahedron.h"

namespace adamas {

ClippedTriangle::ClippedTriangle(const Tetrahedron& cell, const Vec3& a, const Vec3& b, const Vec3& c) {
  // A corner this little outside counts as inside, so that a triangle in a face is in both cells.
  constexpr double kSlack = 1e-12;
  corners_[0] = cell.weights(a);
  corners_[1] = cell.weights(b);
  corners_[2] = cell.weights(c);
  for (std::size_t i = 0; i < 4; ++i) {
    if (corners_[0][i] < -kSlack && corners_[1][i] < -kSlack && corners_[2][i] < -kSlack) return;
  }
  size_ = 3;
  for (std::size_t face = 0; face < 4; ++face) {
    std::array<Weights, 8> kept;
    std::size_t count = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const Weights &p = corners_[i], &q = corners_[i + 1 == size_ ? 0 : i + 1];
      const bool p_in = p[face] >= -kSlack, q_in = q[face] >= -kSlack;
      if (p_in) kept[count++] = p;
      if (p_in == q_in) continue;
      const double t = p[face] / (p[face] - q[face]);
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
