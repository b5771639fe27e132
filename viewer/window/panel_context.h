#pragma once

#include "viewer/session/view_session.h"

struct ImGuiContext;

namespace adamas::viewer {

/// Panels of Dear ImGui, apart from what draws them: without OpenGL they can be gone through in tests.
class PanelContext {
 public:
  /// `scale`: how much larger than on a plain screen things are, for screens with small pixels.
  explicit PanelContext(double scale = 1);
  ~PanelContext();
  PanelContext(const PanelContext&) = delete;
  PanelContext& operator=(const PanelContext&) = delete;

  /// Draws by the OpenGL context that is current, from now on. Throws Error where that does not work.
  void use_opengl();
  /// What Dear ImGui is told and asked concerns these panels from now on, as after begin().
  void make_current();
  /// Begins and ends what is shown on a picture of this size, `seconds` after the one before.
  void begin(int width, int height, double seconds);
  void end();
  /// Draws what was shown, into the framebuffer that is bound.
  void draw();

 private:
  ImGuiContext* context_;
  bool uses_opengl_ = false;
};

}  // namespace adamas::viewer
