#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "isosurface/gradients/gradient_estimator.h"

namespace adamas::isosurface {

/// The mean square of a volume's gradients that are not zero, and which of them are degenerate by it.
class GradientScale {
 public:
  /// Gradients are added in the order of the samples, for the same sum to the bit.
  void add(std::span<const Gradient> gradients);

  [[nodiscard]] double mean_square() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : 0; }
  /// Gradients are degenerate up to this square of the length, which is 1e-12 of the mean square.
  [[nodiscard]] double least_square() const { return 1e-12 * mean_square(); }

 private:
  double sum_ = 0;
  std::size_t count_ = 0;
};

inline double squared_length(const Gradient& g) {
  const double x = g[0], y = g[1], z = g[2];
  return x * x + y * y + z * z;
}

/// One round of smoothing (smooth_gradients), plane after plane of a block: gradients become averages over
/// the 27 round them, with weights 1, 2, 1 along each axis. It holds what it needs of two planes, 44 bytes
/// for each of their gradients.
class SmoothingRound {
 public:
  /// Gradients and averages whose squared length is `least_square` or less are degenerate.
  SmoothingRound(double least_square, std::size_t ni, std::size_t nj);

  /// Takes the next plane of the round before. Unless it is the first, sets `result` to the plane before it:
  /// to update(index, average), or to what was there where there is no average; and returns true. `plane` and
  /// `result` do not overlap.
  template <class Update>
  bool push(std::span<const Gradient> plane, std::span<Gradient> result, const Update& update);
  /// Sets `result` to the last plane.
  template <class Update>
  void finish(std::span<Gradient> result, const Update& update);

 private:
  /// A sum of gradients and of their weights.
  using Sum = std::array<float, 4>;
  using Sums = std::vector<Sum>;

  /// (a + c) + 2 b, which is the same for a reflected block.
  static Sum blended(const Sum& a, const Sum& b, const Sum& c) {
    Sum result;
    for (std::size_t n = 0; n < 4; ++n) result[n] = (a[n] + c[n]) + 2 * b[n];
    return result;
  }
  /// Sums along i of row j of a plane; zeros beyond it.
  void sum_row(std::span<const Gradient> plane, std::size_t j, Sums& sums) const;
  [[nodiscard]] std::size_t row_grain() const { return 1 + 8192 / ni_; }
  /// The gradient at `at` of the plane that is held, with the sums of the planes round it.
  template <class Update>
  [[nodiscard]] Gradient updated(std::size_t at, const Sum& after, const Update& update) const;

  double least_square_;
  std::size_t ni_, nj_;
  bool empty_ = true;
  Sums before_, here_;          ///< sums within the plane before the one that is held, and within that
  std::vector<Gradient> held_;  ///< the plane that was pushed last
};

template <class Update>
Gradient SmoothingRound::updated(std::size_t at, const Sum& after, const Update& update) const {
  const Sum sum = blended(before_[at], here_[at], after);
  if (sum[3] == 0) return held_[at];
  const Gradient average{sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]};
  return squared_length(average) > least_square_ ? update(at, average) : held_[at];
}

template <class Update>
bool SmoothingRound::push(std::span<const Gradient> plane, std::span<Gradient> result, const Update& update) {
  const bool has_result = !std::exchange(empty_, false);
  parallel_chunks(nj_, row_grain(), [&](std::size_t begin, std::size_t end) {
    std::array<Sums, 3> rows;  // row j lies at j % 3
    for (Sums& row : rows) row.resize(ni_);
    // Before the first row the index wraps to one beyond the last, which has zeros too.
    if (begin > 0) sum_row(plane, begin - 1, rows[(begin - 1) % 3]);
    sum_row(plane, begin, rows[begin % 3]);
    for (std::size_t j = begin; j < end; ++j) {
      sum_row(plane, j + 1, rows[(j + 1) % 3]);
      const Sums &south = rows[(j + 2) % 3], &middle = rows[j % 3], &north = rows[(j + 1) % 3];
      for (std::size_t i = 0; i < ni_; ++i) {
        const std::size_t at = j * ni_ + i;
        const Sum after = blended(south[i], middle[i], north[i]);
        if (has_result) result[at] = updated(at, after, update);
        before_[at] = after;
        held_[at] = plane[at];
      }
    }
  });
  before_.swap(here_);
  return has_result;
}

template <class Update>
void SmoothingRound::finish(std::span<Gradient> result, const Update& update) {
  parallel_for(nj_, row_grain(), [&](std::size_t j) {
    for (std::size_t at = j * ni_; at < (j + 1) * ni_; ++at) result[at] = updated(at, Sum{}, update);
  });
}

}  // namespace adamas::isosurface
