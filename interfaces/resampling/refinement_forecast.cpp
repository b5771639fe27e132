#include "interfaces/resampling/refinement_forecast.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace adamas::interfaces {

namespace {

/// The figures were found with labels, fractions and surfaces, at errors of 1 and 2% of the domain.

/// The part of failing cells' children that fail falls by this in each round, down to kLeastFailing, once
/// their diameters, relative to the target, are below kLarge; that larger cells fail less says nothing about
/// others.
constexpr double kFall = 0.15, kLeastFailing = 0.3, kLarge = 10;
/// Nothing is told before it has fallen below this.
constexpr double kFalling = 0.8;
/// The number of splits for each failing cell grows with this power of that part's fall, since splits reach
/// farther for conformity where few cells fail.
constexpr double kConformity = 0.8;
/// Cells with a smaller diameter, relative to the target, do not fail.
constexpr double kSmallest = 1.2;
/// The work of the estimate of a cell that has waited, and that of what follows from it, in splits.
constexpr double kEstimate = 0.75, kFollowing = 0.7;
/// The diameter falls by this in each round: the volume is halved.
const double kHalvedVolume = std::cbrt(0.5);

}  // namespace

std::optional<RefinementForecast::Parts> RefinementForecast::begin_round(const Round& round) {
  const auto failing = static_cast<double>(round.failing);
  if (failing_before_ > 0)
    part_failing_ = std::min(1.0, 0.5 * failing / static_cast<double>(failing_before_));
  failing_before_ = round.failing;
  const auto now = static_cast<double>(round.splits);
  const double splits_before = std::max(1.0, std::exchange(splits_, splits_ + now));
  if (done_ == 0 && (part_failing_ >= kFalling || round.diameter >= kLarge)) return {};
  const double later = splits_later(round), rest = now + later;
  const double waiting = static_cast<double>(round.waiting) * (1 + rest / splits_before);
  return advance(now / (rest + (kEstimate + kFollowing) * waiting));
}

RefinementForecast::Parts RefinementForecast::begin_waiting() {
  return advance(kEstimate / (kEstimate + kFollowing));
}

/// Adds a step that is a part of what is left.
RefinementForecast::Parts RefinementForecast::advance(double part) {
  const double before = done_;
  done_ += (1 - done_) * part;
  return {before, done_};
}

/// Returns how many splits the rounds after this one are expected to make.
double RefinementForecast::splits_later(const Round& round) const {
  const double least = std::min(kLeastFailing, part_failing_);
  double part = part_failing_, splits = static_cast<double>(round.splits), sum = 0;
  for (double diameter = round.diameter * kHalvedVolume; diameter > kSmallest; diameter *= kHalvedVolume) {
    const double before = part;
    if (diameter < kLarge) part = std::max(part - kFall, least);
    splits *= 2 * part * std::pow(before / part, kConformity);
    sum += splits;
  }
  return sum;
}

}  // namespace adamas::interfaces
