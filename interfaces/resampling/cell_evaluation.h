#pragma once

#include <vector>

#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

/// Computes the records of the vertices and tetrahedra of the roots.
void evaluate_roots(ResamplingState& state);
/// Computes the distances from the interfaces at these vertices.
void evaluate_vertices(ResamplingState& state, const std::vector<VertexId>& vertices);
/// Estimates the interface error of a tetrahedron that has its triangles. What it shows is kept if the error
/// is within the target.
void evaluate_interface(ResamplingState& state, TetrahedronId t);
/// Estimates the errors of leaves completely whose estimates have ended early.
void complete_estimates(ResamplingState& state);
/// Finds what these leaves show, where it is not known.
void find_contacts(ResamplingState& state, const std::vector<TetrahedronId>& leaves);
/// Distributes the triangles and native elements of a tetrahedron to its children.
void distribute_to_children(ResamplingState& state, TetrahedronId parent);
/// Distributes the data of an evaluated tetrahedron to all tetrahedra below it, whose vertices must be
/// evaluated, and estimates the interface errors of the leaves; with `inner`, those of all others below it
/// too, and else those that may wait are deferred, and those below them.
void evaluate_below(ResamplingState& state, TetrahedronId parent, bool inner);
/// Returns whether the children of a tetrahedron with this error may wait to be estimated until no other leaf
/// has to be split: it is within the target, and they nearly always are. Many of them are split for
/// conformity before.
bool parts_may_wait(const ResamplingState& state, const InterfaceError& error);
/// Removes the data that only leaves have from a tetrahedron that is split.
void drop_leaf_data(ResamplingState& state, TetrahedronId t);
/// Gives a tetrahedron the triangles of its children back, before these are removed.
void gather_triangles(ResamplingState& state, TetrahedronId parent);

}  // namespace adamas::interfaces
