#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "adamas/flows.h"
#include "adamas/progress.h"
#include "core/base/error.h"
#include "datasets/flow/flow_solver.h"
#include "datasets/flow/shocked_interface.h"

namespace adamas::datasets {

/// The materials of a MixingFlow.
inline constexpr std::size_t kAir = 0, kHexafluoride = 1;

/// The effect of the shock on an interface without ripples.
ShockedInterface mixing_shock(double mach);
/// The position along z at which such an interface stays once it has been struck, and the time when that
/// happens.
double mixing_place();
double mixing_strike_time(double mach);

/// The flow in the frame in which the interface, once struck, has no mean velocity: the materials are "air"
/// and "sulphur hexafluoride" (Richtmyer, Comm. Pure Appl. Math. 13, 1960; Meshkov 1969). Ripples are cosines
/// of two to six waves across the tube, of one amplitude and random phases; those that the cells cannot
/// resolve are left out. The sides of the tube are periodic. Its ends are open; once the shocks that the
/// interface reflects and transmits have passed them, the state outside is that of the gas behind these.
class MixingFlow {
 public:
  /// Prepares the flow. Throws Error if there are fewer cells along z than kFewestMixingCells or more than
  /// fit in memory, and unless the Mach number is above 1 and at most kGreatestMixingMach.
  explicit MixingFlow(const MixingOptions& options = {});

  /// Advances the flow to a time, as FlowSolver::advance_to does.
  void advance_to(double time, Progress& progress = SilentProgress::instance());
  [[nodiscard]] const FlowSolver<2>& solver() const { return solver_; }

 private:
  /// The passage of a shock through an end.
  struct Passing {
    double time = 0;
    std::size_t end = 0;
    FlowCell<2> behind;
  };
  [[nodiscard]] std::vector<Passing> find_passings(double mach) const;

  FlowSolver<2> solver_;
  std::vector<Passing> passings_;  ///< future ones, the last one first
};

/// Density of the mixture in a cell, in kg/m3.
double mixing_density(const FlowCell<2>& cell);
/// Entropy per mass of the mixture in a cell, in J/(kg K): for each gas c_v ln(p / p0) - c_p ln(rho / rho0),
/// with the pressure and the density of air at the start.
double mixing_entropy(const FlowCell<2>& cell);

/// The range of values of a field, with room for values that the ripples focus.
struct MixingRange {
  double low = 0, high = 0;
};
MixingRange mixing_density_range(double mach);
MixingRange mixing_entropy_range(double mach);

}  // namespace adamas::datasets
