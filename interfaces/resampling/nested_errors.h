#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

/// Any tetrahedron of a resampler's tree, leaf or not, as a cell that fields can be measured in.
struct TreeCell {
  std::array<VertexRecord, 4> vertices;  ///< with the rows of the bodies that own a part of the cell
  CellView view;                         ///< with parts; refers to `vertices`
};
/// Rows that the resampler has not worked out are worked out here.
std::unique_ptr<TreeCell> make_tree_cell(const Resampler& resampler, TetrahedronId t);

/// Errors of every tetrahedron of the tree by itself, whatever mesh it may be a cell of, by TetrahedronId; 0
/// for ids that are not in use. What was split before it was looked at is measured like the rest.
///
/// Estimated distances of the interfaces in each (estimate_interface_error), all triangles looked at,
/// whatever measuring has found of a mesh; of lost ones the cell's diameter.
std::vector<double> interface_errors_of_tree(const Resampler& resampler);
/// Errors of all fields in each. Of displaced elements the least error in what the tetrahedron itself has of
/// their material near by, so that no mesh with this cell has a greater one at them; where it has none, they
/// are without a value: how far their material may be is what the interface error says.
std::vector<std::vector<FieldError>> field_errors_of_tree(const Resampler& resampler);

/// Nested errors of a hierarchy (docs/method.md, Errors): a tetrahedron's covers those of its children, a
/// diamond's those of its tetrahedra and of its child diamonds. So no error grows on the way down, neither in
/// the tree of tetrahedra nor among diamonds: what a selection by threshold wants to split never waits for
/// something it does not want. The least such errors that are nowhere below the direct ones.
struct NestedErrors {
  std::vector<double> of_tetrahedra;  ///< by TetrahedronId
  std::vector<double> of_diamonds;    ///< by DiamondId

  [[nodiscard]] double operator[](TetrahedronId t) const { return of_tetrahedra[t.value]; }
  [[nodiscard]] double operator[](DiamondId d) const { return of_diamonds[d.value]; }
};

/// All diamonds, ancestors first: by level and phase, then by their points, so that the order does not depend
/// on the history of ids.
std::vector<DiamondId> diamonds_in_order(const HierarchyTopology& hierarchy);

/// The nested errors of direct errors, which are given for every tetrahedron of the tree, leaf or not, and
/// are zero for ids that are not in use.
NestedErrors nest_errors(const HierarchyTopology& hierarchy,
                         const std::function<double(TetrahedronId)>& direct);

/// The nested errors of the estimated distances of the interfaces (interface_errors_of_tree).
NestedErrors nest_interface_errors(const Resampler& resampler);

/// The nested errors of one field of the source (field_errors_of_tree).
NestedErrors nest_field_errors(const Resampler& resampler, std::size_t field);

/// Nested errors of one field by vertex corrections (D 3.1), for comparison: the greater of the children's,
/// and what the parent's linear field misses at their new vertex added to it.
struct CorrectedErrors {
  std::vector<double> of_tetrahedra;  ///< by TetrahedronId
  /// Tetrahedra that were split where the correction is not defined, and left out: the new vertex lies in a
  /// body of which an end of the split edge knows no value.
  std::size_t undefined = 0;
};

/// Corrects the leaves' greatest errors by the fields at vertices, those of complete_fields() among them.
CorrectedErrors correct_field_errors(const Resampler& resampler, std::size_t field);

}  // namespace adamas::interfaces
