#include "isosurface/gradients/series_smoothing.h"

#include <utility>

#include "core/base/assert.h"
#include "isosurface/gradients/time_smoothing.h"

namespace adamas::isosurface {

SeriesSmoother::SeriesSmoother(std::span<const GradientScale> scales, std::size_t ni, std::size_t nj,
                               const GradientSmoothingOptions& options, Sink sink)
    : options_(options), sink_(std::move(sink)) {
  ADAMAS_ASSERT(options.is_along_time());
  for (const GradientScale& scale : scales) steps_.emplace_back(scale, ni, nj, options);
}

void SeriesSmoother::add(std::span<const Gradient> plane) {
  empty_ = false;
  SmoothingRounds& step = steps_[next_++];
  step.note(plane);
  const bool got_there = step.push(0, options_.rounds_before_time(), plane);
  if (next_ < steps_.size()) return;
  next_ = 0;
  if (got_there) run(options_.rounds_before_time());
}

void SeriesSmoother::finish() {
  if (empty_) return;
  for (std::size_t n = 0; n < options_.rounds(); ++n) {
    for (SmoothingRounds& step : steps_) step.finish(n);
    run(n + 1);
  }
}

void SeriesSmoother::run(std::size_t first) {
  const std::size_t middle = options_.rounds_before_time(), end = options_.rounds();
  if (first <= middle) {
    if (!push(first, middle)) return;
    smooth_steps(middle - 1);
    if (middle == end) return hand_over(end - 1);
    first = middle;
  }
  if (!push(first, end)) return;
  smooth_steps(end - 1);
  hand_over(end - 1);
}

bool SeriesSmoother::push(std::size_t first, std::size_t end) {
  bool got_there = true;
  for (SmoothingRounds& step : steps_) {
    std::span<const Gradient> plane = step.result(first - 1);
    got_there = step.push(first, end, plane);
  }
  return got_there;
}

void SeriesSmoother::smooth_steps(std::size_t round) {
  std::vector<StepGradients> planes;
  for (SmoothingRounds& step : steps_)
    planes.push_back({step.result(round), step.anchors(round), step.least_square(), step.most()});
  smooth_in_time(planes, options_.time_rounds);
}

void SeriesSmoother::hand_over(std::size_t round) {
  std::vector<std::span<const Gradient>> planes;
  for (SmoothingRounds& step : steps_) planes.emplace_back(step.result(round));
  sink_(planes);
}

}  // namespace adamas::isosurface
