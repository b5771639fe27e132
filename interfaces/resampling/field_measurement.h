#pragma once

#include <span>
#include <vector>

#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

/// How far the search for the least error of a displaced element goes.
enum class DisplacedErrors {
  kWithinTargets,  ///< until it is within the field's target or not above the error of other elements
  kLeast,
};

/// Measures the errors of all fields in these leaves, and computes the rows at their vertices.
void measure_fields(ResamplingState& state, const std::vector<TetrahedronId>& cells,
                    DisplacedErrors displaced);
/// Returns a body's fields at a vertex.
std::vector<double> row_at(const ResamplingState& state, VertexId v, BodyId body);
/// Returns the native elements in a tetrahedron of the tree, which need not be a leaf.
std::span<const std::uint32_t> elements_in(const ResamplingState& state, TetrahedronId t);

}  // namespace adamas::interfaces
