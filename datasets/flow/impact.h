#pragma once

#include "adamas/flows.h"
#include "datasets/flow/flow_solver.h"

namespace adamas::datasets {

inline const FlowUnits kImpactUnits{"g/cm3", "Mbar", "cm/us"};

/// A tungsten cylinder of radius 1 and height 1.6 at the moment it touches a tantalum block, which fills z <
/// 0 for |x|, |y| < 9, in air so thin that it counts as empty: the materials are "projectile", "block" and
/// "empty". Throws Error for a box that does not contain the impact and for a speed out of range.
FlowSolver<3> make_impact(const ImpactOptions& options = {});

}  // namespace adamas::datasets
