#pragma once

#include <Eigen/Core>

namespace adamas::interfaces {

/// Adds weight * terms * terms^T to the lower triangle of the first kUsed rows and columns of a matrix; the
/// other triangle is undefined afterwards. The products and sums are those of Eigen's rank update, of which
/// this costs a fraction for small matrices.
template <int kUsed, int kSize>
inline void add_square(Eigen::Matrix<double, kSize, kSize>& sums,
                       const Eigen::Matrix<double, kSize, 1>& terms, double weight) {
  static_assert(kUsed <= kSize && kUsed % 2 == 0);
  for (int j = 0; j < kUsed; ++j) {
    const double by = weight * terms[j];
    // Columns begin at an even row, so that two rows are computed at a time.
    for (int i = j & ~1; i < kUsed; ++i) sums(i, j) += by * terms[i];
  }
}

}  // namespace adamas::interfaces
