#include "isosurface/gradients/gradient_smoothing.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"

namespace adamas::isosurface {

void GradientScale::add(std::span<const Gradient> gradients) {
  for (const Gradient& g : gradients) {
    const double square = squared_length(g);
    sum_ += square;
    count_ += square > 0 ? 1 : 0;
  }
}

SmoothingRound::SmoothingRound(double least_square, std::size_t ni, std::size_t nj)
    : least_square_(least_square), ni_(ni), nj_(nj), before_(ni * nj), here_(ni * nj), held_(ni * nj) {}

void SmoothingRound::sum_row(std::span<const Gradient> plane, std::size_t j, Sums& sums) const {
  if (j >= nj_) {
    std::fill(sums.begin(), sums.end(), Sum{});
    return;
  }
  const Gradient* const row = plane.data() + j * ni_;
  const auto term = [this](const Gradient& g) {
    return squared_length(g) > least_square_ ? Sum{g[0], g[1], g[2], 1} : Sum{};
  };
  Sum before{}, here = term(row[0]);
  for (std::size_t i = 0; i < ni_; ++i) {
    const Sum after = i + 1 < ni_ ? term(row[i + 1]) : Sum{};
    sums[i] = blended(before, here, after);
    before = here;
    here = after;
  }
}

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

SmoothingRounds::SmoothingRounds(const GradientScale& scale, std::size_t ni, std::size_t nj,
                                 const GradientSmoothingOptions& options)
    : options_(options), least_square_(scale.least_square()), most_(options.freedom * scale.mean_square()) {
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

std::size_t SmoothingRounds::bytes(const GradientSmoothingOptions& options) {
  const auto planes = [](int rounds) { return static_cast<std::size_t>(rounds) + 1; };
  return 44 * options.rounds() + 2 * sizeof(Gradient) + planes(options.free_rounds) +
         planes(options.constrained_rounds) * sizeof(Gradient);
}

void SmoothingRounds::note(std::span<const Gradient> plane) {
  if (degenerate_.empty()) return;
  std::vector<std::uint8_t>& degenerate = degenerate_[noted_ % degenerate_.size()];
  std::transform(plane.begin(), plane.end(), degenerate.begin(),
                 [this](const Gradient& g) { return squared_length(g) > least_square_ ? 0 : 1; });
  ++noted_;
}

bool SmoothingRounds::push(std::size_t first, std::size_t end, std::span<const Gradient>& plane) {
  for (std::size_t n = first; n < end; ++n) {
    if (n == static_cast<std::size_t>(options_.free_rounds)) keep_anchors(plane);
    bool has_result = false;
    with_update(n, [&](const auto& update) { has_result = rounds_[n].push(plane, result(n), update); });
    if (!has_result) return false;
    plane = result(n);
    ++finished_[n];
  }
  return true;
}

std::span<const Gradient> SmoothingRounds::finish(std::size_t n) {
  with_update(n, [&](const auto& update) { rounds_[n].finish(result(n), update); });
  ++finished_[n];
  return result(n);
}

template <class Fn>
void SmoothingRounds::with_update(std::size_t n, Fn&& fn) {
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

void SmoothingRounds::keep_anchors(std::span<const Gradient> plane) {
  const std::vector<std::uint8_t>& degenerate = degenerate_[anchored_ % degenerate_.size()];
  std::vector<Gradient>& anchors = anchors_[anchored_ % anchors_.size()];
  for (std::size_t at = 0; at < plane.size(); ++at) {
    anchors[at] = degenerate[at] != 0 ? Gradient{} : plane[at];
  }
  ++anchored_;
}

void GradientSmoother::add(std::span<const Gradient> plane) {
  empty_ = false;
  rounds_.note(plane);
  run(0, plane);
}

void GradientSmoother::finish() {
  if (empty_) return;
  for (std::size_t n = 0; n < rounds_.count(); ++n) run(n + 1, rounds_.finish(n));
}

}  // namespace adamas::isosurface
