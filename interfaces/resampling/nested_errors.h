#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

/// Any tetrahedron of a resampler's tree, not only a leaf, as a cell in which fields can be measured.
struct TreeCell {
  std::array<VertexRecord, 4> vertices;  ///< these have the rows of the bodies that own a part of the cell
  CellView view;                         ///< this has parts and refers to `vertices`
};
/// Converts a tetrahedron of the tree to a cell, and computes the rows that the resampler has not.
std::unique_ptr<TreeCell> make_tree_cell(const Resampler& resampler, TetrahedronId t);

/// Returns, by TetrahedronId, the estimated distance of the interfaces in every tetrahedron of the tree by
/// itself, for any mesh of which it may be a cell; 0 for unused ids. All triangles are used
/// (estimate_interface_error()); measured distances do not count. If an interface is lost, the error is the
/// cell's diameter.
std::vector<double> interface_errors_of_tree(const Resampler& resampler);
/// Returns the errors of all fields in every tetrahedron of the tree by itself. A displaced element has its
/// least error in the parts of its material nearby in the tetrahedron itself, so that no mesh with this cell
/// has a greater error there. If the tetrahedron has no such part, the element has no value, since the
/// interface error bounds the distance of its material.
std::vector<std::vector<FieldError>> field_errors_of_tree(const Resampler& resampler);

/// Nested errors of a hierarchy (docs/method.md, Errors): the error of a tetrahedron is at least those of its
/// children, the error of a diamond at least those of its tetrahedra and of its child diamonds. Thus no error
/// grows on the way down, neither in the tree of tetrahedra nor among diamonds, and a selection by threshold
/// never needs a split above an element with a smaller error. Nested errors are the least such errors that
/// are nowhere below the direct ones.
struct NestedErrors {
  std::vector<double> of_tetrahedra;  ///< by TetrahedronId
  std::vector<double> of_diamonds;    ///< by DiamondId

  [[nodiscard]] double operator[](TetrahedronId t) const { return of_tetrahedra[t.value]; }
  [[nodiscard]] double operator[](DiamondId d) const { return of_diamonds[d.value]; }
};

/// Returns the nested errors of direct errors, which are given for every tetrahedron of the tree.
NestedErrors nest_errors(const HierarchyTopology& hierarchy,
                         const std::function<double(TetrahedronId)>& direct);

/// Returns the nested errors of one field of the source (field_errors_of_tree()).
NestedErrors nest_field_errors(const Resampler& resampler, std::size_t field);

/// Nested errors of one field by vertex corrections (D 3.1), for comparison: the error of a parent is the
/// greater one of its children's plus the error of its linear field at their new vertex.
struct CorrectedErrors {
  std::vector<double> of_tetrahedra;  ///< by TetrahedronId
  /// The number of split tetrahedra that are left out because the correction is not defined: the new vertex
  /// lies in a body of which an end of the split edge has no value.
  std::size_t undefined = 0;
};

/// Corrects the leaves' greatest errors by the fields at vertices.
CorrectedErrors correct_field_errors(const Resampler& resampler, std::size_t field);

}  // namespace adamas::interfaces
