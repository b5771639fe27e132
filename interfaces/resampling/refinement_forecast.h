#pragma once

#include <cstddef>
#include <optional>

namespace adamas::interfaces {

/// Estimates how much of a refinement is done, round by round, from what rounds before have split. In the
/// first rounds nearly all cells that interfaces meet fail. Then the part of them that does falls evenly from
/// round to round, whatever the input, down to a rest that ends with cells as small as the target.
class RefinementForecast {
 public:
  /// A round of refinement.
  struct Round {
    std::size_t failing = 0;  ///< the cells whose errors are too great
    std::size_t splits = 0;   ///< the splits of these, and of others for conformity
    double diameter = 0;      ///< the mean diameter of the failing ones, relative to the target
  };
  /// Begins a round. Returns the part of the refinement that is done before it, which never falls; none while
  /// nothing can be told.
  std::optional<double> begin_round(const Round& round);

 private:
  [[nodiscard]] double splits_later(const Round& round) const;

  std::size_t failing_before_ = 0;  ///< the cells that failed in the last round
  double part_failing_ = 1;         ///< the part of their children that fails in this round
  double done_ = 0;                 ///< the part that is done after this round
};

}  // namespace adamas::interfaces
