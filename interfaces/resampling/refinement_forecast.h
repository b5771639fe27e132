#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace adamas::interfaces {

/// Estimates how much of a refinement is done, round by round, from what rounds before have split. In the
/// first rounds nearly all cells that interfaces meet fail. Then the part of them that does falls evenly from
/// round to round, whatever the input, down to a rest that ends with cells as small as the target. Cells
/// whose estimates wait until no other fails come after these rounds: the more of them, the more splits there
/// are.
class RefinementForecast {
 public:
  /// A round of refinement.
  struct Round {
    std::size_t failing = 0;  ///< the cells whose errors are too great
    std::size_t splits = 0;   ///< the splits of these, and of others for conformity
    double diameter = 0;      ///< the mean diameter of the failing ones, relative to the target
    std::size_t waiting = 0;  ///< the cells whose estimates wait
  };
  /// The parts of the refinement that are done before and after a step of it. They never fall.
  using Parts = std::array<double, 2>;
  /// Begins a round; returns nothing while nothing can be told.
  std::optional<Parts> begin_round(const Round& round);
  /// Begins the estimates of cells that have waited.
  Parts begin_waiting();

 private:
  Parts advance(double part);
  [[nodiscard]] double splits_later(const Round& round) const;

  std::size_t failing_before_ = 0;  ///< the cells that failed in the last round
  double part_failing_ = 1;         ///< the part of their children that fails in this round
  double splits_ = 0;               ///< the splits of all rounds
  double done_ = 0;                 ///< the part that is done after this round
};

}  // namespace adamas::interfaces
