#include "viewer/contents/frame_budget.h"

#include <algorithm>

namespace adamas::viewer {

void FrameBudget::begin(double seconds, std::uint64_t most, bool is_same_view) {
  if (!is_same_view || seconds != wanted_) allowed_ = seconds;
  wanted_ = seconds;
  most_ = most;
  is_same_view_ = is_same_view;
}

std::uint64_t FrameBudget::triangles() const {
  return wanted_ > 0 ? std::min(most_, std::max(affordable_, kLeast)) : most_;
}

void FrameBudget::note(double seconds, bool is_stopped) {
  const std::uint64_t had = triangles();
  is_whole_ = !is_stopped && had == most_;
  if (!(wanted_ > 0)) return;
  if (is_stopped) {
    // A view at rest has time: the frame gets more until it is complete.
    allowed_ *= 2;
    if (!is_same_view_) affordable_ = had / 2;
    return;
  }
  // The next view is similar, but may be a little more expensive. A view at rest comes to an end.
  constexpr double kPart = 0.8, kMost = 2, kLeastGrowth = 1.25;
  const double factor = std::min(kMost, kPart * wanted_ / std::max(seconds, 1e-6));
  const double growth = std::max(factor, is_same_view_ ? kLeastGrowth : 0.5);
  constexpr double kAll = 1e15;
  affordable_ = static_cast<std::uint64_t>(std::min(kAll, growth * static_cast<double>(had)));
}

}  // namespace adamas::viewer
