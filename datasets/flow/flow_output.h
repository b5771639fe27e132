#pragma once

#include "core/data/multi_material_data.h"
#include "datasets/flow/flow_solver.h"

namespace adamas::datasets {

/// The names of the units of a flow.
struct FlowUnits {
  std::string density, pressure, velocity;
};

/// Smaller fractions are not written: below it a material's density in a cell has no meaning.
inline constexpr double kLeastFraction = 1e-3;

/// The present state of the flow: volume fractions, the field "density" per material (its own mass over its
/// own volume, zero where it is absent), and "pressure" and "velocity", which materials share. In the output,
/// fractions below kLeastFraction become zero and the others of the cell grow to fill it; the flow itself is
/// not changed.
template <std::size_t N>
MultiMaterialData flow_data(const FlowSolver<N>& flow, const std::string& source, const FlowUnits& units);

}  // namespace adamas::datasets
