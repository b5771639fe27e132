#pragma once

#include <span>
#include <vector>

#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

/// How far the least error of a displaced element is looked for.
enum class DisplacedErrors {
  kWithinTargets,  ///< until it is within the field's target, or within what other elements have anyway
  kLeast,
};

/// Measures the errors of all fields in these leaves, and works out the rows at their vertices.
void measure_fields(ResamplingState& state, const std::vector<TetrahedronId>& cells,
                    DisplacedErrors displaced);
/// A body's fields at a vertex.
std::vector<double> row_at(const ResamplingState& state, VertexId v, BodyId body);
/// The native elements in a tetrahedron of the tree, leaf or not.
std::span<const std::uint32_t> elements_in(const ResamplingState& state, TetrahedronId t);

}  // namespace adamas::interfaces
