#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "isosurface/gradients/gradient_estimator.h"
#include "isosurface/gradients/smoothing_rounds.h"

namespace adamas::isosurface {

/// Smooths a block of gradients that comes plane by plane, as smooth_gradients does, to the bit.
class GradientSmoother {
 public:
  /// Takes smoothed planes, in ascending order.
  using Sink = std::function<void(std::span<const Gradient>)>;

  /// `scale`: of the whole volume. Planes have ni x nj gradients, i running fastest.
  GradientSmoother(const GradientScale& scale, std::size_t ni, std::size_t nj,
                   const GradientSmoothingOptions& options, Sink sink)
      : rounds_(scale, ni, nj, options), sink_(std::move(sink)) {}

  /// Takes the next plane, of finite gradients.
  void add(std::span<const Gradient> plane);
  /// Hands over the planes that are left.
  void finish();

 private:
  /// Takes a plane through the rounds from `first` on, as far as it gets.
  void run(std::size_t first, std::span<const Gradient> plane) {
    if (rounds_.push(first, rounds_.count(), plane)) sink_(plane);
  }

  SmoothingRounds rounds_;
  Sink sink_;
  bool empty_ = true;
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

}  // namespace adamas::isosurface
