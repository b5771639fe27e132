#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/picture/raster.h"
#include "viewer/gl/renderer.h"
#include "viewer/session/view_session.h"

namespace adamas::viewer {

/// What the window would show of a session, its panels apart, without a window.
class OffscreenPictures {
 public:
  /// The session must outlive this. Throws Error where there is no OpenGL 4.5, or no picture of this size.
  OffscreenPictures(ViewSession& session, int width, int height);
  ~OffscreenPictures();

  /// What there is to be seen from a viewpoint, once it is worked out; nothing where there is a problem,
  /// which report() tells. Throws Error where drawing fails.
  std::optional<picture::Raster> draw(const isosurface::Viewpoint& viewpoint);

  // Of the last picture.
  [[nodiscard]] const UpdateReport& report() const { return report_; }
  [[nodiscard]] const DrawFigures& drawn() const;
  [[nodiscard]] double draw_seconds() const;
  /// How OpenGL was had, and what draws.
  [[nodiscard]] const std::string& drawn_by() const;

 private:
  struct Parts;

  /// Has the session know what the surface of now hides from the viewpoint of the state.
  void find_depths();
  /// The same of its whole surface, from the viewpoint that its mesh is to be made for.
  void find_depths_of_culled_view();

  ViewSession& session_;
  std::unique_ptr<Parts> parts_;
  UpdateReport report_;
};

}  // namespace adamas::viewer
