#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "isosurface/gradients/gradient_estimator.h"
#include "isosurface/gradients/smoothing_round.h"

namespace adamas::isosurface {

/// Components count as this at most: sums of 64 gradients of this length are finite.
inline constexpr float kGreatestGradient = 1e36F;

struct GradientSmoothingOptions {
  int free_rounds = 4;         ///< of the first phase
  int constrained_rounds = 8;  ///< of the second
  /// How far the second phase may take a gradient whose length is the root mean square: K of the paper, as a
  /// part of the mean square. Longer ones may go less far, in inverse proportion.
  double freedom = 0.25;
  /// Of the steps of a series: rounds along time in the middle of the second phase and again behind it; none
  /// without a second phase.
  int time_rounds = 1;

  /// A gradient depends on none that is farther away than this along an axis.
  [[nodiscard]] std::size_t rounds() const {
    return static_cast<std::size_t>(free_rounds) + static_cast<std::size_t>(constrained_rounds);
  }
  [[nodiscard]] bool is_along_time() const { return constrained_rounds > 0 && time_rounds > 0; }
  /// The rounds in space before those along time come for the first time.
  [[nodiscard]] std::size_t rounds_before_time() const {
    const int half = constrained_rounds / 2;
    return static_cast<std::size_t>(free_rounds) + static_cast<std::size_t>(half > 0 ? half : 1);
  }
};

/// As near to the average as the freedom `most` |g| |average - g| allows.
Gradient constrained(const Gradient& g, const Gradient& average, double most);

/// The rounds that smooth_gradients consists of, for a block whose planes come one after another: every round
/// is one plane behind the one before, so that no more than some planes are held.
class SmoothingRounds {
 public:
  /// `scale`: of the whole volume. Planes have ni x nj gradients, i running fastest.
  SmoothingRounds(const GradientScale& scale, std::size_t ni, std::size_t nj,
                  const GradientSmoothingOptions& options);

  [[nodiscard]] std::size_t count() const { return rounds_.size(); }
  /// Notes which gradients of the block's next plane are degenerate, before it goes to the first round.
  void note(std::span<const Gradient> plane);
  /// Takes a plane through the rounds from `first` to the one before `end`; it has come through those before.
  /// `plane` is then what comes out. Returns false where nothing does yet.
  bool push(std::size_t first, std::size_t end, std::span<const Gradient>& plane);
  /// The last plane of round n, which every round gets when the ones before have none any more.
  std::span<const Gradient> finish(std::size_t n);

  /// The plane that came out of round n last; valid until another round has one.
  [[nodiscard]] std::span<Gradient> result(std::size_t n) { return results_[n % 2]; }
  /// What holds the gradients of that plane in the second phase, of whose rounds n is one: zero where they
  /// were degenerate at first, and nothing does.
  [[nodiscard]] std::span<const Gradient> anchors(std::size_t n) const {
    return anchors_[(finished_[n] - 1) % anchors_.size()];
  }
  /// Gradients up to this square of the length are degenerate.
  [[nodiscard]] double least_square() const { return least_square_; }
  /// What |g| |a - g| may be in the second phase.
  [[nodiscard]] double most() const { return most_; }

  /// Bytes that it takes for each gradient of a plane.
  static std::size_t bytes(const GradientSmoothingOptions& options);

 private:
  /// Calls fn(update) with what round n makes of averages.
  template <class Fn>
  void with_update(std::size_t n, Fn&& fn);
  /// Keeps what the first phase has made of the next plane, for the second.
  void keep_anchors(std::span<const Gradient> plane);

  GradientSmoothingOptions options_;
  double least_square_, most_;
  std::vector<SmoothingRound> rounds_;
  std::vector<std::size_t> finished_;             ///< how many planes each round has handed over
  std::array<std::vector<Gradient>, 2> results_;  ///< of rounds of even and of odd number
  std::size_t noted_ = 0, anchored_ = 0;          ///< planes
  /// Whether gradients were degenerate at first, and what holds them. Plane k is at k modulo the number of
  /// planes.
  std::vector<std::vector<std::uint8_t>> degenerate_;
  std::vector<std::vector<Gradient>> anchors_;
};

}  // namespace adamas::isosurface
