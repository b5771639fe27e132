#include "cli/time_left.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace adamas::cli {

namespace {

/// A stage that is shorter needs no announcement.
constexpr double kFirstSeconds = 2;
/// Before this part is done, the first loops and their caches say little about the others.
constexpr double kFirstPart = 0.05;
/// Parts that are closer to each other are not kept apart.
constexpr double kLeastStep = 1e-3;
/// The rate is that of this last part of the time, since stages become slower or faster.
constexpr double kRecent = 0.5;

}  // namespace

void TimeLeft::start(double now) {
  start_ = now;
  known_.assign(1, {now, 0});
}

void TimeLeft::add(double now, double part) {
  if (known_.empty()) start(now);
  if (part >= known_.back().part + kLeastStep) known_.push_back({now, part});
}

std::optional<double> TimeLeft::left(double now) const {
  if (known_.size() < 2 || now - start_ < kFirstSeconds) return {};
  const Known last = known_.back();
  if (last.part < kFirstPart) return {};
  const double since = now - last.time, before = last.time - known_[known_.size() - 2].time;
  if (since > kFirstSeconds && since > 3 * before) return {};
  // The first of the known parts within the last part of the time.
  const double from = last.time - kRecent * (last.time - start_);
  const auto after = std::lower_bound(known_.begin(), known_.end() - 1, from,
                                      [](const Known& known, double time) { return known.time < time; });
  const Known& first = after == known_.begin() ? *after : *(after - 1);
  const double rate = (last.part - first.part) / (last.time - first.time);
  return std::max(0.0, (1 - last.part) / rate - since);
}

std::string duration_text(double seconds) {
  const auto rounded = [](double x) { return x < 10 ? std::round(2 * x) / 2 : std::round(x); };
  if (seconds < 10) return fmt::format("about {:.0f} s", std::max(1.0, std::round(seconds)));
  if (seconds < 100) return fmt::format("about {:.0f} s", seconds);
  if (seconds < 6000) return fmt::format("about {:g} min", rounded(seconds / 60));
  return fmt::format("about {:g} h", rounded(seconds / 3600));
}

}  // namespace adamas::cli
