#pragma once

#include <optional>
#include <string>

#include "core/geometry/plane.h"
#include "core/picture/slice_picture.h"
#include "interfaces/cross_section/cross_section.h"
#include "workflow/slices/slice_input.h"

namespace adamas::workflow {

/// What a panel of a slice shows.
enum class SliceMode {
  kInput,      ///< the input as it is
  kPlain,      ///< the mesh with plain linear interpolation
  kMaterials,  ///< the mesh with the fields of each material
};

/// How slices are drawn.
struct SliceStyle {
  Plane plane;
  std::string field;  ///< "NAME" or "NAME:C"; empty: the materials
  bool interfaces = true;
  bool input_cells = true, mesh_cells = true;  ///< lines round the cells of the input, of the mesh
};

/// The field that a style shows: "NAME", "NAME:C" or, of a vector in space, "NAME:x"; none for the materials.
/// Throws Error where it is not there.
std::optional<interfaces::FieldChoice> choose_field(const SliceInput& input, SliceMode mode,
                                                    const SliceStyle& style);

/// One section of the input in one mode.
interfaces::CrossSection cut(const SliceInput& input, SliceMode mode, const SliceStyle& style);

/// Name and unit of the field that is shown; empty for the materials.
std::string shown_field(const SliceInput& input, const SliceStyle& style);

/// Sections beside each other, one per mode: areas by field or material, cells and interfaces as lines.
picture::SlicePicture make_slice_picture(const SliceInput& input, const std::vector<SliceMode>& modes,
                                         const SliceStyle& style,
                                         const std::vector<interfaces::CrossSection>& sections);

/// Whether the cells of the input's grid are wide enough, with that many panels, for lines between them to be
/// seen.
bool shows_cells(const SliceInput& input, const Plane& plane, const picture::SliceOptions& size,
                 std::size_t panels);

}  // namespace adamas::workflow
