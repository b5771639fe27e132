#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/view.h"
#include "core/picture/material_colours.h"
#include "isosurface/view/depth_pyramid.h"
#include "isosurface/view/viewpoint.h"
#include "timevarying/step_clock.h"

namespace adamas::viewer {

/// What the mouse rotates: the data about the target, freely or with z upwards; or the viewing direction.
enum class CameraMode { kTrackball, kTurntable, kFly };

/// One of the surfaces of a store.
struct SurfaceState {
  double isovalue = 0;  ///< in units of values, not of samples (VolumeGrid::slope)
  picture::Colour colour = picture::kSurfaceColour;
  double opacity = 1;
  bool is_shown = true;

  bool operator==(const SurfaceState&) const = default;
};

/// The visible contents of a file.
struct DocumentState {
  std::vector<SurfaceState> surfaces;  ///< the surfaces of a store
  std::set<std::string> hidden;        ///< the materials that are not shown
  std::string field;                   ///< the field shown by colours; empty: colours show materials
  /// The ends of the colour map; empty: those of all values of the field.
  std::optional<std::array<double, 2>> range;
  std::uint32_t step = 0;  ///< the step of a series that is shown

  bool operator==(const DocumentState&) const = default;
};

/// A plane across the picture.
struct CutState {
  bool is_on = false;
  Plane plane{{}, {1, 0, 0}};
  bool cuts_away = true;      ///< whether the side to which the normal points is hidden
  bool shows_section = true;  ///< whether the cross section is shown, of materials or of a store's samples

  [[nodiscard]] bool has_section() const { return is_on && shows_section; }
};

/// A viewpoint with a name.
struct Bookmark {
  std::string name;
  isosurface::Viewpoint viewpoint;
};

/// Everything on which a picture depends, except its files.
struct ViewState {
  isosurface::Viewpoint viewpoint;
  CameraMode camera_mode = CameraMode::kTrackball;
  Shading shading = Shading::kLit;
  std::string colour_map = "sequential";
  bool has_edges = false, has_axes = true, has_colour_bar = true, has_box = true;
  bool has_time = true;                   ///< whether the picture shows the time of a series' step
  double pixels = 1;                      ///< the greatest isosurface error in the picture
  std::uint64_t max_triangles = 500'000;  ///< the most triangles of all surfaces of a store together
  double frame_milliseconds = 0;  ///< the time for a mesh of a store while the view moves; 0 for no limit
  CutState cut;
  /// The viewpoint for which meshes are refined and culled, if it is not that of the picture (D figure 4.14).
  std::optional<isosurface::Viewpoint> culled_from;
  /// Whether surfaces stay coarse where the picture hides them, and the depths of the last picture, which
  /// show where that is.
  bool leaves_out_hidden = false;
  std::shared_ptr<const isosurface::DepthPyramid> depths;
  std::vector<Bookmark> bookmarks;
  std::vector<DocumentState> documents;  ///< one for each file, in their order
  timevarying::StepPace pace;            ///< how series are played when a state is saved or restored
};

/// Writes a state as JSON, and reads it. Reading throws Error, which begins with `name`, for another text and
/// for numbers that no picture can have.
std::string to_text(const ViewState& state);
ViewState view_state(std::string_view text, const std::string& name);

}  // namespace adamas::viewer
