#include "isosurface/gradients/time_smoothing.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "isosurface/gradients/smoothing_rounds.h"

namespace adamas::isosurface {

namespace {

/// The gradients of one place, of all steps.
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

}  // namespace adamas::isosurface
