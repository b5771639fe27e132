#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/picture/raster.h"
#include "viewer/gl/renderer.h"
#include "viewer/session/view_session.h"

namespace adamas::viewer {

/// Pictures of a session as the window would show them, without panels and without a window.
class OffscreenPictures {
 public:
  /// The session must outlive this object. Throws Error if there is no OpenGL 4.5, or if it cannot make
  /// pictures of this size.
  OffscreenPictures(ViewSession& session, int width, int height);
  ~OffscreenPictures();

  /// Draws the session from a viewpoint, after waiting for all parts. Returns nothing if there is a problem,
  /// which report() states. Throws Error if drawing fails.
  std::optional<picture::Raster> draw(const isosurface::Viewpoint& viewpoint);

  // The figures of the last picture.
  [[nodiscard]] const UpdateReport& report() const { return report_; }
  [[nodiscard]] const DrawFigures& drawn() const;
  [[nodiscard]] double draw_seconds() const;
  /// The source of the OpenGL context, and the renderer.
  [[nodiscard]] const std::string& drawn_by() const;

 private:
  struct Parts;

  /// Passes to the session the depths of its present surface from the viewpoint of the state.
  void find_depths();
  /// Passes to the session the depths of its complete surface from the viewpoint for which meshes are
  /// refined.
  void find_depths_of_culled_view();

  ViewSession& session_;
  std::unique_ptr<Parts> parts_;
  UpdateReport report_;
};

}  // namespace adamas::viewer
