#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "isosurface/gradients/smoothing_rounds.h"

namespace adamas::isosurface {

/// Smooths the gradients of the steps of a series, whose planes come one after another, that of the first
/// step, that of the second and so on, then the next plane of each. Every step goes through the rounds of
/// smooth_gradients; in the middle of the second phase and behind it, all steps are smoothed along time
/// (smooth_in_time), so that the one goes on from what the other has made, as D 5.3.1 repeats both.
class SeriesSmoother {
 public:
  /// Takes the smoothed planes of all steps, in ascending order of planes.
  using Sink = std::function<void(std::span<const std::span<const Gradient>>)>;

  /// `scales`: of each step, of the whole volume. The options are along time.
  SeriesSmoother(std::span<const GradientScale> scales, std::size_t ni, std::size_t nj,
                 const GradientSmoothingOptions& options, Sink sink);

  /// Takes the next plane of the next step, of finite gradients.
  void add(std::span<const Gradient> plane);
  /// Hands over the planes that are left.
  void finish();

 private:
  /// Takes a plane of each step, which has come out of the round before `first`, as far as it gets.
  void run(std::size_t first);
  /// The same through the rounds up to `end` alone. Returns whether it has got there.
  bool push(std::size_t first, std::size_t end);
  /// Smooths along time what has come out of a round.
  void smooth_steps(std::size_t round);
  void hand_over(std::size_t round);

  GradientSmoothingOptions options_;
  Sink sink_;
  std::vector<SmoothingRounds> steps_;
  std::size_t next_ = 0;  ///< the step whose plane comes next
  bool empty_ = true;
};

}  // namespace adamas::isosurface
