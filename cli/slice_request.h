#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/slice_samples.h"
#include "core/data/unstructured_mesh.h"
#include "workflow/slices/slice_panels.h"

namespace adamas::cli {

/// The options of `slice`, as text.
struct SliceRequest {
  std::vector<std::string> inputs;
  InputArguments input;
  VolumeInput volume;
  std::string step, steps;
  std::string plane, origin, normal, original, mode, range, colour_map, size, frame_rate, output;
  bool gradients = false, draw_cells = false, no_draw_cells = false, no_interfaces = false;
};

/// The plane that --plane, or --origin and --normal, name. Throws Error (kUsage).
Plane parse_any_plane(const SliceRequest& request);
/// Throws Error (kUsage).
picture::SliceOptions picture_size(const SliceRequest& request);
std::optional<picture::ValueRange> value_range(const SliceRequest& request);

/// An input that was cut, ready to be drawn.
struct CutInput {
  workflow::SliceInput input;
  workflow::SliceStyle style;
  std::vector<workflow::SliceMode> modes;
  std::vector<interfaces::CrossSection> sections;  ///< by mode
};

/// Reads the input and cuts it in all modes that are asked for. `polygons`: the sections alone are wanted, of
/// one mode, and no interfaces. Throws Error.
CutInput cut_input(const SliceRequest& request, bool polygons, Session& session);

/// The pieces of the last section as polygons with points of their own, so that values jump at interfaces:
/// cell arrays `material` and `cell`, the point array `field` unless it is empty, the field array
/// `material_names`.
UnstructuredMesh section_polygons(const CutInput& cut);

picture::SlicePicture make_picture(const SliceRequest& request, const CutInput& cut);

}  // namespace adamas::cli
