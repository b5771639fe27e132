#include "isosurface/gradients/gradient_smoothing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/assert.h"

namespace adamas {

namespace {

/// As near to the average as the freedom `most` |g| |average - g| allows.
Gradient constrained(const Gradient& g, const Gradient& average, double most) {
  const Gradient step{average[0] - g[0], average[1] - g[1], average[2] - g[2]};
  const double product = std::sqrt(squared_length(g)) * std::sqrt(squared_length(step));
  if (product <= most) return average;
  const double part = most / product;
  Gradient result;
  for (std::size_t n = 0; n < 3; ++n) {
    result[n] = static_cast<float>(double{g[n]} + part * double{step[n]});
  }
  return result;
}

}  // namespace

GradientSmoother::GradientSmoother(const GradientScale& scale, std::size_t ni, std::size_t nj,
                                   const GradientSmoothingOptions& options, Sink sink)
    : options_(options),
      least_square_(scale.least_square()),
      most_(options.freedom * scale.mean_square()),
      sink_(std::move(sink)) {
  ADAMAS_ASSERT(options.free_rounds >= 0 && options.constrained_rounds >= 0 && options.freedom >= 0);
  for (std::size_t n = 0; n < options.rounds(); ++n) rounds_.emplace_back(least_square_, ni, nj);
  finished_.resize(rounds_.size());
  for (auto& plane : results_) plane.resize(ni * nj);
  if (options.constrained_rounds == 0) return;
  degenerate_.resize(static_cast<std::size_t>(options.free_rounds) + 1);
  anchors_.resize(static_cast<std::size_t>(options.constrained_rounds) + 1);
  for (auto& plane : degenerate_) plane.resize(ni * nj);
  for (auto& plane : anchors_) plane.resize(ni * nj);
}

std::size_t GradientSmoother::bytes(const GradientSmoothingOptions& options) {
  const auto planes = [](int rounds) { return static_cast<std::size_t>(rounds) + 1; };
  return 44 * options.rounds() + 2 * sizeof(Gradient) + planes(options.free_rounds) +
         planes(options.constrained_rounds) * sizeof(Gradient);
}

void GradientSmoother::add(std::span<const Gradient> plane) {
  if (!degenerate_.empty()) {
    std::vector<std::uint8_t>& degenerate = degenerate_[added_ % degenerate_.size()];
    std::transform(plane.begin(), plane.end(), degenerate.begin(),
                   [this](const Gradient& g) { return squared_length(g) > least_square_ ? 0 : 1; });
  }
  ++added_;
  run(0, plane);
}

void GradientSmoother::finish() {
  if (added_ == 0) return;
  for (std::size_t n = 0; n < rounds_.size(); ++n) {
    with_update(n, [&](const auto& update) { rounds_[n].finish(results_[n % 2], update); });
    run(n + 1, results_[n % 2]);
  }
}

void GradientSmoother::run(std::size_t first, std::span<const Gradient> plane) {
  for (std::size_t n = first; n < rounds_.size(); ++n) {
    if (n == static_cast<std::size_t>(options_.free_rounds)) keep_anchors(plane);
    bool has_result = false;
    with_update(n, [&](const auto& update) { has_result = rounds_[n].push(plane, results_[n % 2], update); });
    if (!has_result) return;
    plane = results_[n % 2];
    ++finished_[n];
  }
  sink_(plane);
}

template <class Fn>
void GradientSmoother::with_update(std::size_t n, Fn&& fn) {
  if (n < static_cast<std::size_t>(options_.free_rounds)) {
    fn([](std::size_t, const Gradient& average) { return average; });
    return;
  }
  const Gradient* const anchors = anchors_[finished_[n] % anchors_.size()].data();
  fn([anchors, most = most_](std::size_t at, const Gradient& average) {
    const Gradient& g = anchors[at];
    return squared_length(g) > 0 ? constrained(g, average, most) : average;
  });
}

void GradientSmoother::keep_anchors(std::span<const Gradient> plane) {
  const std::vector<std::uint8_t>& degenerate = degenerate_[anchored_ % degenerate_.size()];
  std::vector<Gradient>& anchors = anchors_[anchored_ % anchors_.size()];
  for (std::size_t at = 0; at < plane.size(); ++at) {
    anchors[at] = degenerate[at] != 0 ? Gradient{} : plane[at];
  }
  ++anchored_;
}

std::size_t smooth_gradients(std::span<Gradient> gradients, const std::array<std::size_t, 3>& dimensions,
                             const GradientSmoothingOptions& options, Progress& progress) {
  const auto [ni, nj, nk] = dimensions;
  ADAMAS_ASSERT(gradients.size() == ni * nj * nk);
  if (gradients.empty()) return 0;
  GradientScale scale;
  scale.add(gradients);
  auto next = gradients.begin();
  std::size_t degenerate = 0;
  // A plane is handed over after it has been read; without rounds it is the same one.
  GradientSmoother smoother(scale, ni, nj, options, [&](std::span<const Gradient> plane) {
    if (plane.data() != &*next) std::copy(plane.begin(), plane.end(), next);
    next += static_cast<std::ptrdiff_t>(plane.size());
    for (const Gradient& g : plane) degenerate += squared_length(g) > scale.least_square() ? 0 : 1;
  });
  for (std::size_t k = 0; k < nk; ++k) {
    progress.step("smoothing gradients", static_cast<double>(k) / static_cast<double>(nk));
    smoother.add(gradients.subspan(k * ni * nj, ni * nj));
  }
  smoother.finish();
  return degenerate;
}

}  // namespace adamas
