#pragma once

#include <optional>
#include <string>

#include "core/geometry/plane.h"
#include "core/picture/slice_picture.h"
#include "interfaces/cross_section/cross_section.h"
#include "workflow/slices/slice_input.h"

namespace adamas::workflow {

/// The kind of section that a panel shows.
enum class SliceMode {
  kInput,      ///< the input as it is
  kPlain,      ///< the mesh with plain linear interpolation
  kMaterials,  ///< the mesh with the fields of each material
};

/// Options that say how slices are drawn.
struct SliceStyle {
  Plane plane;
  std::string field;  ///< "NAME" or "NAME:C"; empty: the materials
  bool interfaces = true;
  bool input_cells = true, mesh_cells = true;  ///< lines round the cells of the input, of the mesh
};

/// Returns the field that a style shows: "NAME", "NAME:C" or, for a vector in space, "NAME:x"; none for the
/// materials. Throws Error for an unknown field.
std::optional<interfaces::FieldChoice> choose_field(const SliceInput& input, SliceMode mode,
                                                    const SliceStyle& style);

/// Makes a section of the input in one mode.
interfaces::CrossSection cut(const SliceInput& input, SliceMode mode, const SliceStyle& style);

/// Returns name and unit of the field that is shown; empty for the materials.
std::string shown_field(const SliceInput& input, const SliceStyle& style);

/// Draws sections side by side, one per mode: areas by field or material, cells and interfaces as lines.
picture::SlicePicture make_slice_picture(const SliceInput& input, const std::vector<SliceMode>& modes,
                                         const SliceStyle& style,
                                         const std::vector<interfaces::CrossSection>& sections);

/// Returns whether the cells of the input's grid are wide enough, with that many panels, for lines between
/// them to be visible.
bool shows_cells(const SliceInput& input, const Plane& plane, const picture::SliceOptions& size,
                 std::size_t panels);

}  // namespace adamas::workflow
