#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "isosurface/gradients/gradient_estimator.h"
#include "isosurface/gradients/gradient_smoothing.h"

namespace adamas::timevarying {

/// The gradients of one step of a series at some places, which are the same for all steps.
struct StepGradients {
  std::span<isosurface::Gradient> gradients;
  /// The anchors of the gradients (SmoothingRounds::anchors); zero where a gradient has none.
  std::span<const isosurface::Gradient> anchors;
  double least_square = 0;  ///< the greatest square of the length of a degenerate gradient
  double most = 0;          ///< the greatest |g| |a - g|, where g is the anchor of a gradient a
};

/// Smooths the gradients of each place along time, in place (D 5.3.1). First, each degenerate gradient
/// becomes that of the nearest step before that is not degenerate or, where there is none, of the nearest
/// step behind. Then in every round each becomes the average with those of the steps before and behind, with
/// the weights 1, 2, 1, and stays near its anchor as in the second phase of GradientSmoother; beyond the
/// first and the last step the gradient itself counts. Places of which no step has a gradient stay. What is
/// the same in all steps stays to the bit. The result is the same on any number of threads.
void smooth_in_time(std::span<const StepGradients> steps, int rounds);

/// Smooths the gradients of the steps of a series, whose planes come one after another, that of the first
/// step, that of the second and so on, then the next plane of each. Every step goes through the rounds of
/// GradientSmoother; in the middle of the second phase and behind it, all steps are smoothed along time
/// (smooth_in_time), so that the one goes on from what the other has made, as D 5.3.1 repeats both.
class SeriesSmoother {
 public:
  /// Takes the smoothed planes of all steps, in ascending order of planes.
  using Sink = std::function<void(std::span<const std::span<const isosurface::Gradient>>)>;

  /// `scales` has the scale of each step's whole volume. The options must be along time (is_along_time).
  SeriesSmoother(std::span<const isosurface::GradientScale> scales, std::size_t ni, std::size_t nj,
                 const isosurface::GradientSmoothingOptions& options, Sink sink);

  /// Takes the next plane of the next step, with finite gradients.
  void add(std::span<const isosurface::Gradient> plane);
  /// Passes on the remaining planes.
  void finish();

 private:
  /// Passes a plane of each step, which is a result of the round before `first`, through as many rounds as
  /// possible.
  void run(std::size_t first);
  /// Passes these planes through the rounds from `first` to the one before `end`. Returns whether they have
  /// all been completed.
  bool push(std::size_t first, std::size_t end);
  /// Smooths the results of a round along time.
  void smooth_steps(std::size_t round);
  void hand_over(std::size_t round);

  isosurface::GradientSmoothingOptions options_;
  Sink sink_;
  std::vector<isosurface::SmoothingRounds> steps_;
  std::size_t next_ = 0;  ///< the step of the next plane
  bool empty_ = true;
};

}  // namespace adamas::timevarying
