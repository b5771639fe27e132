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

/// What the shock does to an interface without ripples.
ShockedInterface mixing_shock(double mach);
/// The place along z that such an interface rests at once it was struck, and when that is.
double mixing_place();
double mixing_strike_time(double mach);

/// The flow, seen from where the interface, once struck, has no mean velocity: the materials "air" and
/// "sulphur hexafluoride" (Richtmyer, Comm. Pure Appl. Math. 13, 1960; Meshkov 1969). Ripples are cosines of
/// from two to six waves across the tube, of one amplitude and random phases; those that the cells cannot
/// hold are left out. The sides of the tube are periodic. Its ends are open; once the shock that the
/// interface throws back and the one that goes through have passed them, the gas behind these is beyond them.
class MixingFlow {
 public:
  /// Prepares the flow. Throws Error for fewer cells along z than kFewestMixingCells, more than fit in
  /// memory, and a Mach number that is not above 1 and up to kGreatestMixingMach.
  explicit MixingFlow(const MixingOptions& options = {});

  /// Advances the flow to a time, as FlowSolver::advance_to does.
  void advance_to(double time, Progress& progress = SilentProgress::instance());
  [[nodiscard]] const FlowSolver<2>& solver() const { return solver_; }

 private:
  /// A shock that leaves.
  struct Passing {
    double time = 0;
    std::size_t end = 0;
    FlowCell<2> behind;
  };
  [[nodiscard]] std::vector<Passing> find_passings(double mach) const;

  FlowSolver<2> solver_;
  std::vector<Passing> passings_;  ///< those to come, the last one first
};

/// Density of what is in a cell, in kg/m3.
double mixing_density(const FlowCell<2>& cell);
/// Entropy per mass of what is in a cell, in J/(kg K): of each gas c_v ln(p / p0) - c_p ln(rho / rho0), with
/// the pressure and the density of air at the start.
double mixing_entropy(const FlowCell<2>& cell);

/// Values that a field has, with room for what the ripples focus.
struct MixingRange {
  double low = 0, high = 0;
};
MixingRange mixing_density_range(double mach);
MixingRange mixing_entropy_range(double mach);

}  // namespace adamas::datasets
