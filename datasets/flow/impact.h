#pragma once

#include <array>
#include <cstddef>

#include "core/base/progress.h"
#include "datasets/flow/flow_output.h"
#include "datasets/flow/flow_solver.h"

namespace adamas {

/// The impact of a projectile on a block; lengths in cm, times in microseconds.
struct ImpactOptions {
  std::array<std::size_t, 3> cells{32, 32, 52};
  /// Where x or y begins with 0, that plane is one of symmetry.
  Box3 box{{0, 0, -16}, {12, 12, 4.8}};
  double speed = 0.8;  ///< of the projectile, downwards: 8 km/s
};

inline const FlowUnits kImpactUnits{"g/cm3", "Mbar", "cm/us"};

/// A tungsten cylinder of radius 1.5 and height 2.4 that has just come down on a copper block with the top at
/// z = 0, 18 wide and 12 high, in air so thin that it counts as empty: the materials "projectile", "block"
/// and "empty". Throws Error where the box does not hold the place of the impact.
FlowSolver<3> make_impact(const ImpactOptions& options = {});

}  // namespace adamas
