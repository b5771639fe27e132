#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/vec3.h"
#include "core/picture/colour.h"
#include "isosurface/view/depth_pyramid.h"
#include "isosurface/view/viewpoint.h"
#include "timevarying/step_clock.h"

namespace adamas::viewer {

/// How surfaces are shaded.
enum class Shading {
  kLit,     ///< by a light beside the eye
  kSphere,  ///< after D: by where the normal points in the view, with dark silhouettes
};

/// What the mouse turns: the data about the target; the same with z upwards; or the way the eye looks.
enum class CameraMode { kTrackball, kTurntable, kFly };

/// One of the surfaces of a store.
struct SurfaceState {
  double isovalue = 0;  ///< a value (VolumeGrid::slope)
  picture::Colour colour{0.93, 0.85, 0.71};
  double opacity = 1;
  bool is_shown = true;

  bool operator==(const SurfaceState&) const = default;
};

/// What is shown of a file.
struct DocumentState {
  std::vector<SurfaceState> surfaces;          ///< of a store
  std::set<std::string> hidden;                ///< materials
  std::string field;                           ///< what colours are by; empty: materials
  std::optional<std::array<double, 2>> range;  ///< of the colour map; none: all values of the field
  std::uint32_t step = 0;                      ///< of a series

  bool operator==(const DocumentState&) const = default;
};

/// A plane across the picture.
struct CutState {
  bool is_on = false;
  Plane plane{{}, {1, 0, 0}};
  bool cuts_away = true;      ///< what lies where the normal points to is not shown
  bool shows_section = true;  ///< of materials with their fields, or of a store's samples

  [[nodiscard]] bool has_section() const { return is_on && shows_section; }
};

/// A viewpoint with a name.
struct Bookmark {
  std::string name;
  isosurface::Viewpoint viewpoint;
};

/// All that a picture depends on, but for its files.
struct ViewState {
  isosurface::Viewpoint viewpoint;
  CameraMode camera_mode = CameraMode::kTrackball;
  Shading shading = Shading::kLit;
  std::string colour_map = "sequential";
  bool has_edges = false, has_axes = true, has_colour_bar = true, has_box = true;
  bool has_time = true;                   ///< of a series: the time of the step is written on the picture
  double pixels = 1;                      ///< the greatest isosurface error in the picture
  std::uint64_t max_triangles = 500'000;  ///< of all surfaces of a store
  double frame_milliseconds = 0;          ///< that a mesh of a store may take while the view moves; 0: any
  CutState cut;
  /// From where meshes are refined and culled, where that is not from where they are seen (D figure 4.14).
  std::optional<isosurface::Viewpoint> culled_from;
  /// Whether what the picture hides is left coarse, and the depths of the last picture, which tell what that
  /// is.
  bool leaves_out_hidden = false;
  std::shared_ptr<const isosurface::DepthPyramid> depths;
  std::vector<Bookmark> bookmarks;
  std::vector<DocumentState> documents;  ///< in the order of the files
  timevarying::StepPace pace;            ///< of playing series; as of when a state is kept or taken over
};

/// The state as JSON. view_state() reads it; it throws Error that begins with `name` for another text, and
/// for numbers that no picture can have.
std::string to_text(const ViewState& state);
ViewState view_state(std::string_view text, const std::string& name);

}  // namespace adamas::viewer
