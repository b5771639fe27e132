#include "interfaces/comparison/sizing_search.h"

#include <algorithm>
#include <cmath>

namespace adamas::interfaces {

namespace {

/// Without a bound on the other side, a size changes by at most this factor.
constexpr double kStride = 4;
/// Interpolation keeps this distance from the ends of the bracket, relative to its width.
constexpr double kKeepOff = 0.15;

/// An end of the bracket: the logarithms of the size and, if measured, of distance / wanted.
struct End {
  double size;
  std::optional<double> excess;
};

double next_size(const std::optional<End>& low, const std::optional<End>& high) {
  if (!high)
    return low->size + std::clamp(-low->excess.value_or(-std::log(kStride)), 0.05, std::log(kStride));
  if (!low) return high->size - std::clamp(high->excess.value_or(std::log(kStride)), 0.05, std::log(kStride));
  double part = 0.5;
  if (low->excess && high->excess) part = -*low->excess / (*high->excess - *low->excess);
  return low->size + std::clamp(part, kKeepOff, 1 - kKeepOff) * (high->size - low->size);
}

}  // namespace

bool search_sizing(double wanted, double first, const std::function<SizingTrial(double)>& attempt,
                   const SizingOptions& options) {
  std::optional<End> low, high;
  const double greatest = std::log(options.greatest);
  double size = std::min(std::log(first), greatest);
  for (int trial = 0; trial < options.most_trials; ++trial) {
    const SizingTrial found = attempt(std::exp(size));
    if (found.outcome == SizingTrial::Outcome::kOver) return false;
    if (found.outcome == SizingTrial::Outcome::kTooCoarse) {
      high = End{size, std::nullopt};
    } else if (found.outcome == SizingTrial::Outcome::kTooFine) {
      low = End{size, std::nullopt};
    } else {
      if (std::abs(found.distance / wanted - 1) <= options.tolerance) return true;
      const double excess = std::log(found.distance / wanted);
      (excess > 0 ? high : low) = End{size, excess};
    }
    // If the greatest size is too fine, all are.
    if (!high && size >= greatest) return false;
    size = std::min(next_size(low, high), greatest);
  }
  return false;
}

}  // namespace adamas::interfaces
