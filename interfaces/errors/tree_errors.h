#pragma once

#include <memory>
#include <vector>

#include "interfaces/resampling/resampler.h"

namespace adamas {

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
/// Estimated distances of the interfaces in each (estimate_interface_error), all triangles looked at.
std::vector<double> interface_errors_of_tree(const Resampler& resampler);
/// The greatest errors of one field that smaller cells lower (FieldError::reducible). Of displaced elements
/// the least error in what the tetrahedron itself has of their material, so that no mesh with this cell has a
/// greater one at its elements; as much as the field's range where it has none of it.
std::vector<double> field_errors_of_tree(const Resampler& resampler, std::size_t field);

}  // namespace adamas
