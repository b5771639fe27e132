#pragma once

#include <functional>
#include <limits>

#include "adamas/compare.h"

namespace adamas::interfaces {

/// The outcome of a size of elements.
struct SizingTrial {
  enum class Outcome {
    kMeasured,
    kOver,       ///< no time is left
    kTooCoarse,  ///< there is no complete mesh, but a smaller size may give one
    kTooFine,    ///< there is no mesh, since it would have needed too much time or memory
  };
  Outcome outcome = Outcome::kMeasured;
  double distance = 0;  ///< set if it was measured
};

struct SizingOptions {
  double tolerance = kSizingTolerance;  ///< the relative tolerance of the distance
  int most_trials = kMostSizingTrials;
  double greatest = std::numeric_limits<double>::infinity();  ///< the greatest tried size
};

/// Searches the size with which a measured distance is as wanted; the distance must roughly grow with the
/// size. The search interpolates logarithms between sizes that are too small and too great, or bisects.
/// Returns whether a size was found; the caller stores the trials.
bool search_sizing(double wanted, double first, const std::function<SizingTrial(double)>& attempt,
                   const SizingOptions& options = {});

}  // namespace adamas::interfaces
