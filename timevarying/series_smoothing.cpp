#include "timevarying/series_smoothing.h"

#include <utility>

#include "core/base/assert.h"
#include "core/base/parallel.h"

namespace adamas::timevarying {

using namespace isosurface;

namespace {

/// The gradients of all steps at one place.
class TimeLine {
 public:
  explicit TimeLine(std::span<const StepGradients> steps)
      : steps_(steps), now_(steps.size()), next_(steps.size()) {}

  void smooth(std::size_t at, int rounds) {
    for (std::size_t t = 0; t < steps_.size(); ++t) now_[t] = steps_[t].gradients[at];
    seed();
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t t = 0; t < steps_.size(); ++t) next_[t] = updated(t, at);
      now_.swap(next_);
    }
    for (std::size_t t = 0; t < steps_.size(); ++t) steps_[t].gradients[at] = now_[t];
  }

 private:
  [[nodiscard]] bool is_degenerate(std::size_t t, const Gradient& g) const {
    return !(squared_length(g) > steps_[t].least_square);
  }

  void seed() {
    const std::size_t count = steps_.size();
    std::size_t first = count;
    for (std::size_t t = 0; t < count; ++t) {
      if (!is_degenerate(t, now_[t])) {
        first = t < first ? t : first;
      } else if (first < t) {
        now_[t] = now_[t - 1];
      }
    }
    for (std::size_t t = 0; first < count && t < first; ++t) now_[t] = now_[first];
  }

  [[nodiscard]] Gradient updated(std::size_t t, std::size_t at) const {
    const Gradient& here = now_[t];
    const Gradient& before = t > 0 ? now_[t - 1] : here;
    const Gradient& behind = t + 1 < now_.size() ? now_[t + 1] : here;
    Gradient average;
    for (std::size_t n = 0; n < 3; ++n) average[n] = ((before[n] + behind[n]) + 2 * here[n]) / 4;
    if (average == here || is_degenerate(t, average)) return here;
    const Gradient& anchor = steps_[t].anchors[at];
    return squared_length(anchor) > 0 ? constrained(anchor, average, steps_[t].most) : average;
  }

  std::span<const StepGradients> steps_;
  std::vector<Gradient> now_, next_;
};

}  // namespace

void smooth_in_time(std::span<const StepGradients> steps, int rounds) {
  if (steps.size() < 2) return;
  parallel_chunks(steps.front().gradients.size(), std::size_t{1} << 12,
                  [&](std::size_t begin, std::size_t end) {
                    TimeLine line(steps);
                    for (std::size_t at = begin; at < end; ++at) line.smooth(at, rounds);
                  });
}

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

}  // namespace adamas::timevarying
