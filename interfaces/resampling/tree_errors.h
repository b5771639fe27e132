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
/// Estimated distances of the interfaces in each (estimate_interface_error), all triangles looked at; of lost
/// ones the cell's diameter.
std::vector<double> interface_errors_of_tree(const Resampler& resampler);
/// Errors of all fields in each. Of displaced elements the least error in what the tetrahedron itself has of
/// their material near by, so that no mesh with this cell has a greater one at them; where it has none, they
/// are without a value: how far their material may be is what the interface error says.
std::vector<std::vector<FieldError>> field_errors_of_tree(const Resampler& resampler);

}  // namespace adamas
