#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "isosurface/gradients/gradient_estimator.h"

namespace adamas::isosurface {

/// The greatest component of a gradient: sums of 64 such gradients are finite.
inline constexpr float kGreatestGradient = 1e36F;

/// Options of GradientSmoother.
struct GradientSmoothingOptions {
  int free_rounds = 4;         ///< rounds of the first phase
  int constrained_rounds = 8;  ///< rounds of the second phase
  /// The distance that the second phase may move a gradient whose length is the root mean square: K of the
  /// paper, relative to the mean square. The limit of longer gradients is less, in inverse proportion.
  double freedom = 0.25;
  /// Number of rounds along time, over the steps of a series: so many in the middle of the second phase and
  /// again behind it; none without a second phase.
  int time_rounds = 1;

  /// Returns the number of rounds in space. A gradient depends only on those within this distance along each
  /// axis.
  [[nodiscard]] std::size_t rounds() const {
    return static_cast<std::size_t>(free_rounds) + static_cast<std::size_t>(constrained_rounds);
  }
  [[nodiscard]] bool is_along_time() const { return constrained_rounds > 0 && time_rounds > 0; }
  /// Returns the number of rounds in space before the first ones along time.
  [[nodiscard]] std::size_t rounds_before_time() const {
    const int half = constrained_rounds / 2;
    return static_cast<std::size_t>(free_rounds) + static_cast<std::size_t>(half > 0 ? half : 1);
  }
};

/// The mean square of a volume's gradients that are not zero. It determines which gradients are degenerate.
class GradientScale {
 public:
  /// Adds gradients, in the order of the samples, so that the sum is the same to the bit.
  void add(std::span<const Gradient> gradients);

  [[nodiscard]] double mean_square() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : 0; }
  /// Returns the greatest squared length of degenerate gradients, which is 1e-12 of the mean square.
  [[nodiscard]] double least_square() const { return 1e-12 * mean_square(); }

 private:
  double sum_ = 0;
  std::size_t count_ = 0;
};

inline double squared_length(const Gradient& g) {
  const double x = g[0], y = g[1], z = g[2];
  return x * x + y * y + z * z;
}

/// One round of smoothing (GradientSmoother), plane after plane of a block: gradients become averages over
/// the 27 round them, with weights 1, 2, 1 along each axis. It holds data of two planes, 44 bytes for each of
/// their gradients.
class SmoothingRound {
 public:
  /// Makes a round. Gradients and averages whose squared length is `least_square` or less are degenerate.
  SmoothingRound(double least_square, std::size_t ni, std::size_t nj);

  /// Takes the next plane of the round before. Unless it is the first, sets `result` to the plane before it,
  /// that is, to update(index, average), or to the old gradient where there is no average; and returns true.
  /// `plane` and `result` do not overlap.
  template <class Update>
  bool push(std::span<const Gradient> plane, std::span<Gradient> result, const Update& update);
  /// Sets `result` to the last plane.
  template <class Update>
  void finish(std::span<Gradient> result, const Update& update);

 private:
  /// A sum of gradients and of their weights.
  using Sum = std::array<float, 4>;
  using Sums = std::vector<Sum>;

  /// Returns (a + c) + 2 b, which is the same for a reflected block.
  static Sum blended(const Sum& a, const Sum& b, const Sum& c) {
    Sum result;
    for (std::size_t n = 0; n < 4; ++n) result[n] = (a[n] + c[n]) + 2 * b[n];
    return result;
  }
  /// Sums row j of a plane along i; zeros beyond the plane.
  void sum_row(std::span<const Gradient> plane, std::size_t j, Sums& sums) const;
  [[nodiscard]] std::size_t row_grain() const { return 1 + 8192 / ni_; }
  /// Returns the new gradient at `at` of the plane that is held, given the sums of the planes round it.
  template <class Update>
  [[nodiscard]] Gradient updated(std::size_t at, const Sum& after, const Update& update) const;

  double least_square_;
  std::size_t ni_, nj_;
  bool empty_ = true;
  Sums before_, here_;          ///< sums within the plane before the one that is held, and within that
  std::vector<Gradient> held_;  ///< the last plane that was pushed
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
    // The index before the first row wraps to one beyond the last, which has zeros too.
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

/// Moves g towards the average, as far as |g| |result - g| <= `most` allows.
Gradient constrained(const Gradient& g, const Gradient& average, double most);

/// The rounds of GradientSmoother, for a block whose planes come one after another: every round is one
/// plane behind the one before, so that only some planes are held.
class SmoothingRounds {
 public:
  /// Makes the rounds. `scale` is that of the whole volume. Planes have ni x nj gradients, i running fastest.
  SmoothingRounds(const GradientScale& scale, std::size_t ni, std::size_t nj,
                  const GradientSmoothingOptions& options);

  [[nodiscard]] std::size_t count() const { return rounds_.size(); }
  /// Notes which gradients of the block's next plane are degenerate, before it goes to the first round.
  void note(std::span<const Gradient> plane);
  /// Passes a plane, which has passed the rounds before, through the rounds from `first` to the one before
  /// `end`. `plane` is set to the result. Returns false where there is none yet.
  bool push(std::size_t first, std::size_t end, std::span<const Gradient>& plane);
  /// Makes the last plane of round n, when the rounds before have no more planes, and returns it.
  std::span<const Gradient> finish(std::size_t n);

  /// Returns the last result of round n; valid until another round has one.
  [[nodiscard]] std::span<Gradient> result(std::size_t n) { return results_[n % 2]; }
  /// Returns the anchors of the gradients of that plane, if round n is of the second phase: the results of
  /// the first phase, near which they stay; zero where they were degenerate at first, and have no anchor.
  [[nodiscard]] std::span<const Gradient> anchors(std::size_t n) const {
    return anchors_[(finished_[n] - 1) % anchors_.size()];
  }
  /// Returns the greatest squared length of a degenerate gradient.
  [[nodiscard]] double least_square() const { return least_square_; }
  /// Returns the greatest |g| |a - g| in the second phase.
  [[nodiscard]] double most() const { return most_; }

  /// Returns the number of bytes that smoothing takes for each gradient of a plane.
  static std::size_t bytes(const GradientSmoothingOptions& options);

 private:
  /// Calls fn(update) with the function by which round n updates gradients.
  template <class Fn>
  void with_update(std::size_t n, Fn&& fn);
  /// Keeps the results of the first phase of the next plane as anchors of the second.
  void keep_anchors(std::span<const Gradient> plane);

  GradientSmoothingOptions options_;
  double least_square_, most_;
  std::vector<SmoothingRound> rounds_;
  std::vector<std::size_t> finished_;             ///< number of planes that each round has handed over
  std::array<std::vector<Gradient>, 2> results_;  ///< results of rounds of even and of odd number
  std::size_t noted_ = 0, anchored_ = 0;          ///< numbers of planes
  /// Marks of the gradients that were degenerate at first, and the anchors. Plane k is at k modulo the number
  /// of planes.
  std::vector<std::vector<std::uint8_t>> degenerate_;
  std::vector<std::vector<Gradient>> anchors_;
};

/// Smooths a block of gradients that comes plane by plane (D 4.3.3). A gradient is degenerate where it is
/// zero or shorter than 1e-6 of the root mean square of all that are not zero; an average of that length is
/// not used, and the gradient stays. The average is over the 27 gradients round a sample, with the weights 1,
/// 2, 1 along each axis, without those that are degenerate or beyond the block.
///
/// In the first phase every gradient becomes the average, so that degenerate regions are filled from their
/// borders by one sample per round. In the second, those that were not degenerate at first stay near their
/// result of the first phase, g: with the average a, they become g + (a - g) min(1, K / (|g| |a - g|)); the
/// others become the average as before. All samples of a round see the round before; the result is the same
/// on any number of threads.
class GradientSmoother {
 public:
  /// A function that receives smoothed planes, in ascending order.
  using Sink = std::function<void(std::span<const Gradient>)>;

  /// Makes a smoother. `scale` is that of the whole volume. Planes have ni x nj gradients, i running fastest.
  GradientSmoother(const GradientScale& scale, std::size_t ni, std::size_t nj,
                   const GradientSmoothingOptions& options, Sink sink)
      : rounds_(scale, ni, nj, options), sink_(std::move(sink)) {}

  /// Adds the next plane, of finite gradients.
  void add(std::span<const Gradient> plane);
  /// Hands over the planes that are left.
  void finish();

 private:
  /// Passes a plane through the rounds from `first` on, as far as possible.
  void run(std::size_t first, std::span<const Gradient> plane) {
    if (rounds_.push(first, rounds_.count(), plane)) sink_(plane);
  }

  SmoothingRounds rounds_;
  Sink sink_;
  bool empty_ = true;
};

}  // namespace adamas::isosurface
