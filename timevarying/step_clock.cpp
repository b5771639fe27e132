#include "timevarying/step_clock.h"

#include <algorithm>

namespace adamas::timevarying {

std::optional<StepClock::Place> StepClock::after(Place place) const {
  const std::uint32_t last = steps_ - 1;
  const bool is_end = place.is_backward ? place.step == 0 : place.step >= last;
  if (is_end) {
    if (pace_.repeat == Repeat::kOnce) return std::nullopt;
    if (pace_.repeat == Repeat::kLoop) return Place{place.is_backward ? last : 0, place.is_backward};
    if (last == 0) return place;
    place.is_backward = !place.is_backward;
  }
  return Place{place.is_backward ? place.step - 1 : place.step + 1, place.is_backward};
}

std::uint32_t StepClock::play(std::uint32_t shown) {
  is_playing_ = true;
  shown_for_ = 0;
  if (after({shown, pace_.is_backward})) return shown;
  return pace_.is_backward ? steps_ - 1 : 0;
}

std::uint32_t StepClock::advance(std::uint32_t shown, double seconds, bool is_ready) {
  if (!is_playing_) return shown;
  shown_for_ += seconds;
  const double time = 1 / pace_.steps_per_second;
  if (shown_for_ < time || (!is_ready && shown_for_ < time + pace_.patience)) return shown;
  const std::optional<Place> next = after({shown, pace_.is_backward});
  if (!next) {
    is_playing_ = false;
    return shown;
  }
  // After a late step the next ones are not played faster.
  shown_for_ = shown_for_ < 2 * time ? shown_for_ - time : 0;
  pace_.is_backward = next->is_backward;
  return next->step;
}

std::vector<std::uint32_t> StepClock::following(std::uint32_t step, std::size_t most) const {
  std::vector<std::uint32_t> steps;
  std::optional<Place> place = Place{step, pace_.is_backward};
  for (std::size_t n = 0; n < most; ++n) {
    place = after(*place);
    if (!place) break;
    const bool is_known = place->step == step || std::ranges::find(steps, place->step) != steps.end();
    if (!is_known) steps.push_back(place->step);
  }
  return steps;
}

}  // namespace adamas::timevarying
