#pragma once

#include <optional>
#include <vector>

#include "adamas/slice_files.h"
#include "core/data/unstructured_mesh.h"
#include "core/picture/slice_picture.h"
#include "interfaces/cross_section/cross_section.h"
#include "workflow/slices/slice_panels.h"

namespace adamas::workflow {

/// Returns the size of the pictures.
picture::SliceOptions picture_size(const SliceRequest& request);
/// Returns the values at the ends of the colour map; none where they are not given.
std::optional<picture::ValueRange> value_range(const SliceRequest& request);

/// An input that was cut and is ready to be drawn.
struct CutInput {
  SliceInput input;
  SliceStyle style;
  std::vector<SliceMode> modes;
  std::vector<interfaces::CrossSection> sections;  ///< sections in the order of the modes
};

/// Reads the input and cuts it in all modes that are asked for. `polygons`: only the sections of one mode are
/// needed, and no interfaces. Throws Error.
CutInput cut_input(const SliceRequest& request, bool polygons, OutputSet& outputs, Progress& progress);

/// Returns the areas of the last section.
SliceAreas section_areas(const CutInput& cut);

/// Returns the last section.
Slice last_section(const CutInput& cut);

/// Returns the last section as polygons with points of their own, so that values jump at interfaces: cell
/// arrays `material` and `cell`, a point array named as the field unless that is empty, the field array
/// `material_names`.
UnstructuredMesh section_polygons(const CutInput& cut);

/// Draws the sections side by side.
picture::SlicePicture make_picture(const SliceRequest& request, const CutInput& cut);

}  // namespace adamas::workflow
