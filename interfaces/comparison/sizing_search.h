#pragma once

#include <functional>
#include <limits>
#include <optional>

#include "adamas/compare.h"

namespace adamas::interfaces {

/// The outcome of a size of elements.
struct SizingTrial {
  enum class Outcome {
    kMeasured,
    kOver,       ///< there was no time left
    kTooCoarse,  ///< there is no mesh, or not a whole one, but a smaller size may give one
    kTooFine,    ///< there is no mesh, since it would have taken too much time or memory
  };
  Outcome outcome = Outcome::kMeasured;
  double distance = 0;  ///< where it was measured
};

struct SizingOptions {
  double tolerance = kSizingTolerance;  ///< relative, of the distance
  int most_trials = kMostSizingTrials;
  double greatest = std::numeric_limits<double>::infinity();  ///< the greatest size that is tried
};

/// Looks for the size with which a measured distance is as wanted, given that it more or less grows with the
/// size: between a size that is too small and one that is too great by interpolation in logarithms, or by
/// halving. Returns whether one was found; trials are the caller's to remember.
bool search_sizing(double wanted, double first, const std::function<SizingTrial(double)>& attempt,
                   const SizingOptions& options = {});

}  // namespace adamas::interfaces
