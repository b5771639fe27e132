#pragma once

#include <array>
#include <cstddef>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "datasets/flow/flow_output.h"
#include "datasets/flow/flow_solver.h"

namespace adamas::datasets {

/// The impact of a projectile on a block; lengths in cm, times in microseconds.
struct ImpactOptions {
  std::array<std::size_t, 3> cells{32, 32, 52};
  /// The box; where x or y begins with 0, that plane is one of symmetry.
  Box3 box{{0, 0, -16}, {12, 12, 4.8}};
  double speed = 1.2;  ///< the speed of the projectile, downwards: 12 km/s
};

inline const FlowUnits kImpactUnits{"g/cm3", "Mbar", "cm/us"};
/// When the crater, its lip and the wave in the block are well apart.
inline constexpr double kImpactTime = 5;
/// The greatest speed of an impact; beyond it metals do not behave as stiffened gases.
inline constexpr double kGreatestImpactSpeed = 10;

/// Whether a box has (0, 0, 0), where the axis meets the block, inside, or on its low sides in x and y.
bool holds_impact(const Box3& box);

/// A tungsten cylinder of radius 1 and height 1.6 that has just come down on a tantalum block, which fills
/// z < 0 for |x|, |y| < 9, in air so thin that it counts as empty: the materials "projectile", "block" and
/// "empty". Throws Error for a box that does not hold the impact and for a speed out of range.
FlowSolver<3> make_impact(const ImpactOptions& options = {});

}  // namespace adamas::datasets
