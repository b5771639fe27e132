#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "isosurface/gradients/gradient_estimator.h"

namespace adamas {

struct GradientSmoothingOptions {
  int free_rounds = 4;         ///< of the first phase
  int constrained_rounds = 8;  ///< of the second
  /// How far the second phase may take a gradient whose length is the root mean square: K of the paper, as a
  /// part of the mean square. Longer ones may go less far, in inverse proportion.
  double freedom = 0.25;
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
