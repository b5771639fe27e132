#pragma once

#include <span>

#include "isosurface/gradients/gradient_estimator.h"

namespace adamas::isosurface {

/// The gradients of one step of a series at some places, the same ones as of the other steps.
struct StepGradients {
  std::span<Gradient> gradients;
  /// What holds them (SmoothingRounds::anchors); zero where nothing does.
  std::span<const Gradient> anchors;
  double least_square = 0;  ///< up to this square of the length they are degenerate
  double most = 0;          ///< what |g| |a - g| may be, g being what holds one
};

/// Smooths the gradients of each place along time, in place (D 5.3.1). First, those that are degenerate take
/// the one of the nearest step before that is not or, where there is none, of the nearest step behind. Then
/// in every round each becomes the average with those of the steps before and behind, with the weights 1, 2,
/// 1, held as in the second phase of smooth_gradients; beyond the first and the last step the gradient itself
/// counts. Places of which no step has a gradient stay. What is the same in all steps stays to the bit. The
/// result is the same on any number of threads.
void smooth_in_time(std::span<const StepGradients> steps, int rounds);

}  // namespace adamas::isosurface
