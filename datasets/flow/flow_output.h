#pragma once

#include "core/data/multi_material_data.h"
#include "datasets/flow/flow_solver.h"

namespace adamas::datasets {

/// Names of the units a flow was set up in.
struct FlowUnits {
  std::string density, pressure, velocity;
};

/// Fractions below it are not written: the least part of a cell in which a material's density still means
/// something.
inline constexpr double kLeastFraction = 1e-3;

/// The flow as it is now: volume fractions, the field "density" per material (its own mass over its own
/// volume, zero where it is absent), and "pressure" and "velocity", which materials share. Fractions below
/// kLeastFraction become zero and the others of the cell take their room, the flow itself stays as it is.
template <std::size_t N>
MultiMaterialData flow_data(const FlowSolver<N>& flow, const std::string& source, const FlowUnits& units);

}  // namespace adamas::datasets
