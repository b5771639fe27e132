#pragma once

#include <vector>

#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

/// Works out what the vertices and tetrahedra of the roots know.
void evaluate_roots(ResamplingState& state);
/// Works out the distances from the interfaces at these vertices.
void evaluate_vertices(ResamplingState& state, const std::vector<VertexId>& vertices);
/// Estimates the interface error of a tetrahedron that has its triangles.
void evaluate_interface(ResamplingState& state, TetrahedronId t);
/// Hands the triangles and native elements of a tetrahedron down to its children.
void hand_down(ResamplingState& state, TetrahedronId parent);
/// Hands down what an evaluated tetrahedron has to all tetrahedra below it, whose vertices are evaluated, and
/// estimates the interface errors of the leaves; with `inner`, those of all others below it too.
void evaluate_below(ResamplingState& state, TetrahedronId parent, bool inner);
/// Takes from a tetrahedron that is split what leaves alone have.
void drop_leaf_data(ResamplingState& state, TetrahedronId t);
/// Gives a tetrahedron the triangles of its children back, before these go.
void gather_triangles(ResamplingState& state, TetrahedronId parent);

}  // namespace adamas::interfaces
