#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "isosurface/gradients/gradient_estimator.h"
#include "isosurface/gradients/smoothing_round.h"

namespace adamas {

struct GradientSmoothingOptions {
  int free_rounds = 4;         ///< of the first phase
  int constrained_rounds = 8;  ///< of the second
  /// How far the second phase may take a gradient whose length is the root mean square: K of the paper, as a
  /// part of the mean square. Longer ones may go less far, in inverse proportion.
  double freedom = 0.25;

  /// A gradient depends on none that is farther away than this along an axis.
  [[nodiscard]] std::size_t rounds() const {
    return static_cast<std::size_t>(free_rounds) + static_cast<std::size_t>(constrained_rounds);
  }
};

/// Smooths a block of gradients that comes plane by plane, as smooth_gradients does, to the bit: every round
/// is one plane behind the one before, so that no more than some planes are held.
class GradientSmoother {
 public:
  /// Takes smoothed planes, in ascending order.
  using Sink = std::function<void(std::span<const Gradient>)>;

  /// `scale`: of the whole volume. Planes have ni x nj gradients, i running fastest.
  GradientSmoother(const GradientScale& scale, std::size_t ni, std::size_t nj,
                   const GradientSmoothingOptions& options, Sink sink);

  /// Takes the next plane, of finite gradients.
  void add(std::span<const Gradient> plane);
  /// Hands over the planes that are left.
  void finish();

  /// Bytes that it takes for each gradient of a plane.
  static std::size_t bytes(const GradientSmoothingOptions& options);

 private:
  /// Takes a plane through the rounds from `first` on, as far as it gets.
  void run(std::size_t first, std::span<const Gradient> plane);
  /// Calls fn(update) with what round n makes of averages.
  template <class Fn>
  void with_update(std::size_t n, Fn&& fn);
  /// Keeps what the first phase has made of the next plane, for the second.
  void keep_anchors(std::span<const Gradient> plane);

  GradientSmoothingOptions options_;
  double least_square_, most_;  ///< `most_`: what |g| |a - g| may be in the second phase
  Sink sink_;
  std::vector<SmoothingRound> rounds_;
  std::vector<std::size_t> finished_;             ///< how many planes each round has handed over
  std::array<std::vector<Gradient>, 2> results_;  ///< of rounds of even and of odd number
  std::size_t added_ = 0, anchored_ = 0;          ///< planes
  /// Whether gradients were degenerate at first, and what holds them in the second phase: zero where they
  /// were, and nothing does. Plane k is at k modulo the number of planes.
  std::vector<std::vector<std::uint8_t>> degenerate_;
  std::vector<std::vector<Gradient>> anchors_;
};

/// Smooths the gradients of a block of samples, i running fastest, in place (D 4.3.3). A gradient is
/// degenerate where it is zero or shorter than 1e-6 of the root mean square of all that are not zero; an
/// average of that length is not used, and the gradient stays. The average is over the 27 gradients round a
/// sample, with the weights 1, 2, 1 along each axis, without those that are degenerate or beyond the block.
///
/// In the first phase every gradient becomes the average, so that degenerate regions are filled from their
/// borders by one sample a round. In the second, those that were not degenerate at first stay near what the
/// first phase made of them, g: with the average a, they become g + (a - g) min(1, K / (|g| |a - g|)); the
/// others go on as before. All samples of a round see the round before; the result is the same on any number
/// of threads.
///
/// `gradients`: finite, dimensions[0] x dimensions[1] x dimensions[2] of them. Returns how many are
/// degenerate still.
std::size_t smooth_gradients(std::span<Gradient> gradients, const std::array<std::size_t, 3>& dimensions,
                             const GradientSmoothingOptions& options = {},
                             Progress& progress = SilentProgress::instance());

}  // namespace adamas
