#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

/// Any tetrahedron of a resampler's tree, leaf or not, as a cell that fields can be measured in.
struct TreeCell {
  std::array<VertexRecord, 4> vertices;  ///< have the rows of the bodies that own a part of the cell
  CellView view;                         ///< has parts, and refers to `vertices`
};
/// Makes a tetrahedron of the tree a cell; works out the rows that the resampler has not worked out.
std::unique_ptr<TreeCell> make_tree_cell(const Resampler& resampler, TetrahedronId t);

/// The estimated distance of the interfaces in every tetrahedron of the tree by itself, whatever mesh it may
/// be a cell of, by TetrahedronId; 0 for ids that are not in use. All triangles are looked at
/// (estimate_interface_error), and measured distances do not count. Where an interface is lost, it is the
/// cell's diameter.
std::vector<double> interface_errors_of_tree(const Resampler& resampler);
/// The errors of all fields in every tetrahedron of the tree by itself. A displaced element has the least
/// error in what the tetrahedron itself has of its material near by, so that no mesh with this cell has a
/// greater one at it; where the tetrahedron has none, the element is without a value, since the interface
/// error bounds how far its material may be.
std::vector<std::vector<FieldError>> field_errors_of_tree(const Resampler& resampler);

/// Nested errors of a hierarchy (docs/method.md, Errors): a tetrahedron's covers those of its children, a
/// diamond's those of its tetrahedra and of its child diamonds. So no error grows on the way down, neither in
/// the tree of tetrahedra nor among diamonds: what a selection by threshold wants to split never waits for
/// something it does not want. Nested errors are the least such errors that are nowhere below the direct
/// ones.
struct NestedErrors {
  std::vector<double> of_tetrahedra;  ///< by TetrahedronId
  std::vector<double> of_diamonds;    ///< by DiamondId

  [[nodiscard]] double operator[](TetrahedronId t) const { return of_tetrahedra[t.value]; }
  [[nodiscard]] double operator[](DiamondId d) const { return of_diamonds[d.value]; }
};

/// The nested errors of the direct errors that are given for every tetrahedron of the tree, leaf or not.
NestedErrors nest_errors(const HierarchyTopology& hierarchy,
                         const std::function<double(TetrahedronId)>& direct);

/// The nested errors of one field of the source (field_errors_of_tree).
NestedErrors nest_field_errors(const Resampler& resampler, std::size_t field);

/// Nested errors of one field by vertex corrections (D 3.1), for comparison: the error of a parent is the
/// greater of its children's plus what its linear field misses at their new vertex.
struct CorrectedErrors {
  std::vector<double> of_tetrahedra;  ///< by TetrahedronId
  /// Tetrahedra that were split where the correction is not defined, and left out: the new vertex lies in a
  /// body of which an end of the split edge knows no value.
  std::size_t undefined = 0;
};

/// Corrects the leaves' greatest errors by the fields at vertices.
CorrectedErrors correct_field_errors(const Resampler& resampler, std::size_t field);

}  // namespace adamas::interfaces
